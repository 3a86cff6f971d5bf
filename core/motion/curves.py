"""How a joint's motion follows from its keys, here and in Blender alike.

A joint is keyed as the quaternion of its rotation against its parent and, where it moves, as a
shift. Where every frame is a key, nothing lies between. Else each component is a piecewise cubic
through its keys (Hermite), in Blender a Bézier curve with handles at a third of the way, whose
slopes at the keys bring it nearest to the frames in between, by least squares. Quaternions are then
made units.
"""

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg import solveh_banded
from scipy.spatial.transform import Rotation

_NATURAL = 1e-2
"""Weight, against a frame's, of the slope that the motion itself has at a key."""


def quaternions(rotations: np.ndarray) -> np.ndarray:
    """(T, 4) quaternions w x y z of (T, 3, 3), each on the side of the sphere of the one before."""
    found = Rotation.from_matrix(rotations).as_quat()[:, [3, 0, 1, 2]]
    found[0] *= np.copysign(1.0, found[0, 0])
    turned = np.einsum("ti,ti->t", found[1:], found[:-1]) < 0
    found[1:][np.cumsum(turned) % 2 == 1] *= -1
    return found


def slopes(values: np.ndarray) -> np.ndarray:
    """(T, K) slopes per frame of values (T, K), from the frames before and after."""
    return np.gradient(values, axis=0) if len(values) > 1 else np.zeros_like(values)


def key_slopes(values: np.ndarray, keys: np.ndarray) -> np.ndarray:
    """(n, K) slopes per frame at keys (n,) of the curves nearest to values (T, K).

    ``keys`` are rising indices from 0 to T - 1, at least two.
    """
    times = np.arange(len(values))
    span = np.clip(np.searchsorted(keys, times, "right") - 1, 0, len(keys) - 2)
    length = np.diff(keys)[span]
    u = (times - keys[span]) / length
    here, there = u * (1 - u) ** 2 * length, -(u**2) * (1 - u) * length
    rest = values - hermite((values[keys[span]], values[keys[span + 1]]), (0.0, 0.0), u[:, None])
    count = len(keys)
    own = np.bincount(span, here**2, count) + np.bincount(span + 1, there**2, count)
    right = _NATURAL * slopes(values)[keys]
    np.add.at(right, span, here[:, None] * rest)
    np.add.at(right, span + 1, there[:, None] * rest)
    band = np.stack([own + _NATURAL, np.bincount(span, here * there, count)])
    return solveh_banded(band, right, lower=True)


def hermite(ends: tuple, slopes: tuple, share) -> np.ndarray:
    """Cubics between two ends with slopes over the whole way, at a share of it."""
    u = share
    return (
        (1 + 2 * u) * (1 - u) ** 2 * ends[0] + u**2 * (3 - 2 * u) * ends[1]
        + u * (1 - u) ** 2 * slopes[0] - u**2 * (1 - u) * slopes[1]
    )  # fmt: skip


def components(motions: np.ndarray) -> np.ndarray:
    """(T, 7) what is keyed of a joint's own motions (T, 3, 4): quaternion w x y z, then shift."""
    return np.column_stack([quaternions(motions[..., :3]), motions[..., 3]])


def followed(motions: np.ndarray, keys: np.ndarray) -> np.ndarray:
    """(T, 3, 4) what follows from a joint's own motions (T, 3, 4) in some of the frames.

    ``keys`` (n,) are rising indices from 0 to T - 1; all of them stand for themselves.
    """
    if len(keys) == len(motions):
        return motions.copy()
    values = components(motions)
    curve = CubicHermiteSpline(keys, values[keys], key_slopes(values, keys))
    values = curve(np.arange(len(values)))
    rotations = Rotation.from_quat(values[:, [1, 2, 3, 0]]).as_matrix()
    return np.concatenate([rotations, values[:, 4:, None]], axis=2)
