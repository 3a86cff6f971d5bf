"""Position, heading, scale, pose and shape of the performer in the initial pose.

The performer stands in a known pose (SPEC §5, `initial_pose`). Position comes from the rays through
the silhouettes' centroids, the uniform scale from the silhouettes' extent or the given height, the
heading from the XOR energy: a ring of headings is fitted roughly, and the best four completely,
since a silhouette looks much the same from in front and from behind, and the best fit wins.
"""

import logging
from dataclasses import dataclass, replace

import numpy as np

from ..body.body import Body, DofKind
from ..body.kinematics import rest_height
from ..body.scaling import scaled
from ..cameras.camera import Camera
from ..fitting.hierarchical import FAITHFUL, HierarchicalTracker
from ..fitting.scores import frame_scores
from ..fitting.tracker import EvaluatorFactory, Past, PoseFit
from ..silhouettes.silhouette import Silhouette
from .own_shape import in_own_shape
from .pose_kinds import pose_of_kind
from .standing import body_centre, row_span, standing_height

_log = logging.getLogger(__name__)
_HEADINGS = 12
_COMPLETE_FITS = 4
_EXTENT_PASSES = 2


@dataclass(frozen=True)
class PoseRequest:
    """What is known of the initial pose.

    Attributes:
        kind: "A", "T" or "elbows".
        height_m: the performer's height; None to measure it.
        floor: height of the floor in the world, metres.
        own_shape: whether the body takes the performer's shape, or keeps its proportions.
    """

    kind: str
    height_m: float | None = None
    floor: float = 0.0
    own_shape: bool = False


@dataclass(frozen=True, eq=False)
class FirstFit:
    """The start of a track.

    Attributes:
        body: the template at the performer's scale.
        pose: (D,) the fitted initial pose.
        iou: (V,) intersection over union in each view.
        notes: what a user should know, sentences.
    """

    body: Body
    pose: np.ndarray
    iou: np.ndarray
    notes: tuple[str, ...]


def initialised(
    template: Body,
    cameras: tuple[Camera, ...],
    frames: tuple[tuple[Silhouette, ...], ...],
    request: PoseRequest,
    make_evaluator: EvaluatorFactory,
) -> FirstFit:
    """The body and its pose in the first of ``frames``, which all show the initial pose.

    Raises:
        MocapError: an unknown kind, or silhouettes that show no performer.
    """
    centres = np.array([body_centre(cameras, silhouettes) for silhouettes in frames])
    height = request.height_m or float(
        np.median(
            [
                standing_height(cameras, silhouettes, centre, request.floor)
                for silhouettes, centre in zip(frames, centres, strict=True)
            ]
        )
    )
    body = scaled(template, round(height / rest_height(template), 6))
    _log.info("performer %.3f m tall, around %s m", height, centres[0].round(3).tolist())
    pose = placed(pose_of_kind(body, request.kind), body, centres[0], request.floor)
    tracker = HierarchicalTracker(body, cameras, make_evaluator)
    pose, doubt = _best_heading(tracker, frames[0], pose)
    if request.height_m is None:
        tracker, pose = _matched_extent(tracker, frames, pose, make_evaluator)
    body = tracker.body
    if request.own_shape:
        known = request.height_m
        body, pose, told = in_own_shape(body, cameras, frames, pose, make_evaluator, known)
        doubt = f"{doubt}; {told}"
    scores = frame_scores(make_evaluator(body, cameras), pose, frames[0])
    _log.info("first pose: IoU by camera %s", scores.iou.round(3).tolist())
    notes = (f"The performer is {rest_height(body):.2f} m tall; {doubt}.",)
    return FirstFit(body, pose, scores.iou, notes)


def placed(pose: np.ndarray, body: Body, centre: np.ndarray, floor: float) -> np.ndarray:
    """``pose`` moved over ``centre`` (3,), the feet on the floor."""
    moved = pose.copy()
    translations = np.flatnonzero(body.dofs.kinds == DofKind.TRANSLATION)[:3]
    moved[translations] = [centre[0], centre[1], floor]
    return moved


def _turned(pose: np.ndarray, body: Body, heading: float) -> np.ndarray:
    """``pose`` turned about the vertical by ``heading`` rad."""
    turned = pose.copy()
    turned[_yaw_dof(body)] += heading
    return turned


def _yaw_dof(body: Body) -> int:
    about_z = (body.dofs.kinds == DofKind.HINGE) & (body.dofs.axes[:, 2] > 0.99)
    return int(np.flatnonzero(about_z & (body.dofs.joints == 0))[0])


def _best_heading(
    tracker: HierarchicalTracker, silhouettes: tuple[Silhouette, ...], pose: np.ndarray
) -> tuple[np.ndarray, str]:
    """The best complete fit over four headings, and how clearly it won, in words."""
    body = tracker.body
    quick = tracker.with_settings(replace(FAITHFUL, rounds=1))
    ring = (_turned(pose, body, k * 2 * np.pi / _HEADINGS) for k in range(_HEADINGS))
    rough = sorted((quick.fit(silhouettes, Past.still(start)) for start in ring), key=_energy)
    starts = [fit.pose for fit in rough[:_COMPLETE_FITS]]
    fits = sorted((tracker.fit(silhouettes, Past.still(start)) for start in starts), key=_energy)
    yaw = _yaw_dof(body)
    for kind, found in (("rough", rough), ("complete", fits)):
        shown = (f"{round(np.degrees(fit.pose[yaw])) % 360}°: {fit.energy}" for fit in found)
        _log.info("%s fits, energy by heading: %s", kind, ", ".join(shown))
    best = fits[0]
    others = [fit for fit in fits if np.cos(fit.pose[yaw] - best.pose[yaw]) < np.cos(np.pi / 4)]
    if not others:
        return best.pose, "no other heading came near"
    margin = others[0].energy / max(best.energy, 1.0) - 1.0
    return best.pose, f"the next best heading is {margin:.0%} worse"


def _energy(fit: PoseFit) -> int:
    return fit.energy


def _matched_extent(
    tracker: HierarchicalTracker,
    frames: tuple[tuple[Silhouette, ...], ...],
    pose: np.ndarray,
    make_evaluator: EvaluatorFactory,
) -> tuple[HierarchicalTracker, np.ndarray]:
    """The tracker of a body rescaled until it is as tall in the pictures as the performer."""
    for _ in range(_EXTENT_PASSES):
        ratio = _extent_ratio(tracker, frames, pose)
        body = scaled(tracker.body, ratio)
        tracker = HierarchicalTracker(body, tracker.cameras, make_evaluator, tracker.settings)
        pose = tracker.fit(frames[0], Past.still(pose)).pose
    return tracker, pose


def _extent_ratio(
    tracker: HierarchicalTracker, frames: tuple[tuple[Silhouette, ...], ...], pose: np.ndarray
) -> float:
    """Median ratio of the observed silhouettes' height in the pictures to the rendered ones'."""
    everything = [np.ones((c.size[1], c.size[0]), bool) for c in tracker.cameras]
    rendered = [
        row_span(Silhouette(picture, observed))
        for picture, observed in zip(tracker.evaluator.silhouettes(pose), everything, strict=True)
    ]
    ratios = []
    for silhouettes in frames:
        for camera, model, silhouette in zip(tracker.cameras, rendered, silhouettes, strict=True):
            seen = row_span(silhouette)
            if seen is None or model is None:
                continue
            if seen[0] > 0 and seen[1] < camera.size[1] - 1:
                ratios.append((seen[1] - seen[0] + 1) / (model[1] - model[0] + 1))
    return float(np.median(ratios)) if ratios else 1.0
