"""Arguments that several commands share, and how their words are read."""

import argparse
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from ..motion.export_request import FORMATS
from ..take.reading import read_take
from ..take.take import Take

PROGRESS = ("bar", "json", "none")


def add_take(parser: argparse.ArgumentParser) -> None:
    """TAKE and --root."""
    parser.add_argument("take", type=Path, metavar="TAKE.toml", help="the take")
    parser.add_argument(
        "--root", type=Path, metavar="DIR",
        help="folder that all files of the take lie in (default: above the take's own folder)",
    )  # fmt: skip


def add_cameras_and_frames(parser: argparse.ArgumentParser) -> None:
    """--without and --frames."""
    parser.add_argument(
        "--without", action="append", default=[], metavar="CAM",
        help="leave this camera out; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--frames", type=frame_range, default=(None, None), metavar="A:B",
        help="only frames A to B, inclusive; either may be left out",
    )  # fmt: skip


def add_common(parser: argparse.ArgumentParser) -> None:
    """What every command understands: --progress, --verbose and --log-file."""
    shared = parser.add_argument_group("what is told")
    shared.add_argument(
        "--progress", choices=PROGRESS, default=PROGRESS[0],
        help="on standard error: a bar (lines where it is no terminal), JSON for programs, or none",
    )  # fmt: skip
    shared.add_argument(
        "-v", "--verbose", action="store_true", help="tell what is done and found on the way"
    )
    shared.add_argument(
        "--log-file", type=Path, metavar="FILE", help="add all of that and more to this file"
    )


def asked_progress(argv: Sequence[str]) -> str | None:
    """The word after ``--progress``, known before other words may turn out to be wrong."""
    asked = None
    for word, following in pairwise((*argv, "")):
        if word == "--progress":
            asked = following
        elif word.startswith("--progress="):
            asked = word.partition("=")[2]
    return asked


def taken(arguments: argparse.Namespace) -> Take:
    """The take that was named."""
    return read_take(arguments.take, arguments.root)


def frame_range(text: str) -> tuple[int | None, int | None]:
    """First and last frame of ``A:B``; None for an end that is left out."""
    first, colon, last = text.partition(":")
    ends = [end.strip() for end in (first, last)]
    if not colon or not all(end.isdecimal() or not end for end in ends):
        raise argparse.ArgumentTypeError(f"expected A:B with frame numbers, got {text!r}")
    begin, end = (int(end) if end else None for end in ends)
    return begin, end


def format_list(text: str) -> tuple[str, ...]:
    """Formats of ``fbx,bvh``; ``none`` for no format."""
    if text == "none":
        return ()
    names = tuple(dict.fromkeys(name.strip().lower() for name in text.split(",")))
    for name in names:
        if name not in FORMATS:
            raise argparse.ArgumentTypeError(
                f"expected formats among {', '.join(FORMATS)}, got {name!r}"
            )
    return names
