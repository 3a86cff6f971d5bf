"""``info``: everything that ``fit`` will meet, looked at beforehand."""

import argparse
from pathlib import Path

from ..beginning import initial_frames
from ..checking.check import CheckRequest, TakeCheck, checked
from ..checking.sheet import SHEET, write_check_sheet
from ..checking.words import (
    CAMERA_HEADINGS,
    Facts,
    camera_words,
    estimate_words,
    footage_words,
    take_words,
)
from ..files import check_replaceable
from ..motion.export_request import Exporter
from ..rendering.choice import BEST, EVALUATORS
from ..results.exporting import check_formats
from .arguments import add_take, taken
from .console import say

EXAMPLE = "silhouette-mocap info sample_scenes/walk/take.toml --sheet walk.html"
_DONE, _INPUT = 0, 2


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)
    parser.add_argument(
        "--sheet", type=Path, metavar="FILE.html",
        help="write all of it to a page, with pictures and a plan of the cameras",
    )  # fmt: skip


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Checks part by part; a fault in one does not hide those in others."""
    if arguments.sheet is not None:
        check_replaceable(arguments.sheet, SHEET)
    take = taken(arguments)
    request = CheckRequest(
        initial_frames,
        EVALUATORS[BEST],
        further=(lambda: check_formats(take.exports, exporter),),
        progress=arguments.console,
        read_rig=arguments.read_rig,
    )
    check = checked(take, request)
    _tell(check)
    for fault in check.faults:
        arguments.console.fault(fault, _INPUT)
    if arguments.sheet is not None:
        write_check_sheet(arguments.sheet, check)
        arguments.console.wrote(arguments.sheet)
    say("something is missing" if check.faults else "all that fit needs is there")
    return _INPUT if check.faults else _DONE


def _tell(check: TakeCheck) -> None:
    _tell_facts(take_words(check))
    _tell_cameras(check)
    for footage in check.footage:
        say(f"{'footage':<12}{footage.camera}: {footage_words(footage)}")
    if check.estimate is not None:
        _tell_facts(estimate_words(check.estimate))
    for note in check.notes:
        say(f"note: {note}")


def _tell_facts(facts: Facts) -> None:
    for name, value in facts:
        say(f"{name:<12}{value}")


def _tell_cameras(check: TakeCheck) -> None:
    rows = [CAMERA_HEADINGS, *map(camera_words, check.cameras)]
    widths = [max(map(len, column)) + 2 for column in zip(*rows, strict=True)]
    for row in rows:
        name, *rest = row
        cells = (f"{cell:>{wide}}" for cell, wide in zip(rest, widths[1:], strict=True))
        say(f"{name:<{widths[0]}}{''.join(cells)}")
