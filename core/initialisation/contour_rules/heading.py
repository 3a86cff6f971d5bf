"""Which way the performer looks, and which side of each picture is the left one.

A silhouette looks much the same from in front and from behind. Headings are tried all round: with
the right one, the joints of all views that it calls frontal meet in the world, and the line from
right to left is where the heading says. Front and back are told apart by the feet.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .facing import facing_sign
from .rays import Rays, meeting, ray
from .seen_view import SeenView

LEAST_FRONTAL = 0.5
"""Cosine of the angle between a view and the frontal direction, from which on it counts."""
_HEADINGS, _ITERATIONS = 12, 2
_LARGEST_MISS = 0.08
_SIDES = ("shoulders", "elbows", "ankles")
_POWER, _POWERS = 4, {"back": 8}
"""How much a ray counts, as powers of the frontality; oblique views see a crotch too low."""
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Heading:
    """How the performer stands.

    Attributes:
        left: (3,) horizontal unit direction to the performer's left.
        told_by_toes: whether front and back were told apart by the toes; else the performer is
            taken to look at most of the frontal cameras.
        miss: mean distance between labels and joints in the labelled views, in heights.
    """

    left: np.ndarray
    told_by_toes: bool
    miss: float

    @property
    def front(self) -> np.ndarray:
        """(3,) horizontal unit direction that the performer looks in."""
        return np.cross(self.left, _UP)

    def frontality(self, view: SeenView, centre: np.ndarray) -> float:
        """Cosine of the angle between the view and the frontal direction, whichever way round."""
        way = view.camera.centre - centre
        return float(abs(way @ self.front) / np.linalg.norm(way))


def frontal_rays(
    views: Sequence[SeenView], heading: Heading, centre: np.ndarray, name: str, side: int | None
) -> Rays:
    """The rays of one joint of the frontal views; ``side`` 0 is the performer's left."""
    chosen = [(view, heading.frontality(view, centre)) for view in views if view.joints]
    chosen = [(view, frontal) for view, frontal in chosen if frontal >= LEAST_FRONTAL]
    directions = [ray(view.camera, joint_px(view, heading, name, side)) for view, _ in chosen]
    return Rays(
        np.array([view.camera.centre for view, _ in chosen]).reshape(-1, 3),
        np.array(directions).reshape(-1, 3),
        np.array([frontal ** _POWERS.get(name, _POWER) for _, frontal in chosen]),
    )


def joint_px(view: SeenView, heading: Heading, name: str, side: int | None) -> np.ndarray:
    """(2,) px of a joint in a labelled view; ``side`` 0 is the performer's left, None no side."""
    assert view.joints is not None and view.upright is not None
    places = getattr(view.joints, name)
    if side is not None:
        swapped = view.right @ heading.left > 0
        places = places[side ^ int(swapped)]
    return view.upright.to_px(places)


def heading_of(views: Sequence[SeenView], centre: np.ndarray) -> Heading | None:
    """How the performer about ``centre`` (3,) stands; None where no two views agree."""
    angles = np.arange(_HEADINGS) * np.pi / _HEADINGS
    starts = [np.array([np.cos(a), np.sin(a), 0.0]) for a in angles]
    # headings that call the same views frontal, and the same side left, end alike
    distinct = {_sides(views, centre, start): start for start in starts}.values()
    found = [settled for start in distinct if (settled := _settled(views, centre, start))]
    if not found:
        return None
    best = min(found, key=lambda heading: heading.miss)
    sign = facing_sign(views, centre, best.front)
    if sign:
        return replace(best, left=sign * best.left, told_by_toes=True)
    towards = sum(
        np.sign((view.camera.centre - centre) @ best.front)
        for view in views
        if view.joints and best.frontality(view, centre) >= LEAST_FRONTAL
    )
    return replace(best, left=-best.left) if towards < 0 else best


def _sides(views: Sequence[SeenView], centre: np.ndarray, left: np.ndarray) -> tuple[int, ...]:
    """For each view, 1 where left is right in the picture, -1 where not, 0 where not frontal."""
    heading = Heading(left, False, np.inf)
    return tuple(
        int(np.sign(view.right @ left))
        if view.joints and heading.frontality(view, centre) >= LEAST_FRONTAL
        else 0
        for view in views
    )


def _settled(views: Sequence[SeenView], centre: np.ndarray, left: np.ndarray) -> Heading | None:
    """The heading that the joints found by a heading show, again and again."""
    heading = Heading(left, False, np.inf)
    for _ in range(_ITERATIONS):
        pairs = _pairs(views, heading, centre)
        if pairs is None:
            return None
        across = (pairs[:, 0] - pairs[:, 1]).sum(axis=0) * [1.0, 1.0, 0.0]
        length = np.linalg.norm(across)
        if length < 1e-6 or across @ heading.left < 0.7 * length:
            return None
        heading = Heading(across / length, False, np.inf)
    pairs = _pairs(views, heading, centre)
    if pairs is None:
        return None
    return replace(heading, miss=_miss(views, heading, centre, pairs))


def _pairs(views: Sequence[SeenView], heading: Heading, centre: np.ndarray) -> np.ndarray | None:
    """(n, 2, 3) left and right joints; None where fewer than two views are frontal."""
    found = []
    for name in _SIDES:
        rays = [frontal_rays(views, heading, centre, name, side) for side in (0, 1)]
        if len(rays[0].weights) < 2:
            return None
        found.append([meeting(side).point for side in rays])
    return np.array(found)


def _miss(
    views: Sequence[SeenView], heading: Heading, centre: np.ndarray, pairs: np.ndarray
) -> float:
    """Mean miss of the joints (n, 2, 3) in the labelled views; those not frontal miss by most."""
    misses = []
    for view in views:
        if view.joints is None or view.upright is None:
            continue
        if heading.frontality(view, centre) < LEAST_FRONTAL:
            misses.append(_LARGEST_MISS)
            continue
        px = [[joint_px(view, heading, name, side) for side in (0, 1)] for name in _SIDES]
        apart = np.linalg.norm(view.camera.project(pairs) - px, axis=2) / view.upright.height_px
        misses.append(float(np.minimum(apart, _LARGEST_MISS).mean()))
    return float(np.mean(misses))
