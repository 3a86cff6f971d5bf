"""What a fit leaves in its folder: motion.npz, body.npz and report.json."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..body.body import Body
from ..body.file import write_body
from ..cameras.arrangement import millimetres_per_pixel
from ..errors import MocapError
from ..fitting.tracking import FrameFit
from ..motion.motion import Motion, write_motion
from ..motion.point_track import PointTrack, read_point_track
from ..motion.recording import recorded
from ..motion.report import fit_quality, versions, write_report
from ..motion.scoring import score
from .take import Take
from .views import Views

MOTION, BODY, REPORT = "motion.npz", "body.npz", "report.json"


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
        body: the performer.
        fits: the tracked frames in any order, at least one.
        settings: what was asked for beside the take.
        notes: what the user was told.
    """

    take: Take
    views: Views
    body: Body
    fits: Sequence[FrameFit]
    settings: dict[str, object]
    notes: tuple[str, ...]


def write_results(outcome: Outcome, folder: Path) -> FitResult:
    """Writes the three files, each whole or not at all."""
    take, views = outcome.take, outcome.views
    motion = recorded(
        outcome.fits, outcome.body, [camera.name for camera in views.cameras], take.fps
    )
    report = {
        "take": take.name,
        "settings": {
            "take": str(take.path),
            "body": str(take.performer.body),
            "frames": list(views.frames),
            **outcome.settings,
        },
        "versions": versions(),
        "notes": list(outcome.notes),
        "cameras": _camera_facts(views, motion),
        **fit_quality(motion, outcome.fits),
        "error_mm": _error(take, motion),
    }
    files = tuple(folder / name for name in (MOTION, BODY, REPORT))
    write_motion(files[0], motion)
    write_body(files[1], outcome.body)
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
