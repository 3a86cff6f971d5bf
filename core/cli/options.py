"""Options of every command; nothing here takes time to load."""

import argparse
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

PROGRESS = ("bar", "json", "none")


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
