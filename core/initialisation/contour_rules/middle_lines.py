"""The middle lines of arms and legs, and places along them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import KDTree

from ...geometry.arrays import frozen_array
from .arms import Arm
from .cuts import Cut, cut_between
from .halves import Half, Unlabelled

_SHANK = (0.62, 0.9)
"""Between which shares of the way from crotch to sole a lower leg is narrowest."""
_AS_NARROW = 1.1
"""The lowest of the cuts that are hardly longer than the shortest: legs change slowly there."""
_SMOOTH = 6.0


@dataclass(frozen=True, eq=False)
class MiddleLine:
    """The middle of a limb, from its root to its tip.

    Attributes:
        points: (n, 2) in heights.
    """

    points: np.ndarray

    def __post_init__(self):
        object.__setattr__(self, "points", frozen_array(self.points, (None, 2), "points"))

    def at(self, shares: Sequence[float]) -> np.ndarray:
        """(k, 2) places at these shares of its length."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        wanted = np.asarray(shares) * along[-1]
        return np.stack([np.interp(wanted, along, column) for column in self.points.T], axis=1)


def arm_line(half: Half, arm: Arm, shoulder: Cut) -> MiddleLine:
    """From the middle of the shoulder cut to the fingertips of a straight arm."""
    return _line(half, arm, shoulder.middle, outer=0, inner=arm.armpit)


def forearm_line(half: Half, arm: Arm, elbow: Cut) -> MiddleLine:
    """From the middle of the elbow cut to the fingertips."""
    assert arm.elbow is not None
    return _line(half, arm, elbow.middle, *arm.elbow)


def _line(half: Half, arm: Arm, root: np.ndarray, outer: int, inner: int) -> MiddleLine:
    """Through the middles between the inner contour and what is nearest to it outside."""
    outside, inside = half.points[outer : arm.tip + 1], half.points[arm.tip : inner + 1][::-1]
    nearest = KDTree(outside).query(inside)[1]
    middles = (inside + outside[nearest]) / 2
    tip = half.points[arm.tip]
    middles = gaussian_filter1d(middles, _SMOOTH, axis=0, mode="nearest")
    ahead = (middles - root) @ (tip - root) / np.linalg.norm(tip - root)
    onward = np.maximum.accumulate(ahead)
    kept = (ahead > 0) & (ahead >= onward) & (ahead < np.linalg.norm(tip - root))
    return MiddleLine(np.concatenate([root[None], middles[kept], tip[None]]))


def ankle_cut(half: Half) -> Cut:
    """The narrowest cut across the lower leg.

    Raises:
        Unlabelled: the leg is too short to have one.
    """
    top, sole = half.axis[0, 1], half.points[half.foot, 1]
    shares = (top - half.points[:, 1]) / (top - sole)
    shank = (shares >= _SHANK[0]) & (shares <= _SHANK[1])
    positions = np.arange(len(shares))
    outer, inner = (np.flatnonzero(shank & (positions * s < half.foot * s)) for s in (1, -1))
    if not len(outer) or not len(inner):
        raise Unlabelled("a lower leg is hidden")
    distances, nearest = KDTree(half.points[outer]).query(half.points[inner])
    narrow = np.flatnonzero(distances <= _AS_NARROW * distances.min())
    best = int(narrow[np.argmin(half.points[inner[narrow], 1])])
    ends = half.indices[[outer[int(np.asarray(nearest)[best])], inner[best]]]
    return cut_between(half.outline, *ends)
