"""What a fit leaves in its folder: motion.npz, body.npz, report.json, report.html, overlay.mp4."""

import hashlib
import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

from ..body.file import write_body
from ..body.rig_file import RigFile
from ..cameras.arrangement import millimetres_per_pixel
from ..cameras.camera import Camera
from ..errors import MocapError
from ..fitting.camera_health import CameraFinding
from ..footage.pictures import read_picture
from ..footage.video_writing import write_video
from ..motion.motion import Motion, read_motion, write_motion
from ..motion.point_track import PointTrack, read_point_track
from ..motion.recording import recorded
from ..motion.scoring import score
from ..progress import Progress
from ..rendering.choice import Choice
from ..rendering.detail import drawn_surface
from ..take.take import EXPORTS, Take
from ..take.views import Views
from .fingerprint import Inputs, check_same, stamp_digests
from .journal import UNFINISHED, Journal, set_aside
from .report import fit_quality, versions, write_report
from .report_page import write_report_page
from .shown_footage import FOOTAGE

MOTION, BODY, REPORT, PAGE = "motion.npz", "body.npz", "report.json", "report.html"
OVERLAY = "overlay.mp4"


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


@dataclass(frozen=True, eq=False)
class Outcome:
    """A fit as far as it went.

    Attributes:
        take: what was fitted.
        views: its cameras, as they were used.
        journal: the tracked frames.
        settings: what was asked for beside the take.
        choice: what draws.
        complete: whether all frames were tracked, and looked at again where in doubt.
        findings: what is wrong with the cameras, as far as it is known.
    """

    take: Take
    views: Views
    journal: Journal
    settings: dict[str, object]
    choice: Choice
    complete: bool = False
    findings: tuple[CameraFinding, ...] = ()


def check_spared(take: Take, folder: Path) -> None:
    """Refuses a ``folder`` in which the result would replace what ``take`` is made of.

    Raises:
        MocapError: it would replace the performer's body, or footage.
    """
    body, files = take.performer.body, take.footage
    if isinstance(body, Path) and body == (folder / BODY).resolve():
        raise MocapError(
            "is the body that the take names, and the result would replace it",
            "give another folder", file=body,
        )  # fmt: skip
    if isinstance(body, RigFile) and body.path == (folder / f"{take.name}.blend").resolve():
        raise MocapError(
            "is the rig that the take names, and its export would replace it",
            "give another folder, or the take another name", file=body.path,
        )  # fmt: skip
    shown = (folder / FOOTAGE).resolve()
    for pattern in (files.silhouettes, files.video, files.plate, files.ignore):
        if pattern is not None and shown in (Path(pattern), *Path(pattern).parents):
            raise MocapError(
                "holds files of the take, which the result might replace",
                "give another folder", file=shown,
            )  # fmt: skip


def write_results(outcome: Outcome, folder: Path, progress: Progress) -> FitResult:
    """Writes all but the overlay, each whole or not at all; nothing that may fail comes first.

    An unfinished fit leaves an earlier one of more frames alone and writes motion.partial.npz and
    so on beside it.
    """
    take, views, start = outcome.take, outcome.views, outcome.journal.start
    notes = list(dict.fromkeys((*start.notes, *outcome.choice.notes)))

    def tell(note: str) -> None:
        notes.append(note)
        progress.note(note)

    names = [camera.name for camera in views.cameras]
    motion = recorded(outcome.journal, start.body, names, take.fps)
    files = _places(outcome, folder)
    write_motion(files[0], motion)
    write_body(files[1], start.body)
    _tell_files(outcome, files[0], tell)
    for finding in outcome.findings:
        tell(finding.text)
    report = {
        "take": take.name,
        "finished": outcome.complete,
        "settings": {
            "take": str(take.path),
            "body": str(take.performer.body),
            "frames": list(views.frames),
            **outcome.settings,
        },
        "evaluators": dict(outcome.journal.evaluators()),
        "versions": versions(),
        "cameras": _camera_facts(views, motion),
        "camera_findings": [asdict(finding) for finding in outcome.findings],
        "surface": drawn_surface(start.body, views.cameras, start.pose),
        **fit_quality(motion, outcome.journal),
        "error_mm": _error(take, motion, tell),
        "notes": notes,
        "digests": _digests(folder),
        "inputs": {**start.inputs, **stamp_digests(motion.camera_names, *outcome.journal.stamps())},
    }
    report = write_report(files[2], report)
    write_report_page(files[3], motion, report, outcome.journal.read_picture)
    return FitResult(motion, report, files)


def with_overlay(outcome: Outcome, result: FitResult, progress: Progress) -> FitResult:
    """Writes overlay.mp4 of a finished fit beside its ``result``."""
    journal = outcome.journal
    frames = result.motion.frames.tolist()
    path = result.files[0].with_name(OVERLAY)
    progress.begin("overlay", len(frames))

    def pictures() -> Iterator[np.ndarray]:
        for frame in frames:
            yield read_picture(journal.picture(frame))
            progress.advance(frame)

    try:
        write_video(path, pictures(), float(outcome.take.fps))
    except BaseException:
        progress.note(f"all frames are kept in {result.files[0]}; --resume writes {OVERLAY}")
        raise
    return FitResult(result.motion, result.report, (*result.files, path))


def resumed(folder: Path, inputs: Inputs, views: Views) -> Journal | None:
    """The unfinished fit in ``folder``, to be continued with ``inputs``; None where there is none.

    Raises:
        MocapError: it was begun with other inputs or footage, or is damaged.
    """
    journal = Journal.opened(folder / UNFINISHED)
    if journal is None:
        return None
    start = journal.start
    check_same(start.inputs, inputs, folder)
    for frames, stamps in ((start.frames, start.stamps), journal.stamps()):
        _check_footage(frames, stamps, views, folder)
    return journal


def _check_footage(frames: np.ndarray, stamps: np.ndarray, views: Views, folder: Path) -> None:
    for frame, before in zip(frames.tolist(), stamps, strict=True):
        changed = (views.stamps(frame) != before).any(axis=1)
        if changed.any():
            raise MocapError(
                "the footage has changed since this frame was used",
                "leave out --resume to fit all frames anew",
                file=folder, camera=views.cameras[int(np.argmax(changed))].name, frame=frame,
            )  # fmt: skip


def finished_result(folder: Path, inputs: Inputs, views: Views) -> FitResult | None:
    """The finished fit in ``folder``, which names no files; None where there is none.

    Raises:
        MocapError: it was made from other inputs or footage.
    """
    try:
        report = json.loads((folder / REPORT).read_text("utf-8"))
        motion = read_motion(folder / MOTION)
    except (MocapError, OSError, ValueError):
        return None
    if not isinstance(report, dict) or not report.get("finished"):
        return None
    if report.get("digests") != _digests(folder) or not isinstance(report.get("inputs"), dict):
        return None
    frames = np.arange(views.frames[0], views.frames[1] + 1)
    names = [camera.name for camera in views.cameras]
    stamps = np.stack([views.stamps(int(frame)) for frame in frames])
    check_same(report["inputs"], {**inputs, **stamp_digests(names, frames, stamps)}, folder)
    set_aside(folder)
    return FitResult(motion, report, ())


def _digests(folder: Path) -> dict[str, str]:
    """Of the files that a report belongs to; without one that is missing."""
    found = {}
    for path in (folder / MOTION, folder / BODY):
        if path.exists():
            with path.open("rb") as file:
                found[path.name] = hashlib.file_digest(file, "sha256").hexdigest()
    return found


def _places(outcome: Outcome, folder: Path) -> tuple[Path, ...]:
    paths = tuple(folder / name for name in (MOTION, BODY, REPORT, PAGE))
    if outcome.complete or not paths[0].exists():
        return paths
    try:
        spared = len(read_motion(paths[0]).frames) >= len(outcome.journal)
    except MocapError:
        # of another version, perhaps: whatever it is, it may be worth more
        spared = True
    return tuple(map(_partial, paths)) if spared else paths


def _partial(path: Path) -> Path:
    return path.with_suffix(f".partial{path.suffix}")


def _tell_files(outcome: Outcome, motion: Path, tell: Callable[[str], None]) -> None:
    spared = motion.name != MOTION
    if not outcome.complete:
        beside = f", beside the {MOTION} of an earlier fit" if spared else ""
        kept = f"the {len(outcome.journal)} finished frames are kept in {motion}{beside}"
        tell(f"{kept}; --resume goes on")
    names = [OVERLAY] * (not outcome.complete)
    names += [f"{outcome.take.name}.{suffix}" for suffix in EXPORTS]
    if outcome.complete:
        for path in _places(outcome, motion.parent):
            _partial(path).unlink(missing_ok=True)
    names += [_partial(motion).name]
    older = [name for name in names if (motion.parent / name).exists()]
    if older and not spared:
        tell(f"from an earlier fit, unless written again now: {', '.join(older)}")


def _camera_facts(views: Views, motion: Motion) -> dict[str, dict]:
    """Sizes and scale: all scores hold at the working size."""
    centre = motion.points.mean(axis=(0, 1))
    return {
        view.camera.name: {
            "footage_size": list(view.source.footage.size),
            "working_size": list(view.camera.size),
            "reduced_by": view.reduction.factor,
            "mm_per_px": _scale(view.camera, centre),
        }
        for view in views.views
    }


def _scale(camera: Camera, point: np.ndarray) -> float | None:
    """Millimetres per px at a world point (3,); None where the camera has it at its back."""
    return millimetres_per_pixel(camera, point) if camera.depths(point) > 0 else None


def _error(take: Take, motion: Motion, tell: Callable[[str], None]) -> dict | None:
    """The error against the truth beside the take, where there is one for these frames."""
    path = take.path.parent / "truth.npz"
    if not path.exists():
        return None
    found = PointTrack(motion.point_names, motion.frames, motion.points)
    try:
        truth = read_point_track(path).between(int(motion.frames[0]), int(motion.frames[-1]))
        return score(truth, found).as_dict() if len(truth.frames) else None
    except MocapError as error:
        tell(f"no error to the truth: {error}")
        return None
