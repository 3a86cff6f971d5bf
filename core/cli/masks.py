"""``masks``: silhouettes from footage, with a quality figure per view."""

import argparse
import math
from pathlib import Path

from ..motion.export_request import Exporter
from ..silhouettes.quality import MaskQuality
from ..take.extraction import write_take_masks
from ..take.views import open_views
from .arguments import add_cameras_and_frames, add_take, taken
from .console import say

EXAMPLE = "silhouette-mocap masks sample_scenes/balance/take_footage.toml --out out/balance/masks"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)
    parser.add_argument(
        "--out", type=Path, required=True, metavar="DIR", help="folder for CAMERA/000000.png …"
    )
    add_cameras_and_frames(parser)


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Writes the masks and prints one line per camera."""
    console = arguments.console
    views = open_views(taken(arguments), arguments.without, arguments.frames, console)
    qualities = write_take_masks(views, arguments.out, console)
    say(
        f"{'camera':<16}{'frames':>8}{'empty':>8}{'coverage':>10}{'specks':>8}{'contrast':>10}"
        f"{'flicker':>9}"
    )
    for camera, quality in qualities.items():
        say(f"{camera:<16}{_figures(quality)}")
    say(f"wrote {arguments.out}/CAMERA/FRAME.png")
    return 0


def _figures(quality: MaskQuality) -> str:
    contrast = "-" if math.isnan(quality.contrast) else f"{quality.contrast:.0f}"
    return (
        f"{quality.frames:>8}{quality.empty:>8}{quality.coverage:>10.1%}{quality.specks:>8.1f}"
        f"{contrast:>10}{quality.flicker:>9.1%}"
    )
