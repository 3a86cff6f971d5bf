"""Paths with placeholders: ``{camera}`` and ``{frame}`` or ``{frame:06d}``.

Everything else in braces is left alone, since folders may be called so.
"""

import glob
import re
from pathlib import Path

_FRAME = re.compile(r"\{frame(?::(0?\d*)d)?\}")


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


def numbered_files(pattern: str) -> dict[int, Path]:
    """The files on disk that fit ``pattern``, by frame number, in rising order."""
    found = {}
    for name in glob.glob(_pieces(pattern, glob.escape, "*")):
        hit = re.fullmatch(_pieces(Path(pattern), re.escape, r"(\d+)"), str(Path(name)))
        if hit and str(for_frame(str(Path(pattern)), int(hit[1]))) == str(Path(name)):
            found[int(hit[1])] = Path(name)
    return dict(sorted(found.items()))


def _pieces(pattern: str | Path, escape, wildcard: str) -> str:
    text, out, end = str(pattern), "", 0
    for hit in _FRAME.finditer(text):
        out += escape(text[end : hit.start()]) + wildcard
        end = hit.end()
    return out + escape(text[end:])


def natural_key(path: Path) -> tuple:
    """Sorts ``shot2`` before ``shot10``."""
    parts = re.split(r"(\d+)", path.name.casefold())
    return tuple((int(part), "") if part.isdecimal() else (-1, part) for part in parts)
