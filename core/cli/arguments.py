"""Arguments that several commands share, and how their words are read."""

import argparse
from pathlib import Path

from ..motion.export_request import FORMATS
from ..take.reading import read_take
from ..take.take import Take


def add_take(parser: argparse.ArgumentParser) -> None:
    """TAKE and --root."""
    parser.add_argument("take", type=Path, metavar="TAKE.toml", help="the take")
    parser.add_argument(
        "--root", type=Path, metavar="DIR",
        help="folder that all files of the take lie in (default: above the take's own folder)",
    )  # fmt: skip


def add_cameras(parser: argparse.ArgumentParser) -> None:
    """--without."""
    parser.add_argument(
        "--without", action="append", default=[], metavar="CAM",
        help="leave this camera out; may be repeated",
    )  # fmt: skip


def add_cameras_and_frames(parser: argparse.ArgumentParser) -> None:
    """--without and --frames."""
    add_cameras(parser)
    parser.add_argument(
        "--frames", type=frame_range, default=(None, None), metavar="A:B",
        help="only frames A to B, inclusive; either may be left out",
    )  # fmt: skip


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
