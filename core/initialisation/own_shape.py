"""A body in the performer's own shape, once the initial pose is known."""

import logging
from collections.abc import Sequence

import numpy as np

from ..body.body import Body
from ..body.kinematics import rest_height
from ..body.scaling import scaled
from ..cameras.camera import Camera
from ..energy.weight_maps import xor_weight_maps
from ..fitting.contour import ContourTracker
from ..fitting.tracker import EvaluatorFactory, Past
from ..silhouettes.silhouette import Silhouette
from .shape_fit import fitted_shape

_log = logging.getLogger(__name__)


def in_own_shape(
    body: Body,
    cameras: tuple[Camera, ...],
    frames: Sequence[tuple[Silhouette, ...]],
    pose: np.ndarray,
    make_evaluator: EvaluatorFactory,
    height_m: float | None = None,
) -> tuple[Body, np.ndarray, str]:
    """The body in the shape that the frames show, its pose (D,) in the first, and a note.

    Where the silhouettes are explained no better by that, the body stays as it is.

    Args:
        body: at about the performer's scale.
        cameras: V of them.
        frames: V silhouettes each; all show about the same pose.
        pose: (D,) the pose.
        make_evaluator: of a body in cameras.
        height_m: what the performer is known to be tall; None where the shape tells.
    """
    before = ContourTracker(body, cameras, make_evaluator)
    poses = np.stack([before.fit(frame, Past.still(pose)).pose for frame in frames])
    found = fitted_shape(body, cameras, frames, poses, make_evaluator)
    shaped, last = found.body, found.poses
    if height_m is not None:
        shaped = scaled(shaped, height_m / rest_height(shaped))
    after = ContourTracker(shaped, cameras, make_evaluator)
    last = np.stack([after.fit(f, Past.still(p)).pose for f, p in zip(frames, last, strict=True)])
    plain, own = _energy(before, frames, poses), _energy(after, frames, last)
    _log.info("shape: %d px differ, %d with the template's proportions", own, plain)
    if own >= plain:
        return body, poses[0], "the template's own proportions explain the silhouettes best"
    return shaped, last[0], f"the performer's own shape leaves {1 - own / plain:.0%} fewer px apart"


def _energy(
    tracker: ContourTracker, frames: Sequence[tuple[Silhouette, ...]], poses: np.ndarray
) -> int:
    evaluator = tracker.evaluator
    return sum(
        int(evaluator.energies(evaluator.prepared(xor_weight_maps(frame)), pose[None]).sum())
        for frame, pose in zip(frames, poses, strict=True)
    )
