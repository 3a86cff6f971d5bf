"""``clean``: the motion of a fit smoothed, gaps filled, feet held; and undone again."""

import argparse
from pathlib import Path

from ..motion.cleaning.cleaned import Cleaned
from ..motion.cleaning.settings import FILTERS, REFIT, CleanSettings
from ..motion.export_request import Exporter
from ..pages.wording import spans
from ..results.cleaning import clean_result, read_result, result_folder, undo_result
from ..results.folder import occupied
from .console import say
from .interrupts import shielded
from .numbers import shown

EXAMPLE = "silhouette-mocap clean out/walk --smooth 5 --keys 5"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    parser.add_argument("result", type=Path, metavar="DIR", help="folder of the fit's result")
    parser.add_argument(
        "--smooth", type=float, metavar="HZ",
        help="frequency of which half is left; lower is smoother (default: 6, for one-euro 3; "
        "at most 0.4 of the frame rate)",
    )  # fmt: skip
    parser.add_argument(
        "--filter", choices=FILTERS, default=REFIT,
        help="refit (the whole take at once, acceleration penalised; the default), butterworth "
        "(second order, both ways) or one-euro (from the past alone)",
    )  # fmt: skip
    parser.add_argument(
        "--no-contacts", action="store_true", help="do not hold the feet where they stand"
    )
    parser.add_argument(
        "--floor", type=float, metavar="Z", help="height of the floor, m (default: the take's)"
    )
    parser.add_argument(
        "--keys", type=float, metavar="MM",
        help="keep only keys that are needed to stay within this distance (default: all)",
    )  # fmt: skip
    parser.add_argument(
        "--undo", action="store_true", help="put the motion back as the fit wrote it, to the bit"
    )


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Cleans or puts back, and sums up."""
    settings = CleanSettings(
        filter=arguments.filter,
        smooth_hz=arguments.smooth,
        contacts=not arguments.no_contacts,
        keys_mm=arguments.keys,
    )
    console, folder = arguments.console, result_folder(arguments.result)
    with occupied(folder):
        result = read_result(folder)
        if arguments.undo:
            files = undo_result(result, console, shielded)
        else:
            found, files = clean_result(result, settings, arguments.floor, console, shielded)
            _sum_up(found)
    for path in files:
        console.wrote(path)
    return 0


def _sum_up(found: Cleaned) -> None:
    figures = found.as_dict()
    moved, acceleration = figures["moved_mm"], figures["acceleration"]
    say(
        f"{len(found.motion.frames)} frames by {found.settings.filter} at "
        f"{found.settings.smooth_hz:g} Hz: points moved {shown(moved['mean'])} mm, "
        f"at most {shown(moved['max'])} mm; acceleration {shown(acceleration['raw'])} to "
        f"{shown(acceleration['clean'])} m/s²"
    )
    if figures["filled_frames"]:
        say(f"lost frames filled: {', '.join(spans(figures['filled_frames']))}")
    feet, keys = figures["feet"], figures["keys"]
    if feet:
        before, after = feet["slide_mm"]["before"], feet["slide_mm"]["after"]
        say(
            f"{len(feet['contacts'])} contacts with the floor: feet slid by "
            f"{shown(before['mean'])} mm, at most {shown(before['max'])} mm; now by "
            f"{shown(after['mean'])} mm, at most {shown(after['max'])} mm"
        )
    if keys:
        say(
            f"keys: {keys['kept']} of {keys['of']}, which cost at most "
            f"{shown(keys['error_mm']['max'])} mm and {shown(keys['error_deg']['max'])} degrees"
        )
