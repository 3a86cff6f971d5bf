"""Position, heading, scale, pose and shape of the performer in the initial pose.

The performer stands in a known pose (SPEC §5, `initial_pose`). Position comes from the rays through
the silhouettes' centroids, the uniform scale from the silhouettes' extent or the given height, the
heading from the XOR energy: the known pose is laid all round, drawn to the contours from the best
headings, and fitted completely from the best end and from its opposite (`facing`), since a
silhouette looks much the same from in front and from behind.
"""

import logging
from dataclasses import dataclass, replace

import numpy as np

from ..body.body import Body
from ..body.kinematics import rest_height
from ..body.scaling import scaled
from ..cameras.camera import Camera
from ..fitting.contour import ContourTracker
from ..fitting.scores import FrameScores, frame_scores
from ..fitting.tracker import EvaluatorFactory, Past
from ..fitting.turns import heading_dof
from ..silhouettes.silhouette import Silhouette
from .doubts import doubts_about
from .facing import CLEARLY, Way, faced
from .hunt import Hunt, all_round, stood
from .own_shape import in_own_shape
from .pose_kinds import POSE_KINDS, STANDING, kinds_to_try, nearest_kind, pose_of_kind, stance
from .shape_fit import ShapeFit
from .sightings import is_whole
from .standing import body_centre, row_span, standing_height

_log = logging.getLogger(__name__)
_DESCENTS = 4
_EXTENT_PASSES = 2
Silhouettes = tuple[Silhouette, ...]


def _unknown() -> None:
    return None


@dataclass(frozen=True)
class PoseRequest:
    """What is known of the initial pose.

    Attributes:
        kind: "A", "T", "elbows" or "rest"; None where nothing is known, see `unaided`.
        height_m: the performer's height; None to measure it.
        floor: height of the floor in the world, metres.
        own_shape: whether the body takes the performer's shape, or keeps its proportions.
        way: tells where the performer goes; asked only where the silhouettes leave it open which
            way the performer faces.
    """

    kind: str | None
    height_m: float | None = None
    floor: float = 0.0
    own_shape: bool = False
    way: Way = _unknown


@dataclass(frozen=True, eq=False)
class FirstFit:
    """The start of a track.

    Attributes:
        body: the template at the performer's scale.
        pose: (D,) the fitted initial pose.
        iou: (V,) intersection over union in each view.
        notes: what a user should know, sentences.
        shape: how the performer's shape was found; None where it was not sought.
        doubts: what a user must know, likewise.
    """

    body: Body
    pose: np.ndarray
    iou: np.ndarray
    notes: tuple[str, ...]
    shape: ShapeFit | None = None
    doubts: tuple[str, ...] = ()

    def with_words(self, words: str, doubtful: bool) -> "FirstFit":
        """The same with one more sentence, before the others of its sort."""
        if doubtful:
            return replace(self, doubts=(words, *self.doubts))
        return replace(self, notes=(words, *self.notes))


def initialised(
    template: Body,
    cameras: tuple[Camera, ...],
    frames: tuple[Silhouettes, ...],
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
    body = of_height(template, height)
    _log.info("performer %.3f m tall, around %s m", height, centres[0].round(3).tolist())
    assert request.kind is not None
    kinds = kinds_to_try(request.kind)
    named = pose_of_kind(template, request.kind)
    others = [stance(template, kind, STANDING) for kind in kinds[1:]]
    starts = all_round(body, np.stack([named, *others]))
    hunt = Hunt(ContourTracker(body, cameras, make_evaluator), frames[0])
    ends = hunt.ends(stood(body, starts, centres[0], request.floor), _DESCENTS)
    yaw = heading_dof(body)
    headings = (f"{round(np.degrees(end.pose[yaw])) % 360}°: {end.energy:.0f}" for end in ends)
    _log.info("first descents, energy by heading: %s", ", ".join(headings))
    first, _ = settled(hunt, ends[0].pose, frames, request, make_evaluator)
    first = measured(first, cameras, frames, request, make_evaluator)
    shown = nearest_kind(first.body, first.pose, kinds) if others else request.kind
    if shown == request.kind or shown not in POSE_KINDS:
        return first
    doubt = f'the arms look more like "{shown}" than like the named kind, "{request.kind}"'
    return replace(first, doubts=(f"{doubt}: check initial_pose", *first.doubts))


def of_height(template: Body, height: float) -> Body:
    """The template scaled to a standing height, m."""
    return scaled(template, round(height / rest_height(template), 6))


def settled(
    hunt: Hunt,
    pose: np.ndarray,
    frames: tuple[Silhouettes, ...],
    request: PoseRequest,
    make_evaluator: EvaluatorFactory,
) -> tuple[FirstFit, FrameScores]:
    """The body at its size, and its pose in the first of ``frames``, from a pose (D,) near by.

    With it come the scores of that frame. ``frames`` all show that pose, the ``hunt`` is for the
    first of them.
    """
    fit = hunt.complete(pose)
    if request.height_m is None:
        tracker, pose = _matched_extent(hunt.tracker, frames, fit.pose, make_evaluator)
        hunt = Hunt(tracker, frames[0])
        fit = hunt.complete(pose)
    facing = faced(hunt, fit, request.way)
    pose = facing.fit.pose
    scores = hunt.scores(pose)
    first = FirstFit(hunt.body, pose, scores.iou, ())
    return first.with_words(facing.words, facing.margin < CLEARLY), scores


def measured(
    first: FirstFit,
    cameras: tuple[Camera, ...],
    frames: tuple[Silhouettes, ...],
    request: PoseRequest,
    make_evaluator: EvaluatorFactory,
) -> FirstFit:
    """The first fit in the performer's own shape, if that is wanted; its notes tell all about it.

    ``frames`` all show its pose.
    """
    told = ""
    if request.own_shape:
        poses = np.tile(first.pose, (len(frames), 1))
        start = (first.body, cameras, frames, poses, make_evaluator, request.height_m)
        own = in_own_shape(*start)
        first = replace(first, body=own.body, pose=own.pose, shape=own.fit)
        told = f"; {own.note}"
    scores = frame_scores(make_evaluator(first.body, cameras), first.pose, frames[0])
    first = replace(first, iou=scores.iou)
    _log.info("first pose: IoU by camera %s", first.iou.round(3).tolist())
    note = f"The performer is {rest_height(first.body):.2f} m tall{told}."
    first = replace(first, doubts=(*first.doubts, *doubts_about(scores, frames[0])))
    return first.with_words(note, doubtful=False)


def _matched_extent(
    tracker: ContourTracker,
    frames: tuple[Silhouettes, ...],
    pose: np.ndarray,
    make_evaluator: EvaluatorFactory,
) -> tuple[ContourTracker, np.ndarray]:
    """The tracker of a body rescaled until it is as tall in the pictures as the performer."""
    for _ in range(_EXTENT_PASSES):
        cameras = tracker.evaluator.cameras
        ratio = _extent_ratio(tracker, frames, pose)
        body = scaled(tracker.evaluator.body, ratio)
        tracker = ContourTracker(body, cameras, make_evaluator, tracker.settings)
        pose = tracker.fit(frames[0], Past.still(pose)).pose
    return tracker, pose


def _extent_ratio(
    tracker: ContourTracker, frames: tuple[Silhouettes, ...], pose: np.ndarray
) -> float:
    """Median ratio of the observed silhouettes' height in the pictures to the rendered ones'."""
    cameras = tracker.evaluator.cameras
    everything = [np.ones((c.size[1], c.size[0]), bool) for c in cameras]
    rendered = [
        row_span(Silhouette(picture, observed))
        for picture, observed in zip(tracker.evaluator.silhouettes(pose), everything, strict=True)
    ]
    ratios = []
    for silhouettes in frames:
        for model, silhouette in zip(rendered, silhouettes, strict=True):
            seen = row_span(silhouette)
            if seen is not None and model is not None and is_whole(silhouette):
                ratios.append((seen[1] - seen[0] + 1) / (model[1] - model[0] + 1))
    return float(np.median(ratios)) if ratios else 1.0
