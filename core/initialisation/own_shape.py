"""A body in the performer's own shape, once the initial pose is known."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..body.body import Body
from ..body.kinematics import rest_height
from ..body.scaling import scaled
from ..cameras.camera import Camera
from ..energy.weight_maps import xor_weight_maps
from ..fitting.contour import ContourTracker
from ..fitting.tracker import EvaluatorFactory, Past
from ..silhouettes.silhouette import Silhouette
from .shape_fit import ShapeFit, fitted_shape

_log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class OwnShape:
    """A body for the performer.

    Attributes:
        body: in the shape that explains the silhouettes best.
        pose: (D,) in the first of the frames.
        fit: what was found of the shape.
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

    Where the silhouettes are explained no better by that, it stays as it is.

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
    shaped = found.body
    if height_m is not None:
        shaped = scaled(shaped, height_m / rest_height(shaped))
    after = ContourTracker(shaped, cameras, make_evaluator)
    last = _fitted(after, frames, found.poses)
    plain, own = _energy(before, frames, poses), _energy(after, frames, last)
    _log.info("shape: %d px differ, %d with the template's proportions", own, plain)
    if own >= plain:
        note = "the template's own proportions explain the silhouettes best"
        return OwnShape(body, poses[0], found, note)
    note = f"the performer's own shape leaves {1 - own / plain:.0%} fewer px apart"
    return OwnShape(shaped, last[0], found, note)


def _fitted(
    tracker: ContourTracker, frames: Sequence[tuple[Silhouette, ...]], poses: np.ndarray
) -> np.ndarray:
    pairs = zip(frames, poses, strict=True)
    return np.stack([tracker.fit(frame, Past.still(pose)).pose for frame, pose in pairs])


def _energy(
    tracker: ContourTracker, frames: Sequence[tuple[Silhouette, ...]], poses: np.ndarray
) -> int:
    evaluator = tracker.evaluator
    return sum(
        int(evaluator.energies(evaluator.prepared(xor_weight_maps(frame)), pose[None]).sum())
        for frame, pose in zip(frames, poses, strict=True)
    )
