"""Footage stored as one picture file per frame."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ..errors import MocapError
from .patterns import for_frame
from .pictures import file_stamp, read_picture


class PictureSequence:
    """The picture files of one camera by frame number.

    Args:
        camera: the camera's name.
        files: path by frame number, rising, at least one.
        asked: first and last frame that must exist, inclusive; None for whatever is there.
        pattern: the name of a file with ``{frame}``, to say where a missing one is expected.

    Raises:
        MocapError: a frame that was asked for is missing, or the first picture cannot be read.
    """

    fps = None

    def __init__(
        self,
        camera: str,
        files: dict[int, Path],
        asked: tuple[int, int] | None = None,
        pattern: str | None = None,
    ):
        self.camera = camera
        self._files = files
        self._pattern = pattern
        if asked is not None:
            for frame in range(asked[0], asked[1] + 1):
                self._path(frame)
        first = next(iter(files)) if asked is None else asked[0]
        path = files[first]
        self.lossy = path.suffix.lower() in (".jpg", ".jpeg", ".webp")
        picture = read_picture(path, camera, first)
        self.size = (picture.shape[1], picture.shape[0])

    @property
    def frames(self) -> Sequence[int]:
        """The frame numbers that exist, rising."""
        return tuple(self._files)

    def picture(self, frame: int) -> np.ndarray:
        """The picture of one frame, as stored.

        Raises:
            MocapError: the file is missing, damaged or of another size than the first one.
        """
        path = self._path(frame)
        picture = read_picture(path, self.camera, frame)
        size = (picture.shape[1], picture.shape[0])
        if size != self.size:
            raise MocapError(
                f"is {size[0]} x {size[1]} px, but this camera's others are "
                f"{self.size[0]} x {self.size[1]} px",
                "export all frames of a camera in one size",
                file=path,
                camera=self.camera,
                frame=frame,
            )
        return picture

    def stamp(self, frame: int) -> tuple[int, int]:
        """Size and time of change (ns) of the picture's file."""
        return file_stamp(self._path(frame), self.camera, frame)

    def pictures(self, first: int, last: int) -> Iterator[tuple[int, np.ndarray]]:
        """Frame number and picture of the frames ``first`` to ``last``, inclusive, one by one."""
        for frame in range(first, last + 1):
            yield frame, self.picture(frame)

    def _path(self, frame: int) -> Path:
        if frame in self._files:
            return self._files[frame]
        lowest, highest = min(self._files), max(self._files)
        file = next(iter(self._files.values())).parent
        if self._pattern is not None:
            file = for_frame(self._pattern, frame)
        raise MocapError(
            f"missing; this camera has {len(self._files)} pictures, frames {lowest} to {highest}",
            "add the picture or narrow the take's frames",
            file=file,
            camera=self.camera,
            frame=frame,
        )
