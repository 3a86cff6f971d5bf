"""How long a fit will take here, and what memory and disk it will need.

One round of the real search is run on the first frame, at the working size. Its time and the others
measured (reading, overlay pictures) are taken times what a whole fit needs of each, known from fits
of takes with four to eight cameras of 320 x 240 to 1152 x 1440 px.
"""

import time
from dataclasses import dataclass, replace

import cv2
import numpy as np

from ..body.body import Body
from ..body.kinematics import rest_height
from ..body.scaling import scaled
from ..cameras.camera import Camera
from ..fitting.contour import ContourTracker
from ..fitting.hierarchical import SETTINGS, HierarchicalTracker
from ..fitting.scores import frame_scores
from ..fitting.search import Search
from ..fitting.tracker import EvaluatorFactory, Past, Tracker
from ..initialisation.hunt import stood
from ..initialisation.pose_kinds import STANDING, pose_of_kind, stance
from ..motion.overlay import JPEG_QUALITY, Tile, overlay_picture
from ..rendering.choice import MakeEvaluator
from ..rendering.detail import with_level_for
from ..silhouettes.silhouette import Silhouette
from ..take.take import Take
from ..take.views import Views
from .camera_facts import Performer

_ROUNDS_PER_FRAME = 1.8
_FITS_OF_FIRST_POSE, _FITS_OF_SHAPE = 20.0, 50.0
_NUDGE_M = 0.01
_PROGRAM_BYTES = 150e6
_BYTES_PER_FOOTAGE_PX, _BYTES_PER_WORKING_PX = 38.0, 20.0
_VIDEO_SHARE = 0.4
_MOTION_BYTES, _MOTION_BYTES_PER_DOF = 4e3, 32.0
_BODY_BYTES = 240e3
_REPORT_BYTES, _REPORT_BYTES_PER_FRAME = 7.5e3, 50.0
_PAGE_BYTES, _PAGE_PICTURES = 30e3, 6
# bytes: for the body, and for each DOF of a frame
_EXPORT_BYTES = {"blend": (600e3, 40.0), "fbx": (600e3, 30.0), "bvh": (5e3, 14.0), "trc": (0, 10.0)}


@dataclass(frozen=True)
class Estimate:
    """What a fit will need, roughly.

    Attributes:
        frames: how many will be tracked.
        first_pose_s: time to find the initial pose and the performer's shape.
        reading_s: time per frame to read the footage and make silhouettes.
        fitting_s: time per frame to search the pose.
        picture_s: time per frame for overlay picture and video.
        memory_bytes: of the whole program.
        meanwhile_bytes: on disk until the fit is finished.
        results_bytes: on disk afterwards, by file.
    """

    frames: int
    first_pose_s: float
    reading_s: float
    fitting_s: float
    picture_s: float
    memory_bytes: float
    meanwhile_bytes: float
    results_bytes: dict[str, float]

    @property
    def frame_s(self) -> float:
        """Time per frame."""
        return self.reading_s + self.fitting_s + self.picture_s

    @property
    def total_s(self) -> float:
        """Time of the whole fit."""
        return self.first_pose_s + self.frames * self.frame_s


@dataclass(frozen=True, eq=False)
class Trial:
    """What is tried.

    Attributes:
        take: the take.
        views: at the working size.
        frame: a frame of the initial pose.
        silhouettes: what the V cameras see in it.
        performer: where the performer stands in it.
        make_evaluator: renders and compares.
        body: the performer's, unscaled.
    """

    take: Take
    views: Views
    frame: int
    silhouettes: tuple[Silhouette, ...]
    performer: Performer
    make_evaluator: MakeEvaluator
    body: Body


def estimated(trial: Trial, reading_s: float) -> Estimate:
    """The estimate, after some real work on one frame.

    Args:
        trial: what to try.
        reading_s: measured time per frame to read the footage.

    Raises:
        MocapError: the body or a picture cannot be read.
    """
    body = _standing_body(trial)
    kind = trial.take.initial_pose.kind
    pose = stance(body, "A", STANDING) if kind is None else pose_of_kind(body, kind)
    pose = stood(body, pose[None], trial.performer.centre, trial.take.floor)[0]
    make_evaluator = with_level_for(pose, trial.make_evaluator)
    search, cameras = trial.take.search, trial.views.cameras
    tracker = ContourTracker(body, cameras, make_evaluator)
    # from a pose as near as that of the frame before is
    near = tracker.fit(trial.silhouettes, Past.still(pose)).pose
    frame_s, scores_s = _timed_fit(tracker, trial.silhouettes, near)
    own_shape = isinstance(trial.take.performer.body, str)
    first_s = frame_s * (_FITS_OF_FIRST_POSE + own_shape * _FITS_OF_SHAPE)
    if search.tracker == "hierarchical":
        one_round = _one_round(search, body, cameras, make_evaluator)
        frame_s = _ROUNDS_PER_FRAME * _timed_fit(one_round, trial.silhouettes, pose)[0]
    picture_s, picture_bytes = _timed_picture(tracker, trial, pose)
    first, last = trial.views.frames
    frames, dofs = last - first + 1, len(body.dofs)
    motion = _MOTION_BYTES + frames * dofs * _MOTION_BYTES_PER_DOF
    exported = {
        f".{name}": base + frames * dofs * per_dof
        for name, (base, per_dof) in _EXPORT_BYTES.items()
        if name in trial.take.exports
    }
    video = frames * picture_bytes * _VIDEO_SHARE
    return Estimate(
        frames=frames,
        first_pose_s=first_s,
        reading_s=reading_s,
        fitting_s=frame_s + scores_s,
        picture_s=picture_s,
        memory_bytes=_PROGRAM_BYTES + _picture_memory(trial.views) + 3 * motion,
        meanwhile_bytes=frames * picture_bytes + motion,
        results_bytes={
            "motion.npz": motion,
            "body.npz": _BODY_BYTES,
            "report.json": _REPORT_BYTES + frames * _REPORT_BYTES_PER_FRAME,
            "report.html": _PAGE_BYTES + min(frames, _PAGE_PICTURES) * picture_bytes,
            "overlay.mp4": video,
            **exported,
        },
    )


def _one_round(
    search: Search, body: Body, cameras: tuple[Camera, ...], make_evaluator: EvaluatorFactory
) -> HierarchicalTracker:
    """The tracker ``hierarchical`` for one round of its search."""
    setting = replace(SETTINGS[search.setting][search.fast_motion], rounds=1)
    return HierarchicalTracker(body, cameras, make_evaluator, setting)


def _standing_body(trial: Trial) -> Body:
    if isinstance(trial.take.performer.body, str):
        return scaled(trial.body, trial.performer.height_m / rest_height(trial.body))
    return trial.body


def _timed_fit(
    tracker: Tracker, silhouettes: tuple[Silhouette, ...], pose: np.ndarray
) -> tuple[float, float]:
    """Seconds of a search, and of scoring its result."""
    # in a motion the prediction differs from the last pose, and is searched around, too
    predicted = pose.copy()
    predicted[0] += _NUDGE_M
    begun = time.perf_counter()
    found = tracker.fit(silhouettes, replace(Past.still(pose), predicted=predicted)).pose
    searched = time.perf_counter()
    frame_scores(tracker.evaluator, found, silhouettes)
    return searched - begun, time.perf_counter() - searched


def _timed_picture(tracker: Tracker, trial: Trial, pose: np.ndarray) -> tuple[float, float]:
    """Seconds to make and keep one overlay picture and its part of the video, and its bytes."""
    begun = time.perf_counter()
    rendered = tracker.evaluator.silhouettes(pose)
    tiles = [
        Tile(view.camera.name, view.picture(trial.frame), seen, drawn)
        for view, seen, drawn in zip(trial.views.views, trial.silhouettes, rendered, strict=True)
    ]
    picture = overlay_picture(tiles, "frame")
    made = time.perf_counter()
    coded = cv2.imencode(".jpg", picture, JPEG_QUALITY)[1]
    coding = time.perf_counter() - made
    # decoding for the video costs as much as coding, and coding it anew twice as much
    return made - begun + 4 * coding, float(coded.size)


def _picture_memory(views: Views) -> float:
    """Bytes that the pictures and maps of a frame take."""
    footage = sum(np.prod(view.source.footage.size, dtype=float) for view in views.views)
    working = sum(np.prod(camera.size, dtype=float) for camera in views.cameras)
    return float(_BYTES_PER_FOOTAGE_PX * footage + _BYTES_PER_WORKING_PX * working)
