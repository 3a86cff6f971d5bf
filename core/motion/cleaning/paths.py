"""Filters for vectors, applied to rotations over time.

A path of rotations R_t is unrolled into the sum of its steps, D_t = sum log(R_(s+1) R_s^T), each in
the space around the joint; what a filter changes of D is turned back onto R. A curve of constant
angular velocity is so a straight line, and penalised acceleration is angular acceleration. Steps of
a noisy path do not commute, so it is unrolled along the filtered path, which is found in a few
rounds (after Jupp and Kent: Fitting smooth paths to spherical data, 1987).
"""

from collections.abc import Callable

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from .joint_rotations import exponentials, logarithms

Smoother = Callable[[np.ndarray], np.ndarray]
"""(T, K) values to (T, K) values."""

_ROUNDS = 4


def smoothed_rotations(rotations: np.ndarray, gaps: np.ndarray, smoother: Smoother) -> np.ndarray:
    """(T, 3, 3) what ``smoother`` makes of rotations (T, 3, 3), if angles were vectors.

    In the frames that are ``gaps`` (T,) rotations count for nothing.
    """
    found = bridged_rotations(rotations, gaps)
    for _ in range(_ROUNDS):
        steps = logarithms(found[1:] @ found[:-1].transpose(0, 2, 1))
        path = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
        off = logarithms(rotations @ found.transpose(0, 2, 1))
        found = exponentials(smoother(path + off) - path) @ found
    return found


def bridged_rotations(rotations: np.ndarray, gaps: np.ndarray) -> np.ndarray:
    """Rotations (T, 3, 3) with those in ``gaps`` (T,) turned evenly from one side to the other."""
    known = np.flatnonzero(~gaps)
    if len(known) < 2:
        return np.repeat(rotations[known[:1]], len(rotations), axis=0)
    between = Slerp(known, Rotation.from_matrix(rotations[known]))
    return between(np.clip(np.arange(len(gaps)), known[0], known[-1])).as_matrix()


def bridged_values(values: np.ndarray, gaps: np.ndarray) -> np.ndarray:
    """Values (T, K) with those in ``gaps`` (T,) drawn straight from one side to the other."""
    known, times = np.flatnonzero(~gaps), np.arange(len(gaps))
    return np.column_stack([np.interp(times, known, column[known]) for column in values.T])
