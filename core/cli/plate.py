"""``plate``: pictures of the empty scene, made from footage that never shows it empty."""

import argparse
from pathlib import Path

from ..motion.export_request import Exporter
from ..silhouettes.plate_recipe import PlateRecipe, read_plate_recipes
from ..take.extraction import make_plate
from ..take.views import camera_names, check_cameras
from .arguments import add_cameras_and_frames, add_take, taken

EXAMPLE = (
    "silhouette-mocap plate sample_scenes/balance/take_footage.toml "
    "--recipes sample_scenes/balance/plates.toml"
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)
    parser.add_argument(
        "--recipes", type=Path, metavar="FILE.toml",
        help="what helps each camera: a still with the performer elsewhere, boxes, frames",
    )  # fmt: skip
    add_cameras_and_frames(parser)


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Makes the plates one by one."""
    take = taken(arguments)
    names = camera_names(take)
    recipes = {} if arguments.recipes is None else read_plate_recipes(arguments.recipes)
    check_cameras(recipes, names, arguments.recipes or take.path)
    check_cameras(arguments.without, names, take.path)
    used = [name for name in names if name not in arguments.without]
    console = arguments.console
    console.begin("plates", len(used))
    for name in used:
        path = make_plate(take, name, recipes.get(name, PlateRecipe()), arguments.frames)
        console.advance(None)
        console.wrote(path)
    console.note("the plates are made from the footage itself: check that nobody is left in them")
    return 0
