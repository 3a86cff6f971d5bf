"""Single pictures on disk, as OpenCV decodes them.

Files are read and written through memory: ``cv2.imread`` and ``cv2.imwrite`` cannot open paths
beyond the local code page on Windows.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np

from ..errors import MocapError
from ..files import check_ordinary, made_folder, unreadable, whole_file

PICTURE_SUFFIXES = (
    ".png",
    ".tif",
    ".tiff",
    ".jpg",
    ".jpeg",
    ".bmp",
    ".webp",
    ".pgm",
    ".ppm",
    ".tga",
)
_JPEG_MAGIC = b"\xff\xd8"
_PNG_MAGIC = b"\x89PNG\r\n\x1a\n"
_PNG_CHUNK = 12
"""Bytes of a chunk's length, kind and checksum."""


def read_picture(
    path: Path, camera: str | None = None, frame: int | None = None, remedy: str | None = None
) -> np.ndarray:
    """The picture of ``path`` as stored: (H, W), (H, W, 3) BGR or (H, W, 4) BGRA.

    Elements are uint8, uint16 or float. The orientation tag of JPEG files is obeyed, as players
    and OpenCV's videos do.

    Args:
        path: the file.
        camera: whose picture it is, for the message.
        frame: its frame number, for the message.
        remedy: what to advise when the file is missing.

    Raises:
        MocapError: no such file, or not a whole picture.
    """
    place = {"file": path, "camera": camera, "frame": frame}
    check_ordinary(path, camera, frame)
    try:
        data = np.fromfile(path, np.uint8)
    except FileNotFoundError as error:
        raise MocapError("no such picture", remedy or "check the path", **place) from error
    except OSError as error:
        raise unreadable(path, error, camera, frame) from error
    if not data.size:
        raise MocapError("is an empty file", "export it again", **place)
    # unchanged keeps alpha but ignores the orientation tag, which only JPEG files carry in practice
    unchanged = data[:2].tobytes() != _JPEG_MAGIC
    flags = cv2.IMREAD_UNCHANGED if unchanged else cv2.IMREAD_ANYCOLOR | cv2.IMREAD_ANYDEPTH
    with _decoder_silenced():
        try:
            picture = None if _is_cut_short(data) else cv2.imdecode(data, flags)
        except cv2.error as error:
            # OPENCV_IO_MAX_IMAGE_PIXELS, or memory
            problem = "claims to have more px than can be decoded"
            raise MocapError(problem, "export it again, smaller", **place) from error
    if picture is None:
        raise MocapError(
            "is no picture that can be decoded, or is cut short", "export it again", **place
        )
    if picture.dtype.kind == "f" and not np.isfinite(picture).all():
        raise MocapError(
            "holds numbers that are not finite", "export it again with values from 0 to 1", **place
        )
    return picture


def _is_cut_short(data: np.ndarray) -> bool:
    """Whether chunks of a PNG claim more bytes than there are.

    OpenCV would take memory for what they claim.
    """
    if data[:8].tobytes() != _PNG_MAGIC:
        return False
    place = len(_PNG_MAGIC)
    while place < data.size:
        place += _PNG_CHUNK + int.from_bytes(data[place : place + 4].tobytes(), "big")
    return place > data.size


def file_stamp(path: Path, camera: str, frame: int) -> tuple[int, int]:
    """Size in bytes and time of the last change in ns, which tell a changed file.

    Raises:
        MocapError: the file is gone.
    """
    try:
        found = path.stat()
    except OSError as error:
        raise unreadable(path, error, camera, frame) from error
    return found.st_size, found.st_mtime_ns


@contextmanager
def _decoder_silenced() -> Iterator[None]:
    """OpenCV would tell of damaged pictures on standard error, beside our own line."""
    level = cv2.getLogLevel()
    cv2.setLogLevel(0)
    try:
        yield
    finally:
        cv2.setLogLevel(level)


def write_picture(path: Path, picture: np.ndarray, flags: tuple[int, ...] = ()) -> None:
    """Writes ``picture`` whole, in the format of its suffix; missing folders are made.

    Args:
        path: the file to write; an existing one is replaced.
        picture: (H, W), (H, W, 3) BGR or (H, W, 4) BGRA, uint8 or uint16.
        flags: OpenCV's ``IMWRITE_`` pairs.

    Raises:
        MocapError: an unknown suffix, or a place that cannot be written to.
    """
    try:
        coded, data = cv2.imencode(path.suffix, picture, flags)
    except cv2.error:
        coded, data = False, np.zeros(0, np.uint8)
    if not coded:
        raise MocapError("is no picture format that can be written", "use .png", file=path)
    made_folder(path.parent)
    with whole_file(path) as partial:
        partial.write_bytes(data.tobytes())


def colour_picture(picture: np.ndarray) -> np.ndarray:
    """(H, W, 3) uint8 BGR of a picture as ``read_picture`` gives it; transparency is dropped.

    16-bit pictures are scaled by 1/257, floating-point ones are taken as 0 to 1.
    """
    if picture.dtype == np.uint16:
        picture = np.round(picture / 257.0).astype(np.uint8)
    elif picture.dtype != np.uint8:
        picture = np.round(np.clip(picture, 0, 1) * 255.0).astype(np.uint8)
    if picture.ndim == 2:
        return cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR)
    return np.ascontiguousarray(picture[:, :, :3])
