"""Rules 1 to 5: which creases and cuts of one view are which joints.

1. Back: the crotch, the lowest crease but for those beside the axis of symmetry (the ankles').
2. Neck: the middle of the cut between the two highest creases.
3. The axis from neck to back splits left and right.
4. Shoulder: the middle of the cut between a side's highest crease and its lowest one but the back.
5. Elbow: the middle of the cut between the crease and the bulge of extreme x.

(Jaume-i-Capó et al. 2012, "Initialization of the Body Model".) By default, highest, lowest and
extreme are sought where the order along the contour says, so that ears, waists and fingers do not
count, and where creases compete, the short-cut rule decides. `LITERAL` takes the rules at their
word among the creases above the back.

Straight arms have no elbow crease: elbow and wrist are then shares of the arm's length along its
middle line, as the wrist of a bent arm is of the forearm's. Feet, of which the rules do not speak,
are the ankles: the narrowest cut across each lower leg.
"""

from dataclasses import dataclass

import numpy as np

from ...geometry.arrays import frozen_array
from .arms import Arm, bent_arm, straight_arm
from .cuts import Cut, cut_between, shortest_cut
from .halves import Half, Unlabelled, halves_of
from .middle_lines import ankle_cut, arm_line, forearm_line
from .outline import Outline

ORDER, LITERAL = "order", "literal"
MODES = (ORDER, LITERAL)
ELBOW_SHARE, WRIST_SHARE = 0.42, 0.76
"""Of the length from the middle of the shoulder cut to the fingertips."""
FOREARM_SHARE = 0.59
"""Wrist, as a share of the length from elbow to fingertips."""
_NECK_REACH, _LEAST_HEAD = 0.16, 0.07
_NECK_SLANT, _MOST_SLANT = 0.27, 0.7
"""Tangents of the angles up to which cuts of the neck compete, and up to which one is taken."""


@dataclass(frozen=True, eq=False)
class Labelled:
    """What one view shows, in heights; sides are the picture's, left first.

    Attributes:
        back: (2,) the crotch.
        neck: (2,).
        shoulders: (2, 2).
        elbows: (2, 2).
        wrists: (2, 2).
        ankles: (2, 2).
        tips: (2, 2) ends of the hands.
        cuts: by name, for those who look.
    """

    back: np.ndarray
    neck: np.ndarray
    shoulders: np.ndarray
    elbows: np.ndarray
    wrists: np.ndarray
    ankles: np.ndarray
    tips: np.ndarray
    cuts: dict[str, Cut]

    def __post_init__(self):
        for name in ("back", "neck"):
            object.__setattr__(self, name, frozen_array(getattr(self, name), (2,), name))
        for name in ("shoulders", "elbows", "wrists", "ankles", "tips"):
            object.__setattr__(self, name, frozen_array(getattr(self, name), (2, 2), name))


def labelled(outline: Outline, kind: str, mode: str = ORDER) -> Labelled:
    """The joints of an outline that shows a pose of ``kind``: "A", "T" or "elbows".

    Raises:
        Unlabelled: it does not.
    """
    halves = halves_of(outline)
    find_arm = bent_arm if kind == "elbows" else straight_arm
    arms = find_arm(halves[0]), find_arm(halves[1])
    neck = _neck(halves, arms, mode)
    shoulders = _shoulders(halves, arms, neck, mode)
    cuts = {"neck": neck, "left shoulder": shoulders[0], "right shoulder": shoulders[1]}
    elbows, wrists = [], []
    for half, arm, shoulder, side in zip(halves, arms, shoulders, ("left", "right"), strict=True):
        if arm.elbow is None:
            places = arm_line(half, arm, shoulder).at([ELBOW_SHARE, WRIST_SHARE])
            elbows.append(places[0])
            wrists.append(places[1])
            continue
        cuts[f"{side} elbow"] = cut = _elbow(half, arm, mode)
        elbows.append(cut.middle)
        wrists.append(forearm_line(half, arm, cut).at([FOREARM_SHARE])[0])
    for half, side in zip(halves, ("left", "right"), strict=True):
        cuts[f"{side} ankle"] = ankle_cut(half)
    return Labelled(
        back=halves[0].axis[0],
        neck=neck.middle,
        shoulders=np.stack([cut.middle for cut in shoulders]),
        elbows=np.stack(elbows),
        wrists=np.stack(wrists),
        ankles=np.stack([cuts[f"{side} ankle"].middle for side in ("left", "right")]),
        tips=np.stack([half.points[arm.tip] for half, arm in zip(halves, arms, strict=True)]),
        cuts=cuts,
    )


def _neck(halves: tuple[Half, Half], arms: tuple[Arm, Arm], mode: str) -> Cut:
    """Rule 2, by the short-cut rule among the creases between head and shoulder."""
    sides = [_neck_creases(half, arm, mode) for half, arm in zip(halves, arms, strict=True)]
    if not all(len(side) for side in sides):
        raise Unlabelled("no neck is seen")
    outline = halves[0].outline
    competing = [shortest_cut(outline, a, b) for a in sides[0][:, None] for b in sides[1][:, None]]
    slanting = {_slant(cut): cut for cut in competing if cut is not None}
    if not slanting or min(slanting) > _MOST_SLANT:
        raise Unlabelled("no cut through the neck lies inside the body")
    level = [cut for slant, cut in slanting.items() if slant <= max(_NECK_SLANT, min(slanting))]
    return min(level, key=lambda cut: cut.length)


def _slant(cut: Cut) -> float:
    across, up = np.abs(cut.ends[1] - cut.ends[0])
    return float(up / max(across, 1e-9))


def _neck_creases(half: Half, arm: Arm, mode: str) -> np.ndarray:
    """Indices of the creases of this side's neck."""
    creases = half.creases(0, arm.elbow[0] if arm.elbow else arm.tip)
    low, high = half.points[arm.armpit, 1], half.axis[1, 1] - _LEAST_HEAD
    heights = half.points[creases, 1]
    near = (half.outward[creases] <= _NECK_REACH) & (heights > low) & (heights < high)
    creases = half.indices[creases[near]]
    return creases[:1] if mode == LITERAL else creases


def _shoulders(
    halves: tuple[Half, Half], arms: tuple[Arm, Arm], neck: Cut, mode: str
) -> tuple[Cut, Cut]:
    """Rule 4: from the neck's crease to the armpit's."""
    found = []
    for half, arm, top in zip(halves, arms, (neck.first, neck.last), strict=True):
        bottom = half.indices[arm.armpit]
        if mode == LITERAL:
            bottom = _lowest_above_back(half)
        found.append(cut_between(half.outline, top, bottom))
    return found[0], found[1]


def _lowest_above_back(half: Half) -> int:
    """Index of the lowest crease of this side but the back and those below it."""
    creases = half.creases(0, half.foot)
    creases = creases[half.points[creases, 1] > half.axis[0, 1]]
    if not len(creases):
        raise Unlabelled("no crease below the shoulder")
    return int(half.indices[creases[half.points[creases, 1].argmin()]])


def _elbow(half: Half, arm: Arm, mode: str) -> Cut:
    """Rule 5."""
    assert arm.elbow is not None
    bulge, crease = arm.elbow
    if mode == LITERAL:
        creases = half.creases(0, half.foot)
        crease = int(creases[half.outward[creases].argmax()])
    return cut_between(half.outline, *half.indices[[bulge, crease]])
