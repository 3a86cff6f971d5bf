"""Limits of a few DOFs, prepared for being asked thousands of times a second."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .body import Body
from .kinematics import TOLERANCE, inward_normals, swing_rows


@dataclass(frozen=True, eq=False)
class Limits:
    """Intervals and swing cones of n chosen DOFs.

    Attributes:
        low: (n,) lowest values.
        high: (n,) highest values.
        normals: (K, n) inward normals of the cones' edges.
        distances: (K,) a swing is inside where normals @ values >= distances.
    """

    low: np.ndarray
    high: np.ndarray
    normals: np.ndarray
    distances: np.ndarray

    @classmethod
    def of(cls, body: Body, dofs: Sequence[int]) -> "Limits":
        """The limits of ``dofs``; a cone counts if both halves of its swing are among them."""
        chosen = list(dofs)
        low, high = body.dofs.limits[chosen].T
        normals, distances = [np.zeros((0, len(chosen)))], [np.zeros(0)]
        for joint, cone in body.cones.items():
            rows = swing_rows(body, joint)
            if not set(rows) <= set(chosen):
                continue
            inward = inward_normals(cone)
            spread = np.zeros((len(cone), len(chosen)))
            spread[:, [chosen.index(row) for row in rows]] = inward
            normals.append(spread)
            distances.append((inward * cone).sum(axis=1))
        return cls(low, high, np.concatenate(normals), np.concatenate(distances))

    def allow(self, values: np.ndarray) -> np.ndarray:
        """(N,) bool: whether all of the values (N, n) are within their limits."""
        inside = ((values >= self.low - TOLERANCE) & (values <= self.high + TOLERANCE)).all(axis=1)
        depths = (values[:, None] * self.normals).sum(axis=2) - self.distances
        return inside & (depths >= -TOLERANCE).all(axis=1)
