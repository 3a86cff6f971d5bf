"""From a take to a motion and its files: the whole story on one screen."""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .body.body import Body
from .body.file import read_body, write_body
from .body.templates import template
from .cameras.arrangement import millimetres_per_pixel
from .cameras.camera import Camera
from .energy.evaluator import Evaluator
from .errors import MocapError
from .fitting.hierarchical import HierarchicalTracker
from .fitting.tracking import FrameFit, track
from .initialisation.first_pose import FirstFit, PoseRequest, initialised
from .motion.export_request import Exporter, ExportRequest
from .motion.formats.trc import write_trc
from .motion.motion import Motion, read_motion, write_motion
from .motion.overlay import OverlayVideo, Tile, overlay_picture
from .motion.point_track import PointTrack, read_point_track
from .motion.recording import recorded
from .motion.report import fit_quality, versions, write_report
from .motion.scoring import score
from .progress import Progress
from .rendering.native import NativeEvaluator
from .rendering.reference import ReferenceEvaluator
from .silhouettes.silhouette import Silhouette
from .take.shown_footage import shown_footage
from .take.take import Take
from .take.views import Views, open_views

MOTION, BODY, REPORT, OVERLAY = "motion.npz", "body.npz", "report.json", "overlay.mp4"
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
        tracker: one of `take.take.TRACKERS`.
        evaluator: one of `EVALUATORS`.
        frames: first and last frame, inclusive, that narrow the take's; None leaves an end.
        without: names of cameras to leave out.
        shield: entered while the finished frames are written, so that nothing interrupts it.
    """

    out: Path
    tracker: str = "hierarchical"
    evaluator: str = "native"
    frames: tuple[int | None, int | None] = (None, None)
    without: tuple[str, ...] = ()
    shield: Callable[[], AbstractContextManager] = nullcontext


@dataclass(frozen=True, eq=False)
class FitResult:
    """What was fitted.

    Attributes:
        motion: the tracked frames.
        report: as written to report.json.
        files: everything written, in order.
    """

    motion: Motion
    report: dict = field(repr=False)
    files: tuple[Path, ...]


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
    first = _first_fit(take, views, start, request)
    for note in first.notes:
        progress.note(note)
    tracker = HierarchicalTracker(first.body, views.cameras, EVALUATORS[request.evaluator])
    fits: list[FrameFit] = []

    def save() -> FitResult:
        with request.shield():
            return _written(take, request, views, first, fits)

    progress.begin("fit", views.frames[1] - views.frames[0] + 1)
    with OverlayVideo(request.out / OVERLAY, float(take.fps)) as overlay:
        try:
            for found, seen in _tracked(tracker, first.pose, views, start[0]):
                fits.append(found)
                overlay.add(found.frame, _overlay(tracker.evaluator, views, found, seen))
                progress.advance(found.frame, found.seconds, float(np.nanmean(found.scores.iou)))
        except BaseException:
            if fits:
                progress.note(f"the {len(fits)} finished frames are kept in {save().files[0]}")
            raise
        result = save()
        overlay.write()
    return FitResult(result.motion, result.report, (*result.files, overlay.path))


def check_formats(formats: Sequence[str], exporter: Exporter | None) -> None:
    """Refuses formats that nobody here can write.

    Raises:
        MocapError: Blender is needed and missing.
    """
    needing = [name for name in formats if name != "trc"]
    if needing and exporter is None:
        raise MocapError(
            f"{', '.join(needing)} can be written only with Blender",
            "pip install silhouette-mocap[blender], or ask for other formats with --export",
        )


def export(
    take: Take, folder: Path, formats: Sequence[str], exporter: Exporter | None
) -> tuple[Path, ...]:
    """Writes the fit in ``folder`` in further formats, named after the take.

    Raises:
        MocapError: no fit in the folder, Blender is needed and missing, or a file cannot be
            written.
    """
    check_formats(formats, exporter)
    if not formats:
        return ()
    motion = read_motion(folder / MOTION)
    if exporter is None:
        path = folder / f"{take.name}.trc"
        write_trc(path, motion)
        return (path,)
    views = open_views(take)
    names = set(motion.camera_names)
    shown = [view for view in views.views if view.undistortion.camera.name in names]
    footage = {}
    if "blend" in formats:
        footage = shown_footage(shown, int(motion.frames[-1]), float(take.fps), folder)
    request = ExportRequest(
        body=read_body(folder / BODY),
        motion=motion,
        cameras=tuple(view.undistortion.camera for view in shown),
        name=take.name,
        formats=tuple(formats),
        folder=folder,
        footage=footage,
    )
    return exporter(request)


def made_folder(path: Path) -> Path:
    """``path``, made where it is missing.

    Raises:
        MocapError: it cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MocapError(
            f"cannot be made ({error.strerror})", "give another folder", file=path
        ) from error
    return path


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
    body = take.performer.body
    body = read_body(body) if isinstance(body, Path) else template(body)
    return initialised(
        body,
        views.cameras,
        tuple(views.silhouettes(frame) for frame in start),
        PoseRequest(take.initial_pose.kind, take.performer.height_m, take.floor),
        EVALUATORS[request.evaluator],
    )


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


def _written(
    take: Take, request: FitRequest, views: Views, first: FirstFit, fits: list[FrameFit]
) -> FitResult:
    motion = recorded(fits, first.body, [camera.name for camera in views.cameras], take.fps)
    report = {
        "take": take.name,
        "settings": {
            "take": str(take.path),
            "tracker": request.tracker,
            "evaluator": request.evaluator,
            "body": str(take.performer.body),
            "frames": list(views.frames),
            "without": list(request.without),
        },
        "versions": versions(),
        "notes": [*views.notes, *first.notes],
        "cameras": _camera_facts(views, motion),
        **fit_quality(motion, fits),
        "error_mm": _error(take, motion),
    }
    files = tuple(request.out / name for name in (MOTION, BODY, REPORT))
    write_motion(files[0], motion)
    write_body(files[1], first.body)
    write_report(files[2], report)
    return FitResult(motion, report, files)


def _camera_facts(views: Views, motion: Motion) -> dict[str, dict]:
    """Sizes and scale: all scores hold at the working size."""
    centre = motion.points.mean(axis=(0, 1))
    return {
        view.camera.name: {
            "footage_size": list(view.source.footage.size),
            "working_size": list(view.camera.size),
            "reduced_by": view.reduction.factor,
            "mm_per_px": millimetres_per_pixel(view.camera, centre),
        }
        for view in views.views
    }


def _error(take: Take, motion: Motion) -> dict | None:
    """The error against the truth beside the take, where there is one for these frames."""
    path = take.path.parent / "truth.npz"
    if not path.exists():
        return None
    truth = read_point_track(path).between(int(motion.frames[0]), int(motion.frames[-1]))
    if not len(truth.frames):
        return None
    found = PointTrack(motion.point_names, motion.frames, motion.points)
    return score(truth, found).as_dict()


def _overlay(evaluator: Evaluator, views: Views, found: FrameFit, seen: Silhouettes) -> np.ndarray:
    rendered = evaluator.silhouettes(found.pose)
    tiles = [
        Tile(f"{view.camera.name}  IoU {iou:.2f}", view.picture(found.frame), silhouette, drawn)
        for view, iou, silhouette, drawn in zip(
            views.views, found.scores.iou, seen, rendered, strict=True
        )
    ]
    return overlay_picture(tiles, f"frame {found.frame}")
