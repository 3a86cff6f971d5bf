"""``initialise``: the performer's own body, with measures and pictures to check it by."""

import argparse
from pathlib import Path

from ..body.kinematics import rest_height
from ..motion.export_request import Exporter
from ..performer.files import Performer
from ..performer.initialise import InitialiseRequest, initialise
from ..results.folder import occupied
from .arguments import add_cameras, add_take, frame_range, taken
from .console import say
from .interrupts import shielded

EXAMPLE = "silhouette-mocap initialise sample_scenes/walk/take.toml --out out/walker --frames 0:60"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)
    parser.add_argument(
        "--out", type=Path, required=True, metavar="DIR", help="folder for body.npz and the rest"
    )
    add_cameras(parser)
    parser.add_argument(
        "--frames", type=frame_range, metavar="A:B",
        help="track these frames, too, and fit the shape to those whose limbs bend most; either "
        "may be left out",
    )  # fmt: skip


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Fits the body and sums up."""
    request = InitialiseRequest(
        out=arguments.out,
        further=arguments.frames,
        without=tuple(arguments.without),
        shield=shielded,
    )
    with occupied(arguments.out):
        performer, files = initialise(taken(arguments), request, arguments.console)
    _sum_up(performer)
    for path in files:
        arguments.console.wrote(path)
    return 0


def _sum_up(performer: Performer) -> None:
    height = rest_height(performer.body)
    say(f"{height:.2f} m tall; lengths, uncertainty, and against average people of that height:")
    for length in performer.lengths:
        say(
            f"  {length.name:<12}{1000 * length.metres:>6.0f} mm ±{1000 * length.deviation:>3.0f}"
            f"{length.against:>+7.0%}"
        )
    if performer.straight:
        say(
            f"no frame bends {' or '.join(performer.straight)} by 30 degrees: where they are is "
            "the average person's; --frames A:B looks at more frames"
        )
    if performer.skeleton is not None:
        say("from the contour, mean and spread over the frames of the initial pose:")
        for name, measure in performer.skeleton.measures.items():
            words = name.replace("_", " ")
            say(f"  {words:<12}{1000 * measure.mean:>6.0f} mm ±{1000 * measure.spread:>3.0f}")
