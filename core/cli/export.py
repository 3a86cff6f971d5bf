"""``export``: the result of a fit in further formats."""

import argparse
from pathlib import Path

from ..errors import MocapError
from ..motion.export_request import FORMATS, Exporter
from ..results.exporting import check_formats, export
from ..results.folder import occupied
from .arguments import add_take, format_list, taken

EXAMPLE = "silhouette-mocap export sample_scenes/walk/take.toml --out out/walk --export fbx,trc"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)
    parser.add_argument(
        "--out", type=Path, required=True, metavar="DIR", help="folder of the fit's result"
    )
    parser.add_argument(
        "--export", type=format_list, metavar="LIST",
        help=f"some of {','.join(FORMATS)} (default: what the take says)",
    )  # fmt: skip


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Writes the files."""
    take = taken(arguments)
    formats = take.exports if arguments.export is None else arguments.export
    if not formats:
        raise MocapError(
            "there is nothing to export, as the take names no formats", "name some with --export"
        )
    check_formats(formats, exporter)
    console = arguments.console
    console.begin("export", 1)
    with occupied(arguments.out):
        files = export(take, arguments.out, formats, exporter)
    console.advance(None)
    for path in files:
        console.wrote(path)
    return 0
