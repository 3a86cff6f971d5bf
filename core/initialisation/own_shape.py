"""A body in the performer's own shape, once the initial pose is known."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..body.body import Body
from ..body.kinematics import rest_height
from ..body.scaling import scaled
from ..cameras.camera import Camera
from ..energy.weight_maps import xor_weight_maps
from ..fitting.contour import ContourTracker
from ..fitting.scores import frame_scores
from ..fitting.tracker import EvaluatorFactory, Past
from ..silhouettes.silhouette import Silhouette
from .shape_fit import ShapeFit, fitted_shape

_OTHER_HEIGHT = 0.04
"""Between what is given and what the silhouettes show, as a share."""
_log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class OwnShape:
    """A body for the performer.

    Attributes:
        body: in the shape that explains the silhouettes best.
        pose: (D,) in the first of the frames.
        fit: the shape of that body.
        note: a sentence on it.
    """

    body: Body
    pose: np.ndarray
    fit: ShapeFit
    note: str


def in_own_shape(
    body: Body,
    cameras: tuple[Camera, ...],
    frames: Sequence[tuple[Silhouette, ...]],
    poses: np.ndarray,
    make_evaluator: EvaluatorFactory,
    height_m: float | None = None,
) -> OwnShape:
    """The body in the shape that the frames show.

    Where the silhouettes are explained no better by that, it stays as it is; views that disagree
    while the others agree count less.

    Args:
        body: at about the performer's scale.
        cameras: V of them.
        frames: F of them, V silhouettes each.
        poses: (F, D) about those that they show.
        make_evaluator: of a body in cameras.
        height_m: what the performer is known to be tall; None where the shape tells.
    """
    before = ContourTracker(body, cameras, make_evaluator)
    poses = _fitted(before, frames, poses)
    found = fitted_shape(body, cameras, frames, poses, make_evaluator)
    height_note = ""
    if height_m is not None:
        found, height_note = _of_height(found, height_m)
    after = ContourTracker(found.body, cameras, make_evaluator)
    last = _fitted(after, frames, found.poses)
    shown = zip(last, frames, strict=True)
    scores = [frame_scores(after.evaluator, pose, frame) for pose, frame in shown]
    trust = np.stack([score.view_weights for score in scores])
    own = float((trust * np.stack([score.xor_px for score in scores])).sum())
    plain = float((trust * _energies(before, frames, poses)).sum())
    _log.info("shape: %.0f px differ, %.0f with the template's proportions", own, plain)
    if own >= plain:
        note = "the template's own proportions explain the silhouettes best"
        logs, last = np.zeros_like(found.logs), poses
        found = replace(found, body=body, logs=logs)
    else:
        note = f"the performer's own shape leaves {1 - own / plain:.0%} fewer px apart"
    found = replace(found, poses=last)
    return OwnShape(found.body, last[0], found, note + height_note)


def _of_height(found: ShapeFit, height_m: float) -> tuple[ShapeFit, str]:
    """The shape at a height that is given, and what to say where another one is seen."""
    seen_m = rest_height(found.body)
    ratio = height_m / seen_m
    note = ""
    if abs(ratio - 1) > _OTHER_HEIGHT:
        note = (
            f"; the silhouettes show {seen_m:.2f} m: check height_m under [performer], and units "
            "under [cameras]"
        )
    return replace(found, body=scaled(found.body, ratio), logs=found.logs + np.log(ratio)), note


def _fitted(
    tracker: ContourTracker, frames: Sequence[tuple[Silhouette, ...]], poses: np.ndarray
) -> np.ndarray:
    pairs = zip(frames, poses, strict=True)
    return np.stack([tracker.fit(frame, Past.still(pose)).pose for frame, pose in pairs])


def _energies(
    tracker: ContourTracker, frames: Sequence[tuple[Silhouette, ...]], poses: np.ndarray
) -> np.ndarray:
    """(F, V) px that differ."""
    evaluator = tracker.evaluator
    return np.stack(
        [
            evaluator.energies(evaluator.prepared(xor_weight_maps(frame)), pose[None])[0]
            for frame, pose in zip(frames, poses, strict=True)
        ]
    )
