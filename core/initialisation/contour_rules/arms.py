"""The arms of an outline: where each begins, bends and ends."""

from dataclasses import dataclass

import numpy as np

from .cuts import shortest_cut
from .halves import Half, Unlabelled, first_low

_LEAST_REACH = 0.15
"""How far from the axis of symmetry an arm has to reach, in heights."""
_ARMPIT_REACH = 0.75
_LEAST_ARM = 0.12
_THICKEST = 0.12
_AS_FAR_OUT = 0.03
_INWARDS = 0.6
"""How much further in makes an armpit as deep as further up: between arm and waist."""


@dataclass(frozen=True)
class Arm:
    """Positions along a half; those of an elbow only where the pose bends it.

    Attributes:
        tip: the end of the hand.
        armpit: its crease.
        elbow: its bulge outside and its crease inside; None for a straight arm.
    """

    tip: int
    armpit: int
    elbow: tuple[int, int] | None = None


def straight_arm(half: Half) -> Arm:
    """The arm of an A- or T-pose.

    Raises:
        Unlabelled: it does not reach out, or shows no armpit.
    """
    tip = _outermost(half)
    return Arm(tip, armpit_of(half, tip, tip))


def bent_arm(half: Half) -> Arm:
    """The arm of a lifted elbow below which the hand hangs.

    The bulge is the first of those furthest out, as the forearm hangs straight down from it, the
    crease the one that the shortest cut from there ends at.

    Raises:
        Unlabelled: it shows no armpit, no hand or no crease.
    """
    bulges = half.bulges(0, first_low(half, _outermost(half)))
    if not len(bulges):
        raise Unlabelled("no elbow sticks out")
    outward = half.outward[bulges]
    bulge = int(bulges[outward >= outward.max() - _AS_FAR_OUT][0])
    tip = first_low(half, bulge)
    armpit = armpit_of(half, tip, bulge)
    creases = half.indices[half.creases(tip, armpit)]
    cut = shortest_cut(half.outline, half.indices[[bulge]], creases)
    if cut is None or cut.length > _THICKEST:
        raise Unlabelled("no elbow is bent")
    return Arm(tip, armpit, (bulge, int(np.flatnonzero(half.indices == cut.last)[0])))


def _outermost(half: Half) -> int:
    """Position of the point furthest out above the crotch."""
    above = half.points[:, 1] >= half.axis[0, 1]
    above[half.foot :] = False
    outward = np.where(above, half.outward, -np.inf)
    if outward.max() < _LEAST_REACH:
        raise Unlabelled("an arm does not reach out: arms down, or seen from the side")
    return int(outward.argmax())


def armpit_of(half: Half, tip: int, reach: int) -> int:
    """Position of the deepest crease of the pocket between hand and foot, up and inwards.

    Args:
        half: where.
        tip: position of the end of the hand.
        reach: position of the point furthest out.

    Raises:
        Unlabelled: there is none between arm and trunk.
    """
    creases = half.creases(tip, half.foot)
    places = half.points[creases]
    outward, heights = half.outward[creases], places[:, 1]
    free = np.linalg.norm(places - half.points[tip], axis=1) >= _LEAST_ARM
    free &= outward <= _ARMPIT_REACH * half.outward[reach]
    free &= heights > half.axis[0, 1] + _LEAST_ARM
    if not free.any():
        raise Unlabelled("no armpit is seen: arms down, or the hands touch the body")
    depths = heights - _INWARDS * outward
    return int(creases[free][depths[free].argmax()])
