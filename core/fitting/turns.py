"""Other headings of the trunk, for a body that stands in its place and cannot be explained.

A trunk looks much the same whichever way it faces. Where it has turned unnoticed, the arms have
nowhere to be found, each by itself as little as both together; only after the trunk is turned back,
on its feet, does every limb fall into place.
"""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import least_squares

from ..body.body import Body, DofKind, Part
from ..body.kinematics import clamped
from ..energy.evaluator import Evaluator
from .limbs import LIMB_NAMES

_TURNS = np.radians([-70.0, -45.0, -25.0, 0.0, 25.0, 45.0, 70.0])
ARMS, _LEGS = LIMB_NAMES[1:3], LIMB_NAMES[3:]
_LEVER_M = 0.1
"""What a turn of a leg's joints by a radian is worth beside their places."""
_INSIDE = 0.1
"""rad, so far from its limits a leg begins: beside one it would hardly move."""
_STEPS = 15


def heading_dof(body: Body) -> int:
    """Index of the DOF that turns the root about the vertical."""
    turns = np.flatnonzero((body.dofs.joints == 0) & (body.dofs.kinds != DofKind.TRANSLATION))
    return int(turns[np.argmax(np.abs(body.dofs.axes[turns, 2]))])


def turned(evaluator: Evaluator, pose: np.ndarray) -> np.ndarray:
    """(n, D) poses with the trunk of ``pose`` (D,) turned either way, or not.

    The legs stand where they are, the arms are as they are or at rest. Besides, the whole body
    faces the other way with left and right exchanged, and the legs alone are. ``pose`` itself is
    none of them.
    """
    body, heading = evaluator.body, heading_dof(evaluator.body)
    legs = [part for part in body.parts if part.name in _LEGS]
    arms = [dof for part in body.parts if part.name in ARMS for dof in part.dofs]
    found = []
    for turn in _TURNS.tolist():
        start = pose.copy()
        start[heading] += turn
        for leg in legs if turn else ():
            start = _held(evaluator, pose, start, leg)
        resting = start.copy()
        resting[arms] = body.rest_pose[arms]
        found += [start, resting]
    poses = np.stack([*found, turned_about(body, pose), _exchanged(body, pose, _LEGS)])
    poses = clamped(body, poses)
    return poses[(poses != pose).any(axis=1)]


def turned_about(body: Body, pose: np.ndarray) -> np.ndarray:
    """(D,) the pose facing the other way, with left and right limbs exchanged."""
    about, heading = _exchanged(body, pose, (*ARMS, *_LEGS)), heading_dof(body)
    about[heading] += np.pi if pose[heading] < 0 else -np.pi
    return about


def _exchanged(body: Body, pose: np.ndarray, limbs: Sequence[str]) -> np.ndarray:
    """(D,) the pose whose left and right ``limbs`` have each other's angles."""
    names, exchanged = list(body.dofs.names), pose.copy()
    for dof in [dof for part in body.parts if part.name in limbs for dof in part.dofs]:
        side, _, rest = names[dof].partition("_")
        other = f"{'right' if side == 'left' else 'left'}_{rest}"
        if other in names:
            exchanged[dof] = pose[names.index(other)]
    return exchanged


def _held(evaluator: Evaluator, before: np.ndarray, pose: np.ndarray, part: Part) -> np.ndarray:
    """(D,) the pose with the joints of a part as near as can be to where they were ``before``."""
    body, dofs = evaluator.body, list(part.dofs)
    joints = np.unique(body.segment_joints[list(part.segments)])
    wanted = evaluator.transforms(before[None])[0, joints]

    def away(values: np.ndarray) -> np.ndarray:
        moved = pose.copy()
        moved[dofs] = values
        gaps = evaluator.transforms(moved[None])[0, joints] - wanted
        return np.concatenate([_LEVER_M * gaps[..., :3].ravel(), gaps[..., 3].ravel()])

    low, high = body.dofs.limits[dofs].T
    room = np.minimum(_INSIDE, (high - low) / 4)
    start = np.clip(pose[dofs], low + room, high - room)
    held = pose.copy()
    held[dofs] = least_squares(away, start, bounds=(low, high), max_nfev=_STEPS).x
    return held
