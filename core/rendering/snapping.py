"""Projection as every exact backend does it: in float64, then snapped to 1/256 px."""

import numpy as np

from .model import GUARD_PX, NEAR


def homogeneous_px(projection: np.ndarray, transform: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(n, 3) homogeneous px of points (n, 3) given in a joint's space.

    Products and sums are taken one by one in the kernel's order, so that the bits are the same.
    """
    p, m = projection, transform
    a = p[:, 0, None] * m[0] + p[:, 1, None] * m[1] + p[:, 2, None] * m[2]
    a[:, 3] += p[:, 3]
    x, y, z = np.asarray(points, float).T[:, :, None]
    return a[:, 0] * x + a[:, 1] * y + a[:, 2] * z + a[:, 3]


def snapped_px(h: np.ndarray) -> np.ndarray:
    """(n, 2) int64 coordinates in 1/256 px of homogeneous points (n, 3)."""
    return np.rint(h[:, :2] * (1.0 / h[:, 2:]) * 256.0).astype(np.int64)


def plane_distances(h: np.ndarray) -> np.ndarray:
    """(n, 5) signed distances to the near plane and the guard region's sides, positive inside."""
    x, y, depth = h.T
    sides = GUARD_PX * depth + x, GUARD_PX * depth - x, GUARD_PX * depth + y, GUARD_PX * depth - y
    return np.stack([depth - NEAR, *sides], axis=1)
