"""The poses a performer may be asked to stand in at the start of a take, and stances met unasked.

Arms and legs are solved so that elbow and wrist, knee and ankle lie where the stance says, whatever
the body's own angles are, each limb by itself under a trunk at rest.
"""

from collections.abc import Sequence
from functools import lru_cache
from itertools import product

import numpy as np
from scipy.optimize import least_squares

from ..body.body import POINT_NAMES, Body, Part
from ..body.kinematics import carried_points, clamped, points
from ..errors import MocapError
from ..fitting.twists import Twists

Direction = tuple[float, float]
"""Degrees that a bone is out to its side and to the front, from hanging straight down."""
Limb = tuple[Direction, Direction]
"""Upper arm and forearm, or thigh and shank."""

_ALIKE = {
    "A": ((45, 0), (45, 0)),
    "T": ((90, 0), (90, 0)),
    "elbows": ((80, 0), (0, 0)),
    "hanging": ((10, 0), (5, 10)),
    "bent": ((15, 0), (5, 90)),
    "forward": ((5, 80), (0, 85)),
    "up": ((150, 0), (170, 0)),
}
_ARM_AHEAD, _ARM_BEHIND = ((10, 25), (5, 45)), ((10, -25), (8, 0))
_LEG_AHEAD, _LEG_BEHIND = ((3, 25), (3, 10)), ((3, -15), (3, -40))
_SEATED = ((10, 80), (4, 0))

POSE_KINDS = ("A", "T", "elbows")
"""Those that a take may name; "elbows" has upper arms lifted, forearms hanging straight down."""
ASKED = (*POSE_KINDS, "hanging")
"""Arms of somebody who stands."""
ARMS: dict[str, tuple[Limb, Limb]] = {
    **{name: (limb, limb) for name, limb in _ALIKE.items()},
    "swinging": (_ARM_AHEAD, _ARM_BEHIND),
    "swinging back": (_ARM_BEHIND, _ARM_AHEAD),
}
"""Name -> left and right arm."""
STANDING = "standing"
LEGS: dict[str, tuple[Limb, Limb] | None] = {
    STANDING: None,
    "stepping": (_LEG_AHEAD, _LEG_BEHIND),
    "stepping back": (_LEG_BEHIND, _LEG_AHEAD),
    "sitting": (_SEATED, _SEATED),
}
"""Name -> left and right leg; None for those of the rest pose."""
_JOINTS = {"arm": ("shoulder", "elbow", "wrist"), "leg": ("hip", "knee", "ankle")}

REST = "rest"


def pose_of_kind(body: Body, kind: str) -> np.ndarray:
    """(D,) pose with the arms of ``kind``, one of `POSE_KINDS`; "rest" is the rest pose.

    Raises:
        MocapError: an unknown kind, or a body without a person's arms.
    """
    if kind == REST:
        return body.rest_pose
    if kind not in POSE_KINDS:
        kinds = ", ".join((*POSE_KINDS, REST))
        raise MocapError(f'initial_pose kind "{kind}" is unknown', f"use one of {kinds}")
    if body.point_names != POINT_NAMES:
        raise MocapError(
            f'initial_pose kind "{kind}" is a person\'s, and {body.name} is none',
            f'use "{REST}", and let the take begin in the rest pose',
        )
    return stance(body, kind, STANDING)


def kinds_to_try(kind: str) -> tuple[str, ...]:
    """The named kind first, and what else somebody may stand like who was asked for it."""
    return (kind, *(arms for arms in ASKED if arms != kind)) if kind in POSE_KINDS else (kind,)


def nearest_kind(body: Body, pose: np.ndarray, kinds: Sequence[str]) -> str:
    """Of several kinds, the one whose elbows and wrists are nearest to those of a pose (D,)."""
    arms = [POINT_NAMES.index(f"{s}_{j}") for s in ("left", "right") for j in ("elbow", "wrist")]
    upright = np.where(body.dofs.joints == 0, 0.0, pose)
    poses = np.stack([upright, *(stance(body, kind, STANDING) for kind in kinds)])
    seen, *places = points(body, poses)[:, arms]
    apart = [float(np.linalg.norm(place - seen, axis=1).mean()) for place in places]
    return kinds[int(np.argmin(apart))]


def all_stances() -> list[tuple[str, str]]:
    """Names of all `ARMS` over all `LEGS`."""
    return list(product(ARMS, LEGS))


def stance(body: Body, arms: str, legs: str) -> np.ndarray:
    """(D,) pose with limbs by the names in `ARMS` and `LEGS`; what has no such limbs is at rest.

    It faces the front, and its root is where the rest pose has it.
    """
    pose = body.rest_pose.copy()
    for part in body.parts:
        side, _, limb = part.name.partition("_")
        if part.role != "limb" or limb not in _JOINTS or body.point_names != POINT_NAMES:
            continue
        wanted = ARMS[arms] if limb == "arm" else LEGS[legs]
        if wanted is not None:
            pose[list(part.grid)] = _solved(body, part, wanted[side == "right"])
    return clamped(body, pose[None])[0]


@lru_cache(maxsize=256)
def _solved(body: Body, part: Part, wanted: Limb) -> np.ndarray:
    """Values of the part's grid that bring its joints where they are ``wanted``."""
    dofs, (side, _, limb) = list(part.grid), part.name.partition("_")
    indices = [POINT_NAMES.index(f"{side}_{joint}") for joint in _JOINTS[limb]]
    twists = Twists(body)

    def joints(values: np.ndarray) -> np.ndarray:
        pose = body.rest_pose.copy()
        pose[dofs] = values
        return carried_points(body, twists.at(pose)[0][None])[0, indices]

    first, *_ = at_rest = joints(np.zeros(len(dofs)))
    lengths = np.linalg.norm(np.diff(at_rest, axis=0), axis=1)
    outward = 1.0 if side == "left" else -1.0
    bones = [_direction(direction, outward) for direction in wanted]
    targets = first + np.cumsum(lengths[:, None] * bones, axis=0)
    low, high = body.dofs.limits[dofs].T
    start = np.clip(np.full(len(dofs), 0.1), low + 1e-3, high - 1e-3)
    found = least_squares(lambda v: (joints(v)[1:] - targets).ravel(), start, bounds=(low, high))
    return np.round(found.x, 4)


def _direction(wanted: Direction, outward: float) -> np.ndarray:
    """(3,) unit vector."""
    out, front = np.radians(wanted)
    ahead, down = np.cos(out) * np.sin(front), np.cos(out) * np.cos(front)
    return np.array([outward * np.sin(out), -ahead, -down])
