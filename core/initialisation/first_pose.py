"""Position, heading, scale and pose of the performer in the initial pose.

The performer stands in a known pose (SPEC §5, `initial_pose`). Position comes from the rays through
the silhouettes' centroids, the uniform scale from the silhouettes' extent or the given height, the
heading from the XOR energy: the best of a ring of headings and the three a quarter turn away from
it are fitted completely, since a silhouette looks much the same from in front and from behind, and
the best fit wins.
"""

from dataclasses import dataclass

import numpy as np

from ..body.body import Body, DofKind
from ..body.kinematics import rest_height
from ..body.scaling import scaled
from ..cameras.camera import Camera
from ..energy.weight_maps import xor_weight_maps
from ..fitting.hierarchical import EvaluatorFactory, HierarchicalTracker
from ..fitting.scores import frame_scores
from ..silhouettes.silhouette import Silhouette
from .pose_kinds import pose_of_kind
from .standing import body_centre, row_span, standing_height

_HEADINGS = 24
_EXTENT_PASSES = 2


@dataclass(frozen=True)
class PoseRequest:
    """What is known of the initial pose.

    Attributes:
        kind: "A", "T" or "elbows".
        height_m: the performer's height; None to measure it.
        floor: height of the floor in the world, metres.
    """

    kind: str
    height_m: float | None = None
    floor: float = 0.0


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
    pose = _placed(pose_of_kind(body, request.kind), body, centres[0], request.floor)
    tracker = HierarchicalTracker(body, cameras, make_evaluator)
    pose, doubt = _best_heading(tracker, frames[0], pose)
    if request.height_m is None:
        tracker, pose = _matched_extent(tracker, frames, pose, make_evaluator)
    scores = frame_scores(tracker.evaluator, pose, frames[0])
    height = rest_height(tracker.body)
    notes = (f"The performer is {height:.2f} m tall; {doubt}.",)
    return FirstFit(tracker.body, pose, scores.iou, notes)


def _placed(pose: np.ndarray, body: Body, centre: np.ndarray, floor: float) -> np.ndarray:
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
    ring = np.arange(_HEADINGS) * 2 * np.pi / _HEADINGS
    poses = np.stack([_turned(pose, body, heading) for heading in ring])
    weights = tracker.evaluator.prepared(xor_weight_maps(silhouettes))
    rough = tracker.evaluator.energies(weights, poses).sum(axis=1)
    nearest = ring[int(np.argmin(rough))]
    starts = [_turned(pose, body, nearest + quarter * np.pi / 2) for quarter in range(4)]
    fits = sorted(
        (tracker.fit(silhouettes, start, start) for start in starts), key=lambda fit: fit.energy
    )
    yaw = _yaw_dof(body)
    best = fits[0]
    others = [fit for fit in fits if np.cos(fit.pose[yaw] - best.pose[yaw]) < np.cos(np.pi / 4)]
    if not others:
        return best.pose, "all four headings led to the same one"
    margin = others[0].energy / max(best.energy, 1.0) - 1.0
    return best.pose, f"the next best heading is {margin:.0%} worse"


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
        pose = tracker.fit(frames[0], pose, pose).pose
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
