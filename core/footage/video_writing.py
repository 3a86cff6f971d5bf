"""Videos written frame by frame, whole or not at all."""

from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np

from ..errors import MocapError
from ..files import whole_file


def write_video(path: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    """Writes ``pictures`` (H, W, 3) uint8 BGR, all of one size, as MPEG-4.

    Raises:
        MocapError: it cannot be written, or not to its end.
        ValueError: no picture.
    """
    with whole_file(path) as partial:
        video, count = cv2.VideoWriter(), 0
        try:
            for picture in pictures:
                if not count:
                    size = (picture.shape[1], picture.shape[0])
                    code = cv2.VideoWriter.fourcc(*"mp4v")
                    video.open(str(partial), cv2.CAP_FFMPEG, code, fps, size)
                    if not video.isOpened():
                        raise MocapError("cannot be written", "check the folder", file=path)
                video.write(picture)
                count += 1
        finally:
            video.release()
        if not count:
            raise ValueError("expected at least one picture")
        _check(partial, path, count)


def _check(written: Path, path: Path, count: int) -> None:
    """The encoder does not tell when the disk is full, but its index comes last."""
    reader = cv2.VideoCapture(str(written), cv2.CAP_FFMPEG)
    if not reader.isOpened() or int(reader.get(cv2.CAP_PROP_FRAME_COUNT)) != count:
        raise MocapError("cannot be written to its end", "free space on that disk", file=path)
