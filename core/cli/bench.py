"""``bench``: how fast and how good this is, beside published figures and frozen baselines."""

import argparse
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from ..bench import skeleton, tracking
from ..bench.energy import QUICK, EnergySettings, energy_figures
from ..bench.energy_files import write_energy_files
from ..bench.energy_report import as_dict
from ..bench.markdown import whole_report
from ..bench.prototypes import are_in
from ..bench.shape import shape_figures
from ..bench.shape_report import as_dict as shape_as_dict
from ..bench.shape_report import shape_report, write_shape_files
from ..bench.skeleton import SkeletonSettings, skeleton_figures
from ..bench.skeleton_report import as_dict as skeleton_as_dict
from ..bench.skeleton_report import skeleton_report, write_skeleton_files
from ..bench.tracking import TrackingSettings, tracking_figures
from ..bench.tracking_files import report_text, write_tracking_files
from ..bench.tracking_report import as_dict as tracking_as_dict
from ..errors import MocapError
from ..files import check_writable, made_folder
from ..motion.export_request import Exporter
from ..results.report import write_report
from .console import say

EXAMPLE = "silhouette-mocap bench tracking --json tracking.json --out out/bench"
Measured = tuple[str, dict, Callable[[Path], list[Path]]]
"""Tables, figures for JSON, and what writes tables and plots into a folder."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    parser.add_argument(
        "topic", choices=tuple(_TOPICS),
        help="energy: Tables 1 and 2 of the 2003 paper; tracking: errors and speed of the "
        "trackers with takes whose motion is known, undisturbed and disturbed; shape: the "
        "performer's own shape against the template scaled as a whole, with such takes; skeleton: "
        "errors of the joints that the contour shows in the initial pose",
    )  # fmt: skip
    parser.add_argument(
        "takes", nargs="*", type=Path, metavar="TAKE.toml",
        help="for tracking and shape: takes with a truth.npz beside each "
        "(default: the sample walk)",
    )  # fmt: skip
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all figures there")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="write tables (Markdown) and plots (SVG, PNG) there"
    )
    parser.add_argument(
        "--prototypes", type=Path, metavar="DIR",
        help="for energy: frozen baselines to compare with, too",
    )  # fmt: skip
    parser.add_argument(
        "--quick", action="store_true",
        help="for a first look: one resolution and few turns, or few frames and disturbances",
    )  # fmt: skip


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Measures, prints and writes."""
    _check(arguments)
    # before minutes of work
    if arguments.out is not None:
        made_folder(arguments.out)
    if arguments.json is not None:
        check_writable(arguments.json)
    text, figures, write_files = _TOPICS[arguments.topic](arguments)
    say(text)
    if arguments.json is not None:
        write_report(arguments.json, figures)
        arguments.console.wrote(arguments.json)
    if arguments.out is not None:
        for path in write_files(arguments.out):
            arguments.console.wrote(path)
    return 0


def _energy(arguments: argparse.Namespace) -> Measured:
    settings = QUICK if arguments.quick else EnergySettings()
    settings = replace(settings, prototypes=arguments.prototypes)
    figures = energy_figures(settings, arguments.console)
    return whole_report(figures), as_dict(figures), partial(write_energy_files, figures)


def _tracking(arguments: argparse.Namespace) -> Measured:
    settings = tracking.QUICK if arguments.quick else TrackingSettings()
    settings = replace(settings, takes=tuple(arguments.takes) or settings.takes)
    figures = tracking_figures(settings, arguments.console)
    return report_text(figures), tracking_as_dict(figures), partial(write_tracking_files, figures)


def _skeleton(arguments: argparse.Namespace) -> Measured:
    settings = skeleton.QUICK if arguments.quick else SkeletonSettings()
    figures = skeleton_figures(settings, arguments.console)
    return (
        skeleton_report(figures),
        skeleton_as_dict(figures),
        partial(write_skeleton_files, figures),
    )


def _shape(arguments: argparse.Namespace) -> Measured:
    takes = tuple(arguments.takes) or TrackingSettings().takes
    figures = shape_figures(takes, arguments.console)
    return shape_report(figures), shape_as_dict(figures), partial(write_shape_files, figures)


_TOPICS: dict[str, Callable[[argparse.Namespace], Measured]] = {
    "energy": _energy,
    "tracking": _tracking,
    "shape": _shape,
    "skeleton": _skeleton,
}


_WITH_TAKES = ("tracking", "shape")


def _check(arguments: argparse.Namespace) -> None:
    if arguments.topic not in _WITH_TAKES and arguments.takes:
        raise MocapError(
            f"bench {arguments.topic} needs no take", "leave it out", file=arguments.takes[0]
        )
    if arguments.prototypes is None:
        return
    if arguments.topic != "energy":
        raise MocapError("--prototypes belongs to bench energy", "leave it out")
    if not are_in(arguments.prototypes):
        raise MocapError(
            "does not hold the prototypes", "check the path", file=arguments.prototypes
        )
