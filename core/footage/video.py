"""Footage stored as a video file.

Frames are counted by decoding from the start: containers' counts and seeking by index are wrong
for damaged files, for variable frame rates and for many codecs.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path

import cv2
import numpy as np

from ..errors import MocapError
from ..files import check_ordinary
from .pictures import file_stamp

HELD_BYTES = 64 * 2**20
"""The most memory that going backwards takes per video."""


class Video:
    """A video file, read forwards; going back starts again from its first frame.

    Then a block of pictures up to the one asked for is held, so that going on backwards decodes
    from the start once per block, not once per frame.

    Rotation that the file asks for is applied by the decoder.

    Args:
        camera: the camera's name.
        path: the file.
        asked: first and last frame that will be asked for; None for whatever is there.

    Raises:
        MocapError: not a video, its first frame cannot be decoded, or it ends before the last
            frame asked for.
    """

    lossy = True

    def __init__(self, camera: str, path: Path, asked: tuple[int, int] | None = None):
        self.camera = camera
        self.path = path
        self._capture = self._opened()
        fps = self._capture.get(cv2.CAP_PROP_FPS)
        self.fps = float(fps) if 0 < fps < 10_000 else None
        self._next = 0
        self._held: dict[int, np.ndarray] = {}
        height, width = self.picture(0).shape[:2]
        self.size = (width, height)
        if asked is not None and not self._seems_to_reach(asked[1]) and self._count <= asked[1]:
            raise self._ended(self._count, self._count)

    @property
    def frames(self) -> Sequence[int]:
        """The frame numbers that exist; the whole file is decoded once to count them."""
        return range(self._count)

    @cached_property
    def _count(self) -> int:
        capture, count = self._opened(), 0
        while capture.grab():
            count += 1
        return count

    @property
    def stated_frames(self) -> int:
        """How many frames the file's head claims, which may be wrong."""
        return int(self._capture.get(cv2.CAP_PROP_FRAME_COUNT))

    def _seems_to_reach(self, last: int) -> bool:
        """Whether the file says so and ``last`` is found at once; both may be wrong (see above)."""
        capture = self._opened()
        return (
            self.stated_frames > last
            and capture.set(cv2.CAP_PROP_POS_FRAMES, last)
            and capture.grab()
        )

    def picture(self, frame: int) -> np.ndarray:
        """(H, W, 3) uint8 BGR picture of one frame.

        Raises:
            MocapError: the video ends before, or breaks off.
        """
        if frame not in self._held:
            self._hold(frame)
        return self._held[frame]

    def _hold(self, frame: int) -> None:
        """Decodes ``frame``, and those before it where that means going back."""
        first = frame
        if frame < self._next:
            width, height = self.size
            first = max(0, frame + 1 - max(1, HELD_BYTES // (width * height * 3)))
            self._capture, self._next = self._opened(), 0
        # those held until now make room first
        self._held = {}
        while self._next < first:
            if not self._capture.grab():
                raise self._ended(frame, self._next)
            self._next += 1
        while self._next <= frame:
            good, picture = self._capture.read()
            if not good:
                raise self._ended(frame, self._next)
            self._held[self._next] = picture
            self._next += 1

    def file(self, frame: int) -> Path:
        """The video."""
        return self.path

    def stamp(self, frame: int) -> tuple[int, int]:
        """Size and time of change (ns) of the video."""
        return file_stamp(self.path, self.camera, frame)

    def pictures(self, first: int, last: int) -> Iterator[tuple[int, np.ndarray]]:
        """Frame number and picture of the frames ``first`` to ``last``, inclusive, one by one."""
        for frame in range(first, last + 1):
            yield frame, self.picture(frame)

    def _opened(self) -> cv2.VideoCapture:
        check_ordinary(self.path, self.camera)
        # one decoder on every system, so that the same file gives the same pictures
        capture = cv2.VideoCapture(str(self.path), cv2.CAP_FFMPEG)
        if not capture.isOpened():
            raise MocapError(
                "is no video that can be decoded, or is cut short",
                "export it again, for example as H.264 in .mp4",
                file=self.path,
                camera=self.camera,
            )
        return capture

    def _ended(self, frame: int, count: int) -> MocapError:
        promised = self.stated_frames
        if not count:
            problem, remedy = "holds no frame that can be decoded", "export it again"
        elif promised > max(frame, count):
            problem = f"breaks off after {count} of {promised} frames"
            remedy = "export it again, or narrow the take's frames"
        else:
            problem = f"ends after {count} frames, counted from 0"
            remedy = "give longer footage, or narrow the take's frames"
        return MocapError(problem, remedy, file=self.path, camera=self.camera, frame=frame)
