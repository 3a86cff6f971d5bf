"""The short-cut rule: where a silhouette is cut into parts.

A cut (1) is straight, (2) crosses an axis of local symmetry, (3) joins two points of the outline,
one of them at least with negative curvature, and (4) is the shortest of those that compete (Singh,
Seyranian and Hoffman 1999; Jaume-i-Capó et al. 2012). It runs through the body, not beside it.

A point is on an axis of local symmetry if the outline is equally near to it on two sides. Where the
nearest point of the outline jumps from one side to another that faces it, a cut crosses an axis.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from scipy.spatial import KDTree

from ...geometry.arrays import frozen_array
from .outline import Outline

_STEPS = 24
_GRAZE = 0.004
"""How far a cut may run beside the body, in heights: less than a pixel."""
_FACING, _APART = 0.2, 0.02
"""Cosine between the directions to both sides of an axis, at most, and their least distance."""


@dataclass(frozen=True, eq=False)
class Cut:
    """A straight cut between two points of an outline.

    Attributes:
        first: index of the one end.
        last: index of the other.
        ends: (2, 2) where they are.
    """

    first: int
    last: int
    ends: np.ndarray

    def __post_init__(self):
        object.__setattr__(self, "ends", frozen_array(self.ends, (2, 2), "ends"))

    @property
    def middle(self) -> np.ndarray:
        """(2,) halfway."""
        return self.ends.mean(axis=0)

    @property
    def length(self) -> float:
        """In heights of the performer."""
        return float(np.linalg.norm(self.ends[1] - self.ends[0]))


def cut_between(outline: Outline, first: int, last: int) -> Cut:
    """The straight cut between two points of the outline, whether the rule allows it or not."""
    return Cut(int(first), int(last), outline.points[[first, last]])


def shortest_cut(outline: Outline, firsts: np.ndarray, lasts: np.ndarray) -> Cut | None:
    """The shortest cut that the rule allows from an index in one array to one in the other."""
    competing = [cut_between(outline, a, b) for a in firsts for b in lasts if a != b]
    for cut in sorted(competing, key=lambda cut: cut.length):
        if allowed(outline, cut):
            return cut
    return None


def allowed(outline: Outline, cut: Cut) -> bool:
    """Whether the short-cut rule allows a cut, were it without competitors."""
    creased = outline.curvature[[cut.first, cut.last]].min() < 0
    return bool(creased) and runs_inside(outline, cut) and crosses_symmetry_axis(outline, cut)


def runs_inside(outline: Outline, cut: Cut) -> bool:
    """Whether all of the cut lies in the body."""
    polygon = outline.points.astype(np.float32)[:, None]
    places = _along(cut)[1:-1].tolist()
    return all(cv2.pointPolygonTest(polygon, place, True) >= -_GRAZE for place in places)


def crosses_symmetry_axis(outline: Outline, cut: Cut) -> bool:
    """Whether somewhere along the cut the outline is equally near on two sides that face."""
    places = _along(cut)[1:-1]
    distances, nearest = KDTree(outline.points).query(places)
    ways = (outline.points[nearest] - places) / np.maximum(distances, 1e-9)[:, None]
    facing = np.sum(ways[1:] * ways[:-1], axis=1) <= _FACING
    apart = np.linalg.norm(np.diff(outline.points[nearest], axis=0), axis=1)
    return bool((facing & (apart >= _APART)).any())


def _along(cut: Cut) -> np.ndarray:
    """(n, 2) places from end to end."""
    shares = np.linspace(0.0, 1.0, _STEPS + 1)[:, None]
    return cut.ends[0] + shares * (cut.ends[1] - cut.ends[0])
