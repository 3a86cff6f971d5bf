"""Tracked frames put together as a motion."""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from ..body.body import Body
from ..body.kinematics import in_blocks, joint_positions, points
from ..fitting.limbs import limb_names, point_limbs
from ..fitting.tracking import Fits, FrameFit, columns
from .motion import Motion


def recorded(fits: Fits, body: Body, camera_names: Sequence[str], fps: Fraction) -> Motion:
    """The motion that ``fits`` are.

    Raises:
        ValueError: no fit.
    """
    if not fits:
        raise ValueError("expected at least one tracked frame")
    frames = sorted(fits)
    poses, locked, xor_px, iou, view_weights, residual, confidence, lost = columns(
        fits, frames, _recorded
    )
    return Motion(
        fps=(fps.numerator, fps.denominator),
        frames=np.array(frames),
        pose=poses,
        pose_raw=poses.copy(),
        dof_names=body.dofs.names,
        joints=in_blocks(joint_positions, body, poses),
        joint_names=body.joint_names,
        points=in_blocks(points, body, poses),
        point_names=body.point_names,
        xor_px=xor_px,
        iou=iou,
        view_weights=view_weights,
        limb_residual=residual,
        camera_names=tuple(camera_names),
        confidence=confidence,
        lost=lost,
        locked=locked,
        confidence_raw=confidence.copy(),
        keyed=np.ones((len(fits), len(body.joint_names)), bool),
        limb_names=limb_names(body),
        point_limbs=point_limbs(body),
    )


def _recorded(fit: FrameFit) -> tuple:
    """What a motion holds of a fit."""
    s = fit.scores
    shares = (s.xor_px, s.iou, s.view_weights, s.limb_residual)
    return (fit.pose, fit.locked, *shares, s.confidence, s.lost)
