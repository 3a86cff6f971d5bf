"""The two halves of an outline, and what follows what along them.

From the top of the head down to the crotch, either half passes neck, shoulder, hand, armpit, hip
and foot, whatever the pose: each joint's creases are sought only where their turn is.
"""

from dataclasses import dataclass

import numpy as np

from .outline import Outline

CROTCH_BAND = 0.1
"""How far beside the axis of symmetry a crotch may be; ankle creases lie further out."""
_LEAST_LEG, _CROTCH_HEIGHTS = 0.15, (0.25, 0.6)
_LEAST_RISE = 0.1
_TOP = 0.01


class Unlabelled(Exception):
    """A view that does not show what the rules need, in words."""


@dataclass(frozen=True, eq=False)
class Half:
    """One half of an outline, from the top of the head to the crotch.

    Attributes:
        outline: all of it.
        indices: (n,) into the outline, in order.
        axis: (2, 2) the crotch and the top of the head, between which the halves meet.
        side: -1 for the half on the left of the picture, 1 for the right.
    """

    outline: Outline
    indices: np.ndarray
    axis: np.ndarray
    side: int

    @property
    def points(self) -> np.ndarray:
        """(n, 2) in heights."""
        return self.outline.points[self.indices]

    @property
    def outward(self) -> np.ndarray:
        """(n,) distances from the axis, positive on this half's side."""
        low, high = self.axis
        way = (high - low) / np.linalg.norm(high - low)
        apart = self.points - low
        return self.side * (apart[:, 0] * way[1] - apart[:, 1] * way[0])

    @property
    def foot(self) -> int:
        """Position of the lowest point."""
        return int(self.points[:, 1].argmin())

    def creases(self, first: int, last: int) -> np.ndarray:
        """Positions of the creases between two positions, both excluded."""
        return self._within(self.outline.creases, first, last)

    def bulges(self, first: int, last: int) -> np.ndarray:
        """Positions of the bulges between two positions, both excluded."""
        return self._within(self.outline.bulges, first, last)

    def curvature(self, positions: np.ndarray) -> np.ndarray:
        """(n,) at these positions."""
        return self.outline.curvature[self.indices[positions]]

    def _within(self, indices: np.ndarray, first: int, last: int) -> np.ndarray:
        positions = np.flatnonzero(np.isin(self.indices, indices))
        return positions[(positions > first) & (positions < last)]


def halves_of(outline: Outline) -> tuple[Half, Half]:
    """The left and the right half of the picture.

    Raises:
        Unlabelled: there is no crotch.
    """
    head, crotch = _head(outline), crotch_of(outline)
    axis = outline.points[[crotch, head]]
    left, right = outline.between(head, crotch), outline.between(crotch, head)[::-1]
    return Half(outline, left, axis, -1), Half(outline, right, axis, 1)


def crotch_of(outline: Outline) -> int:
    """Index of the crease between the legs: the one that both halves end furthest below.

    Raises:
        Unlabelled: there is none.
    """
    head = _head(outline)
    points, best, deepest = outline.points, -1, _LEAST_LEG
    for crease in outline.creases:
        if not _may_be_crotch(outline, crease, head):
            continue
        sides = outline.between(head, crease), outline.between(crease, head)
        drop = points[crease, 1] - max(points[side, 1].min() for side in sides)
        if drop > deepest:
            best, deepest = int(crease), drop
    if best < 0:
        raise Unlabelled("no crotch is seen: legs together, or seen from the side")
    return best


def _may_be_crotch(outline: Outline, crease: int, head: int) -> bool:
    place = outline.points[crease]
    aside = abs(place[0] - outline.points[head, 0])
    opens_down = outline.normals[crease, 1] < -0.5
    lowest, highest = _CROTCH_HEIGHTS
    return bool(opens_down and aside <= CROTCH_BAND and lowest <= place[1] <= highest)


def _head(outline: Outline) -> int:
    """Index of the middle of the top."""
    heights = outline.points[:, 1]
    top = np.flatnonzero(heights >= heights.max() - _TOP)
    middle = np.median(outline.points[top, 0])
    return int(top[np.abs(outline.points[top, 0] - middle).argmin()])


def first_low(half: Half, begin: int) -> int:
    """Position of the first low point after ``begin`` that the outline clearly rises from.

    Raises:
        Unlabelled: there is none before the foot.
    """
    heights = half.points[begin : half.foot + 1, 1]
    lowest = np.minimum.accumulate(heights)
    rises = np.flatnonzero(heights >= lowest + _LEAST_RISE)
    if not len(rises):
        raise Unlabelled("no hand hangs free of the body")
    return begin + int(heights[: rises[0] + 1].argmin())
