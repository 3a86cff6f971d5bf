"""Paths with placeholders: ``{camera}`` and ``{frame}`` or ``{frame:06d}``.

Everything else in braces is left alone, since folders may be called so.
"""

import glob
import re
from pathlib import Path

_FRAME = re.compile(r"\{frame(?::(0?\d?)d)?\}")


def for_camera(pattern: str | Path, camera: str) -> str:
    """``pattern`` with the camera's name put in."""
    return str(pattern).replace("{camera}", camera)


def has_frame(pattern: str) -> bool:
    """Whether ``pattern`` names one file per frame."""
    return _FRAME.search(pattern) is not None


def for_frame(pattern: str, frame: int) -> Path:
    """The file of one frame."""
    return Path(_FRAME.sub(lambda hit: format(frame, (hit[1] or "") + "d"), pattern))


def ends_in_frame(pattern: str) -> bool:
    """Whether the frame is the one and last number in the file's name, as players count files."""
    last = re.search(_FRAME.pattern + r"\D*$", Path(pattern).stem)
    return last is not None and len(_FRAME.findall(pattern)) == 1


def frame_numbers(pattern: str) -> list[int]:
    """The frames of the files on disk that fit ``pattern``, rising."""
    pattern, found = str(Path(pattern)), []
    of_file = re.compile(_pieces(pattern, re.escape, r"(\d{1,18})"))
    for name in glob.iglob(_pieces(pattern, glob.escape, "*")):
        hit = of_file.fullmatch(name)
        if hit and str(for_frame(pattern, int(hit[1]))) == name:
            found.append(int(hit[1]))
    return sorted(found)


def _pieces(pattern: str | Path, escape, wildcard: str) -> str:
    text, out, end = str(pattern), "", 0
    for hit in _FRAME.finditer(text):
        out += escape(text[end : hit.start()]) + wildcard
        end = hit.end()
    return out + escape(text[end:])


def natural_key(name: str) -> tuple:
    """Sorts ``shot2`` before ``shot10``."""
    parts = re.split(r"(\d+)", name.casefold())
    return tuple((int(part), "") if part.isdecimal() else (-1, part) for part in parts)
