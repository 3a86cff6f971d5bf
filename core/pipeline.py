"""From a take to a motion and its files: the whole story on one screen."""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

from .body.body import Body
from .body.file import read_body
from .body.kinematics import rest_height
from .body.templates import template
from .cameras.camera import Camera
from .energy.evaluator import Evaluator
from .errors import MocapError
from .files import made_folder
from .fitting.hierarchical import SETTINGS, HierarchicalTracker
from .fitting.tracking import FrameFit, track
from .initialisation.first_pose import FirstFit, PoseRequest, initialised
from .initialisation.plausibility import check_first_fit
from .motion.overlay import OverlayVideo, Tile, overlay_picture
from .progress import FrameFigures, Progress
from .rendering.native import NativeEvaluator
from .rendering.reference import ReferenceEvaluator
from .silhouettes.silhouette import Silhouette
from .take.results import OVERLAY, FitResult, Outcome, write_results
from .take.take import Search, Take
from .take.views import Views, open_views

_MOST_INITIAL_FRAMES = 8
Silhouettes = tuple[Silhouette, ...]
"""One frame's, camera by camera."""


def native(body: Body, cameras: tuple[Camera, ...]) -> Evaluator:
    """The native kernel on all processors."""
    return NativeEvaluator(body, cameras, threads=os.cpu_count() or 1)


EVALUATORS: dict[str, Callable[[Body, tuple[Camera, ...]], Evaluator]] = {
    "native": native,
    "reference": ReferenceEvaluator,
}


@dataclass(frozen=True)
class FitRequest:
    """What to fit, and where to write it.

    Attributes:
        out: the folder of the result; made where it is missing.
        search: how to track.
        evaluator: one of `EVALUATORS`.
        frames: first and last frame, inclusive, that narrow the take's; None leaves an end.
        without: names of cameras to leave out.
        shield: entered while the finished frames are written, so that nothing interrupts it.
    """

    out: Path
    search: Search = field(default_factory=Search)
    evaluator: str = "native"
    frames: tuple[int | None, int | None] = (None, None)
    without: tuple[str, ...] = ()
    shield: Callable[[], AbstractContextManager] = nullcontext


def fit(take: Take, request: FitRequest, progress: Progress) -> FitResult:
    """Tracks ``take`` and writes motion.npz, body.npz, report.json and overlay.mp4.

    When it is interrupted or fails, the frames finished so far are written first.

    Raises:
        MocapError: the take, its calibration or its footage is at fault.
    """
    views = open_views(take, request.without, request.frames)
    made_folder(request.out)
    start = initial_frames(take, views.frames)
    views = views.reduced(start)
    for note in views.notes:
        progress.note(note)
    progress.begin("first pose", 1)
    first = _first_fit(take, views, start, request)
    for note in first.notes:
        progress.note(note)
    make_evaluator = EVALUATORS[request.evaluator]
    setting = SETTINGS[request.search.setting][request.search.fast_motion]
    tracker = HierarchicalTracker(first.body, views.cameras, make_evaluator, setting)
    fits: list[FrameFit] = []

    def save() -> FitResult:
        settings = {
            **asdict(request.search),
            "evaluator": request.evaluator,
            "without": list(request.without),
        }
        notes = (*views.notes, *first.notes)
        with request.shield():
            outcome = Outcome(take, views, first.body, fits, settings, notes)
            return write_results(outcome, request.out, progress)

    progress.begin("fit", views.frames[1] - views.frames[0] + 1)
    with OverlayVideo(request.out / OVERLAY, float(take.fps)) as overlay:
        try:
            for found, seen in _tracked(tracker, first.pose, views, start[0]):
                fits.append(found)
                overlay.add(found.frame, _overlay(tracker.evaluator, views, found, seen))
                progress.advance(found.frame, _figures(found, views))
            result = save()
        except BaseException:
            if fits:
                save()
            raise
        overlay.write()
    return FitResult(result.motion, result.report, (*result.files, overlay.path))


def initial_frames(take: Take, frames: tuple[int, int]) -> tuple[int, ...]:
    """Up to eight of the take's ``frames`` (first, last) that show the initial pose, in order.

    Raises:
        MocapError: none of them does.
    """
    first, last = take.initial_pose.frames or (frames[0], frames[0])
    begin, end = max(first, frames[0]), min(last, frames[1])
    if begin > end:
        raise MocapError(
            f"the initial pose is in frames {first} to {last}, outside {frames[0]} to {frames[1]}",
            "fit frames that hold it", file=take.path,
        )  # fmt: skip
    count = min(end - begin + 1, _MOST_INITIAL_FRAMES)
    return tuple(int(f) for f in np.linspace(begin, end, count).round())


def _first_fit(take: Take, views: Views, start: Sequence[int], request: FitRequest) -> FirstFit:
    body, height = take.performer.body, take.performer.height_m
    if isinstance(body, Path):
        body = read_body(body)
        height = height or rest_height(body)
    else:
        body = template(body)
    first = initialised(
        body,
        views.cameras,
        tuple(views.silhouettes(frame) for frame in start),
        PoseRequest(take.initial_pose.kind, height, take.floor),
        EVALUATORS[request.evaluator],
    )
    return replace(first, notes=(*first.notes, *check_first_fit(first, views.cameras)))


def _tracked(
    tracker: HierarchicalTracker, pose: np.ndarray, views: Views, start: int
) -> Iterator[tuple[FrameFit, Silhouettes]]:
    """Fits of ``start`` and what follows, then of what comes before it, backwards."""
    first, last = views.frames
    for frames in (range(start, last + 1), range(start - 1, first - 1, -1)):
        seen: dict[int, Silhouettes] = {}

        def read(frames=frames, seen=seen) -> Iterator[tuple[int, Silhouettes]]:
            for frame in frames:
                seen[frame] = views.silhouettes(frame)
                yield frame, seen[frame]

        for found in track(tracker, pose, read()):
            yield found, seen.pop(found.frame)


def _figures(found: FrameFit, views: Views) -> FrameFigures:
    names = [camera.name for camera in views.cameras]
    scores = found.scores
    return FrameFigures(
        seconds=found.seconds,
        evaluations=found.tally.evaluated,
        iou=dict(zip(names, scores.iou.tolist(), strict=True)),
        xor_px=dict(zip(names, scores.xor_px.tolist(), strict=True)),
        lost=scores.lost,
    )


def _overlay(evaluator: Evaluator, views: Views, found: FrameFit, seen: Silhouettes) -> np.ndarray:
    rendered = evaluator.silhouettes(found.pose)
    tiles = [
        Tile(f"{view.camera.name}  IoU {iou:.2f}", view.picture(found.frame), silhouette, drawn)
        for view, iou, silhouette, drawn in zip(
            views.views, found.scores.iou, seen, rendered, strict=True
        )
    ]
    return overlay_picture(tiles, f"frame {found.frame}")
