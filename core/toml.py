"""TOML files, read with every way in which one can be broken told as a fault of the file."""

import re
import tomllib
from pathlib import Path
from typing import Any

from .errors import MocapError
from .files import check_ordinary, unreadable

POINTS_NOT_COMMAS = "numbers need decimal points, not commas"
MOST_BYTES = 2**20
"""Beyond any take or calibration; what is larger is another file by mistake."""
_LONGEST_LINE = 10_000
_DECIMAL_COMMA = re.compile(r"^[^#\"'\n]*=[ \t]*[-+]?\d+,\d+[ \t\r]*(#.*)?$", re.MULTILINE)
# Python takes long to read one, and refuses to show it
_ENDLESS_NUMBER = re.compile(r"\d[0-9a-fA-FxX_]{300}")


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of ``path``.

    Raises:
        MocapError: no such file, not readable, too large, not UTF-8 or not TOML.
    """
    text = _text(path)
    if _ENDLESS_NUMBER.search(text):
        problem = "has a number of more digits than any number needs"
        raise MocapError(problem, "mend that number", file=path)
    if max(map(len, text.splitlines()), default=0) > _LONGEST_LINE:
        raise MocapError("has a line of more than 10,000 letters", "check the path", file=path)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        comma = f"; {POINTS_NOT_COMMAS}" if _DECIMAL_COMMA.search(text) else ""
        raise MocapError(
            f"is not valid TOML ({error})", f"mend that line{comma}", file=path
        ) from error
    except RecursionError as error:
        problem = "has brackets in brackets without end"
        raise MocapError(problem, "mend those brackets", file=path) from error


def _text(path: Path) -> str:
    check_ordinary(path)
    try:
        if path.stat().st_size > MOST_BYTES:
            problem = f"is larger than {MOST_BYTES // 2**20} MB"
            raise MocapError(problem, "check the path", file=path)
        # some editors put a byte order mark first
        return path.read_text("utf-8-sig")
    except IsADirectoryError as error:
        raise MocapError("is a folder", "name the .toml file in it", file=path) from error
    except OSError as error:
        raise unreadable(path, error) from error
    except UnicodeDecodeError as error:
        raise MocapError("is not UTF-8 text", "save it as UTF-8", file=path) from error
