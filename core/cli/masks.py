"""``masks``: silhouettes from footage, with a quality figure per view."""

import argparse
from pathlib import Path

from ..motion.export_request import Exporter
from ..take.extraction import MaskQuality, write_take_masks
from ..take.views import open_views
from .arguments import add_cameras_and_frames, add_progress, add_take, shown_progress, taken
from .console import say

NAME = "masks"
SUMMARY = "write the silhouettes of a take as masks and tell how sound they look"
EXAMPLE = "silhouette-mocap masks sample_scenes/balance/take.toml --out out/balance/masks"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)
    parser.add_argument(
        "--out", type=Path, required=True, metavar="DIR", help="folder for CAMERA/000000.png …"
    )
    add_cameras_and_frames(parser)
    add_progress(parser)


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Writes the masks and prints one line per camera."""
    views = open_views(taken(arguments), arguments.without, arguments.frames)
    qualities = write_take_masks(views, arguments.out, shown_progress(arguments))
    say(
        f"{'camera':<16}{'frames':>8}{'empty':>8}{'flicker':>10}{'specks':>8}{'holes':>8}{'edge':>8}"
    )
    for quality in qualities:
        say(_row(quality))
    say(f"wrote {arguments.out}/CAMERA/FRAME.png")
    return 0


def _row(quality: MaskQuality) -> str:
    return (
        f"{quality.camera:<16}{quality.frames:>8}{quality.empty:>8}{quality.flicker:>10.1%}"
        f"{quality.specks:>8.1f}{quality.holes:>8.1f}{quality.at_edge:>8.0%}"
    )
