"""The result of a fit cleaned in its folder, and put back as it was."""

import hashlib
import json
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..body.body import Body
from ..body.file import read_body
from ..body.kinematics import joint_positions
from ..errors import MocapError
from ..files import check_ordinary, unreadable, whole_file
from ..motion.cleaning.cleaned import Cleaned, cleaned, undone
from ..motion.cleaning.settings import CleanSettings
from ..motion.motion import Motion, read_motion, write_motion
from ..progress import Progress
from ..take.take import EXPORTS
from .clean_page import write_clean_page
from .report import write_report
from .writing import BODY, MOTION, REPORT

PAGE = "clean.html"
_SECTION = "clean"
_SAME_M = 1e-6


@dataclass(frozen=True, eq=False)
class Result:
    """A fit's result as it lies in its folder.

    Attributes:
        folder: where.
        motion: of motion.npz.
        body: of body.npz.
        report: of report.json.
    """

    folder: Path
    motion: Motion
    body: Body
    report: dict

    @property
    def floor(self) -> float:
        """The take's floor, m.

        Raises:
            MocapError: the report does not tell.
        """
        try:
            return float(self.report["inputs"]["floor"])
        except (KeyError, TypeError, ValueError) as error:
            problem = "does not tell the height of the floor"
            path = self.folder / REPORT
            raise MocapError(problem, "give it with --floor, in m", file=path) from error


def result_folder(path: Path) -> Path:
    """The folder that is given, or that the motion.npz lies in which is given in its place.

    Raises:
        MocapError: no motion lies there.
    """
    folder = path.parent if path.name == MOTION else path
    if not (folder / MOTION).exists():
        raise MocapError(f"holds no {MOTION}", "give the folder of a fit's result", file=folder)
    return folder


def read_result(folder: Path) -> Result:
    """The result in ``folder``.

    Raises:
        MocapError: a file is missing or damaged, or body and motion are of different fits.
    """
    motion, body = read_motion(folder / MOTION), read_body(folder / BODY)
    remedy = "run fit again, with --resume"
    if not _is_whole(motion):
        raise MocapError("is a damaged motion", remedy, file=folder / MOTION)
    if body.dofs.names != motion.dof_names or not np.allclose(
        joint_positions(body, motion.pose[:1]), motion.joints[:1], rtol=0, atol=_SAME_M
    ):
        raise MocapError(f"{MOTION} and {BODY} are of different fits", remedy, file=folder)
    return Result(folder, motion, body, _read_report(folder / REPORT))


def _is_whole(motion: Motion) -> bool:
    """Whether all that cleaning works on is there for every frame."""
    frames, joints = len(motion.frames), len(motion.joint_names)
    wanted = {
        "pose": (frames, len(motion.dof_names)),
        "pose_raw": (frames, len(motion.dof_names)),
        "joints": (frames, joints, 3),
        "keyed": (frames, joints),
        "confidence_raw": (frames, len(motion.point_names)),
        "lost": (frames,),
        "locked": (frames,),
    }
    arrays = {name: np.asarray(getattr(motion, name)) for name in wanted}
    right = all(array.shape == wanted[name] for name, array in arrays.items())
    return frames > 0 and right and all(np.isfinite(array).all() for array in arrays.values())


def clean_result(
    result: Result,
    settings: CleanSettings,
    floor: float | None,
    progress: Progress,
    shield: Callable[[], AbstractContextManager] = nullcontext,
) -> tuple[Cleaned, tuple[Path, ...]]:
    """Cleans ``result`` in its folder; also the files written, all of them or none.

    Args:
        result: cleaned before or not.
        settings: what to do.
        floor: its height, m; None for what the take says.
        progress: is told how far it is.
        shield: entered while files are replaced, so that nothing interrupts it.

    Raises:
        MocapError: the settings do not suit the motion, or a file cannot be written.
    """
    height = result.floor if floor is None and settings.contacts else floor or 0.0
    if not math.isfinite(height):
        raise MocapError(f"a floor at {height} m is none", "give its height, such as --floor 0")
    found = cleaned(result.body, result.motion, settings, height, progress)
    report = {**result.report, _SECTION: found.as_dict()}
    files = tuple(result.folder / name for name in (MOTION, REPORT, PAGE))
    with shield(), _replaced_together(files) as (motion, new_report, page):
        write_clean_page(page, found, report)
        _write(result, found.motion, report, (motion, new_report))
    _tell_older_files(result, progress)
    return found, files


def undo_result(
    result: Result,
    progress: Progress,
    shield: Callable[[], AbstractContextManager] = nullcontext,
) -> tuple[Path, ...]:
    """Puts ``result`` back as the fit wrote it, to the bit; the files written.

    Args:
        result: cleaned before or not.
        progress: is told what exports are out of date.
        shield: entered while files are replaced.

    Raises:
        MocapError: a file cannot be written.
    """
    report = {key: value for key, value in result.report.items() if key != _SECTION}
    files = tuple(result.folder / name for name in (MOTION, REPORT))
    with shield():
        with _replaced_together(files) as (motion, new_report):
            _write(result, undone(result.body, result.motion), report, (motion, new_report))
        (result.folder / PAGE).unlink(missing_ok=True)
    _tell_older_files(result, progress)
    return files


@contextmanager
def _replaced_together(paths: Sequence[Path]) -> Iterator[list[Path]]:
    """Files to write to, which take the place of ``paths`` when all of them are whole."""
    with ExitStack() as stack:
        partials = [stack.enter_context(whole_file(path)) for path in paths]
        try:
            yield partials
        except MocapError as error:
            real = dict(zip(partials, paths, strict=True))
            if error.file not in real:
                raise
            raise MocapError(error.problem, error.remedy, file=real[error.file]) from error


def _write(result: Result, motion: Motion, report: dict, places: tuple[Path, Path]) -> None:
    """Writes motion and report to ``places``.

    The report goes on belonging to the motion, where it did, so that a finished fit stays one.
    """
    digests = report.get("digests", {})
    write_motion(places[0], motion)
    if digests.get(MOTION) == _digest(result.folder / MOTION):
        report = {**report, "digests": {**digests, MOTION: _digest(places[0])}}
    write_report(places[1], report)


def _tell_older_files(result: Result, progress: Progress) -> None:
    name = result.report.get("take", "")
    older = [f"{name}.{suffix}" for suffix in EXPORTS]
    older = [file for file in older if (result.folder / file).exists()]
    if older:
        progress.note(f"{', '.join(older)} show the motion before; export again for new ones")


def _read_report(path: Path) -> dict:
    check_ordinary(path)
    remedy = "run fit again, with --resume"
    try:
        report = json.loads(path.read_text("utf-8"))
    except OSError as error:
        raise unreadable(path, error) from error
    except ValueError as error:
        raise MocapError("cannot be read as JSON", remedy, file=path) from error
    if not isinstance(report, dict) or not isinstance(report.get("digests", {}), dict):
        raise MocapError("is no report of a fit", remedy, file=path)
    return report


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
