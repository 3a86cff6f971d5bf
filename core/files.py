"""Files that appear whole or not at all."""

import errno
import logging
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import MocapError

_REMEDIES = {
    **dict.fromkeys((errno.ENOSPC, errno.EDQUOT, errno.EFBIG), "free space on that disk"),
    **dict.fromkeys((errno.EACCES, errno.EPERM, errno.EROFS), "give a folder you may write to"),
    errno.ENAMETOOLONG: "give a shorter path",
}
_LONGEST_STEM = 100
_BEGIN_BYTES = 4096
_log = logging.getLogger(__name__)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A path beside ``path`` to write to, which takes the place of ``path`` at the end.

    When something fails in between, ``path`` stays as it was and nothing is left beside it.

    Raises:
        MocapError: the system refuses to write there.
    """
    partial = path.with_name(f".{path.stem[:_LONGEST_STEM]}.partial{path.suffix}")
    try:
        yield partial
        size = partial.stat().st_size
        partial.replace(path)
        _log.debug("wrote %s, %d bytes", path, size)
    except OSError as error:
        raise unwritable(path, error) from error
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)


def made_folder(path: Path) -> Path:
    """``path``, made where it is missing.

    Raises:
        MocapError: it cannot be made, or is there and cannot be written to.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        if not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    except OSError as error:
        raise unwritable(path, error) from error
    return path


def check_writable(path: Path) -> None:
    """Refuses a file that could not be written; its folder is made where it is missing.

    Raises:
        MocapError: it is a folder, or its folder cannot be made or written to.
    """
    if path.is_dir():
        raise MocapError("is a folder", "give a file", file=path)
    made_folder(path.parent)


def check_ordinary(path: Path, camera: str | None = None, frame: int | None = None) -> None:
    """Refuses what is there but neither file nor folder: a pipe could be waited for without end.

    Raises:
        MocapError: something of that kind, with the ``camera`` and ``frame`` it is for.
    """
    try:
        mode = path.stat().st_mode
    except OSError:
        # reading will tell
        return
    if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
        problem = "is no ordinary file"
        raise MocapError(problem, "check the path", file=path, camera=camera, frame=frame)


def check_replaceable(path: Path, ours: re.Pattern[bytes]) -> None:
    """Refuses to write where a file of the user's own would be lost, be it a take or a picture.

    Args:
        path: where a file is about to be written.
        ours: what files of that kind begin with, within their first 4 KB; empty ones may go, too.

    Raises:
        MocapError: a file of another kind is there.
    """
    try:
        if not path.is_file():
            return
        with path.open("rb") as file:
            begin = file.read(_BEGIN_BYTES)
    except OSError:
        # writing will tell
        return
    if begin and not ours.match(begin):
        problem = "is there already, and is not what would be written there"
        raise MocapError(problem, "give another path", file=path)


def unreadable(
    path: Path, error: OSError, camera: str | None = None, frame: int | None = None
) -> MocapError:
    """The fault that ``path`` cannot be read, with the ``camera`` and ``frame`` it is for."""
    problem, remedy = f"cannot be read ({error.strerror})", "check the file"
    if isinstance(error, FileNotFoundError):
        problem, remedy = "no such file", "check the path"
    return MocapError(problem, remedy, file=path, camera=camera, frame=frame)


def unwritable(path: Path | str, error: OSError) -> MocapError:
    """The fault that ``path`` cannot be written, and what helps against it."""
    remedy = _REMEDIES.get(error.errno or 0, "check the folder")
    return MocapError(f"cannot be written ({error.strerror or error})", remedy, file=path)
