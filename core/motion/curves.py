"""How a joint's motion follows from its keys, here and in Blender alike.

A joint is keyed as the quaternion of its rotation against its parent and, where it moves, as a
shift. Where every frame is a key, nothing lies between. Else each component is a cubic through its
keys whose slope at a key is that of the whole motion there, half the difference of the frames
before and after: in Blender a Bézier curve with handles at a third of the way. Quaternions are then
made units.
"""

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation


def quaternions(rotations: np.ndarray) -> np.ndarray:
    """(T, 4) quaternions w x y z of (T, 3, 3), each on the side of the sphere of the one before."""
    found = Rotation.from_matrix(rotations).as_quat()[:, [3, 0, 1, 2]]
    found[0] *= np.copysign(1.0, found[0, 0])
    turned = np.einsum("ti,ti->t", found[1:], found[:-1]) < 0
    found[1:][np.cumsum(turned) % 2 == 1] *= -1
    return found


def slopes(values: np.ndarray, times: np.ndarray) -> np.ndarray:
    """(T, K) slopes of values (T, K) at ``times`` (T,), rising."""
    return np.gradient(values, times, axis=0) if len(times) > 1 else np.zeros_like(values)


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
    slope = slopes(values, np.arange(len(values)))
    values = CubicHermiteSpline(keys, values[keys], slope[keys])(np.arange(len(values)))
    rotations = Rotation.from_quat(values[:, [1, 2, 3, 0]]).as_matrix()
    return np.concatenate([rotations, values[:, 4:, None]], axis=2)
