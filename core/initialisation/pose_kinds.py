"""The poses a performer may be asked to stand in at the start of a take."""

import numpy as np
from scipy.optimize import least_squares

from ..body.body import POINT_NAMES, Body
from ..body.kinematics import points
from ..errors import MocapError

POSE_KINDS = {"A": (45.0, None), "T": (90.0, None), "elbows": (80.0, 0.0)}
"""Kind -> degrees that upper arm and forearm are out from hanging; None: forearm as upper arm."""


def pose_of_kind(body: Body, kind: str) -> np.ndarray:
    """(D,) pose with the arms of ``kind``: "A", "T" or "elbows" (forearms hanging straight down).

    The arms' DOFs are solved so that elbow and wrist lie where the kind says, whatever the body's
    own angles are.

    Raises:
        MocapError: an unknown kind.
    """
    if kind not in POSE_KINDS:
        raise MocapError(
            f'initial_pose kind "{kind}" is unknown', f"use one of {', '.join(POSE_KINDS)}"
        )
    pose = body.rest_pose.copy()
    for part in body.parts:
        if part.role == "limb" and part.name.endswith("_arm"):
            dofs = list(part.grid)
            pose[dofs] = _solved_arm(body, dofs, part.name.removesuffix("_arm"), kind)
    return pose


def _solved_arm(body: Body, dofs: list[int], side: str, kind: str) -> np.ndarray:
    indices = [POINT_NAMES.index(f"{side}_{joint}") for joint in ("shoulder", "elbow", "wrist")]

    def arm(values: np.ndarray) -> np.ndarray:
        pose = body.rest_pose.copy()
        pose[dofs] = values
        return points(body, pose[None])[0, indices]

    shoulder, elbow, wrist = arm(np.zeros(len(dofs)))
    upper, fore = POSE_KINDS[kind]
    outward = 1.0 if side == "left" else -1.0
    elbow_target = shoulder + np.linalg.norm(elbow - shoulder) * _hanging(upper, outward)
    fore_direction = _hanging(upper if fore is None else fore, outward)
    wrist_target = elbow_target + np.linalg.norm(wrist - elbow) * fore_direction
    low, high = body.dofs.limits[dofs].T
    start = np.clip(np.full(len(dofs), 0.1), low + 1e-3, high - 1e-3)
    targets = np.concatenate([elbow_target, wrist_target])
    found = least_squares(lambda v: arm(v)[1:].ravel() - targets, start, bounds=(low, high))
    return np.round(found.x, 4)


def _hanging(degrees: float, outward: float) -> np.ndarray:
    """Unit direction in the frontal plane, ``degrees`` out from hanging straight down."""
    angle = np.radians(degrees)
    return np.array([outward * np.sin(angle), 0.0, -np.cos(angle)])
