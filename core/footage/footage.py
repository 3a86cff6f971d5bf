"""The pictures of one camera, streamed in frame order.

A footage holds one picture at a time, so that memory does not grow with the take. Frame numbers
are those of the take: numbered files keep their numbers, videos and unnumbered folders count from
0.
"""

import logging
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Protocol

import numpy as np

from ..errors import MocapError
from .patterns import for_camera, for_frame, frame_numbers, has_frame, natural_key
from .pictures import PICTURE_SUFFIXES
from .sequence import ListedFiles, NumberedFiles, PictureSequence
from .video import Video

_log = logging.getLogger(__name__)


class Footage(Protocol):
    """What every kind of footage offers.

    Attributes:
        camera: the camera's name.
        size: (width, height) of every picture in px.
        lossy: whether grey values may be off by the compression.
    """

    camera: str
    size: tuple[int, int]
    lossy: bool

    @property
    def fps(self) -> float | None:
        """Frames per second, where the file says so."""
        ...

    @property
    def frames(self) -> Sequence[int]:
        """The frame numbers that exist, rising; a video is decoded once to count them."""
        ...

    def picture(self, frame: int) -> np.ndarray:
        """The picture of one frame, as stored (see ``read_picture``).

        Raises:
            MocapError: the frame is missing, damaged or of another size.
        """
        ...

    def file(self, frame: int) -> Path:
        """The file that holds the picture of ``frame``.

        Raises:
            MocapError: the frame is missing.
        """
        ...

    def stamp(self, frame: int) -> tuple[int, int]:
        """Size and time of change (ns) of the file that holds the picture of ``frame``.

        Raises:
            MocapError: the frame is missing.
        """
        ...

    def pictures(self, first: int, last: int) -> Iterator[tuple[int, np.ndarray]]:
        """Frame number and picture of the frames ``first`` to ``last``, inclusive, one by one."""
        ...


def open_footage(
    pattern: str | Path, camera: str, frames: tuple[int, int] | None = None
) -> Footage:
    """The footage of one camera.

    Args:
        pattern: a path with ``{camera}`` and, for picture sequences, ``{frame}`` or
            ``{frame:06d}``; without a frame, the path of a video or of a folder, whose pictures
            are sorted naturally (2 before 10) and counted from 0.
        camera: the camera's name.
        frames: first and last frame that will be asked for, inclusive; of a picture sequence all of
            them must exist.

    Raises:
        MocapError: nothing there, not readable, or a frame of a sequence is missing.
    """
    try:
        footage = _opened(for_camera(pattern, camera), camera, frames)
    except OSError as error:
        problem = f"cannot be opened ({error.strerror})"
        raise MocapError(
            problem, "check the path", file=for_camera(pattern, camera), camera=camera
        ) from error
    place, length = for_camera(pattern, camera), ""
    if isinstance(footage, PictureSequence):
        there = footage.frames
        length = f", {len(there)} pictures from {there[0]} to {there[-1]}"
    elif footage.fps is not None:
        length = f", {footage.fps:g} frames per second"
    _log.info("camera %s: footage %s, %d x %d px%s", camera, place, *footage.size, length)
    return footage


def _opened(path: str, camera: str, frames: tuple[int, int] | None) -> Footage:
    if has_frame(path):
        return PictureSequence(camera, _numbered(path, camera), frames)
    place = Path(path)
    if place.is_dir():
        return PictureSequence(camera, _folder(place, camera), frames)
    if not place.exists():
        remedy = "check the path, and that files are named after the cameras"
        if "{" in path:
            remedy = "check the path; only {camera} and {frame} are put in"
        raise MocapError("no such footage", remedy, file=place, camera=camera)
    if place.suffix.lower() in PICTURE_SUFFIXES:
        raise MocapError(
            "is a single picture",
            "write {frame:06d} where the file names count the frames",
            file=place,
            camera=camera,
        )
    return Video(camera, place, frames)


def _numbered(pattern: str, camera: str) -> NumberedFiles:
    numbers = frame_numbers(pattern)
    if not numbers:
        # a folder that may not be read seems to be empty
        with suppress(FileNotFoundError, NotADirectoryError):
            os.listdir(for_frame(pattern, 0).parent)
        raise MocapError(
            "no picture of this name",
            "check the folder, and how many digits the frame numbers have",
            file=pattern,
            camera=camera,
        )
    return NumberedFiles(pattern, numbers)


def _folder(folder: Path, camera: str) -> ListedFiles:
    paths = (path for path in folder.iterdir() if path.suffix.lower() in PICTURE_SUFFIXES)
    # hidden files: macOS leaves ._name.png beside every picture on foreign disks
    names = sorted((path.name for path in paths if path.name[0] != "."), key=natural_key)
    if not names:
        raise MocapError("no pictures in this folder", "check the path", file=folder, camera=camera)
    _check_distinct(folder, names, camera)
    return ListedFiles(folder, tuple(names))


def _check_distinct(folder: Path, names: Sequence[str], camera: str) -> None:
    """Refuses one frame under two names, such as 1.png and 000001.png, or 1.png and 1.jpg."""
    seen: dict[tuple, str] = {}
    for name in names:
        other = seen.setdefault(natural_key(Path(name).stem), name)
        if other != name:
            raise MocapError(
                f"{other} and {name} have the same number", "remove one of them",
                file=folder, camera=camera,
            )  # fmt: skip
