"""Footage stored as one picture file per frame."""

from array import array
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from ..errors import MocapError
from .patterns import for_frame
from .pictures import file_stamp, read_picture


class PictureFiles(Protocol):
    """Where the pictures of one camera are, in a few bytes per frame."""

    @property
    def frames(self) -> Sequence[int]:
        """The frame numbers that exist, rising, at least one."""
        ...

    def path(self, frame: int) -> Path:
        """The file of one frame; where it is expected, if it does not exist."""
        ...


@dataclass(frozen=True)
class NumberedFiles:
    """Files whose names count the frames.

    Attributes:
        pattern: the name with ``{frame}``.
        frames: the numbers that exist, rising, at least one.
    """

    pattern: str
    frames: Sequence[int]

    def __post_init__(self):
        first, count = self.frames[0], len(self.frames)
        whole = range(first, first + count)
        compact = whole if whole[-1] == self.frames[-1] else array("q", self.frames)
        object.__setattr__(self, "frames", compact)

    def path(self, frame: int) -> Path:
        """The file of one frame."""
        return for_frame(self.pattern, frame)


@dataclass(frozen=True)
class ListedFiles:
    """Files in the order of their names, counted from 0.

    Attributes:
        folder: where they lie.
        names: of the files, at least one.
    """

    folder: Path
    names: tuple[str, ...]

    @property
    def frames(self) -> Sequence[int]:
        """The frame numbers that exist."""
        return range(len(self.names))

    def path(self, frame: int) -> Path:
        """The file of one frame; the folder, if there are fewer."""
        return self.folder / self.names[frame] if frame < len(self.names) else self.folder


class PictureSequence:
    """The picture files of one camera by frame number.

    Args:
        camera: the camera's name.
        files: where the pictures are.
        asked: first and last frame that must exist, inclusive; None for whatever is there.

    Raises:
        MocapError: a frame that was asked for is missing, or the first picture cannot be read.
    """

    fps = None

    def __init__(self, camera: str, files: PictureFiles, asked: tuple[int, int] | None = None):
        self.camera = camera
        self._files = files
        for frame in () if asked is None else range(asked[0], asked[1] + 1):
            self.file(frame)
        first = files.frames[0] if asked is None else asked[0]
        path = files.path(first)
        self.lossy = path.suffix.lower() in (".jpg", ".jpeg", ".webp")
        picture = read_picture(path, camera, first)
        self.size = (picture.shape[1], picture.shape[0])
        self._first = first

    @property
    def frames(self) -> Sequence[int]:
        """The frame numbers that exist, rising."""
        return self._files.frames

    def picture(self, frame: int) -> np.ndarray:
        """The picture of one frame, as stored.

        Raises:
            MocapError: the file is missing, damaged or of another size than the first one.
        """
        path = self.file(frame)
        picture = read_picture(path, self.camera, frame)
        size = (picture.shape[1], picture.shape[0])
        if size != self.size:
            raise MocapError(
                f"is {size[0]} x {size[1]} px, but frame {self._first} is "
                f"{self.size[0]} x {self.size[1]} px",
                "export all frames of a camera in one size",
                file=path,
                camera=self.camera,
                frame=frame,
            )
        return picture

    def stamp(self, frame: int) -> tuple[int, int]:
        """Size and time of change (ns) of the picture's file."""
        return file_stamp(self.file(frame), self.camera, frame)

    def pictures(self, first: int, last: int) -> Iterator[tuple[int, np.ndarray]]:
        """Frame number and picture of the frames ``first`` to ``last``, inclusive, one by one."""
        for frame in range(first, last + 1):
            yield frame, self.picture(frame)

    def file(self, frame: int) -> Path:
        """The picture's file.

        Raises:
            MocapError: the frame is missing.
        """
        frames, path = self._files.frames, self._files.path(frame)
        place = bisect_left(frames, frame)
        if place < len(frames) and frames[place] == frame:
            return path
        raise MocapError(
            f"missing; this camera has {len(frames)} pictures, frames {frames[0]} to {frames[-1]}",
            "add the picture or narrow the take's frames",
            file=path,
            camera=self.camera,
            frame=frame,
        )
