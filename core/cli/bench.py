"""``bench``: how fast this machine is, beside published figures and frozen baselines."""

import argparse
from dataclasses import replace
from pathlib import Path

from ..bench.energy import QUICK, EnergySettings, energy_figures
from ..bench.energy_files import write_energy_files
from ..bench.energy_report import as_dict
from ..bench.markdown import whole_report
from ..bench.prototypes import are_in
from ..errors import MocapError
from ..files import check_writable, made_folder
from ..motion.export_request import Exporter
from ..results.report import write_report
from .console import say

EXAMPLE = "silhouette-mocap bench energy --json energy.json --out out/bench"
TOPICS = ("energy",)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    parser.add_argument("topic", choices=TOPICS, help="energy: Tables 1 and 2 of the 2003 paper")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all figures there")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="write tables (Markdown) and plots (SVG) there"
    )
    parser.add_argument(
        "--prototypes", type=Path, metavar="DIR", help="frozen baselines to compare with, too"
    )
    parser.add_argument(
        "--quick", action="store_true", help="one resolution and few turns, for a first look"
    )


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Measures, prints and writes."""
    _check_prototypes(arguments.prototypes)
    settings = QUICK if arguments.quick else EnergySettings()
    settings = replace(settings, prototypes=arguments.prototypes)
    # before minutes of work
    if arguments.out is not None:
        made_folder(arguments.out)
    if arguments.json is not None:
        check_writable(arguments.json)
    figures = energy_figures(settings, arguments.console)
    say(whole_report(figures))
    if arguments.json is not None:
        write_report(arguments.json, as_dict(figures))
        arguments.console.wrote(arguments.json)
    if arguments.out is not None:
        for path in write_energy_files(figures, arguments.out):
            arguments.console.wrote(path)
    return 0


def _check_prototypes(folder: Path | None) -> None:
    if folder is not None and not are_in(folder):
        raise MocapError("does not hold the prototypes", "check the path", file=folder)
