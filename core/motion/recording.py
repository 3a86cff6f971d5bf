"""Tracked frames put together as a motion."""

from collections.abc import Callable, Sequence
from fractions import Fraction

import numpy as np

from ..body.body import POINT_NAMES, Body
from ..body.kinematics import joint_positions, points
from ..fitting.tracking import FrameFit
from .motion import Motion

_BLOCK = 500
"""Poses."""


def recorded(
    fits: Sequence[FrameFit], body: Body, camera_names: Sequence[str], fps: Fraction
) -> Motion:
    """The motion of ``fits`` in the order of their frames.

    Raises:
        ValueError: no fit.
    """
    if not fits:
        raise ValueError("expected at least one tracked frame")
    fits = sorted(fits, key=lambda fit: fit.frame)
    poses = np.stack([fit.pose for fit in fits])
    scores = [fit.scores for fit in fits]
    confidence = np.stack([s.confidence for s in scores])
    return Motion(
        fps=(fps.numerator, fps.denominator),
        frames=np.array([fit.frame for fit in fits]),
        pose=poses,
        pose_raw=poses.copy(),
        dof_names=body.dofs.names,
        joints=in_blocks(joint_positions, body, poses),
        joint_names=body.joint_names,
        points=in_blocks(points, body, poses),
        point_names=POINT_NAMES,
        xor_px=np.stack([s.xor_px for s in scores]),
        iou=np.stack([s.iou for s in scores]),
        view_weights=np.stack([s.view_weights for s in scores]),
        limb_residual=np.stack([s.limb_residual for s in scores]),
        camera_names=tuple(camera_names),
        confidence=confidence,
        lost=np.array([s.lost for s in scores]),
        locked=np.array([fit.locked for fit in fits]),
        confidence_raw=confidence.copy(),
        keyed=np.ones((len(fits), len(body.joint_names)), bool),
    )


def in_blocks(
    places: Callable[[Body, np.ndarray], np.ndarray], body: Body, poses: np.ndarray
) -> np.ndarray:
    """The (T, …) places of all poses; long takes would need much memory for their transforms."""
    blocks = np.array_split(poses, range(_BLOCK, len(poses), _BLOCK))
    return np.concatenate([places(body, block) for block in blocks])
