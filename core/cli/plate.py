"""``plate``: pictures of the empty scene, made from footage that never shows it empty."""

import argparse

from ..cameras.calibration import CalibrationSettings, read_camera_names
from ..errors import MocapError
from ..motion.export_request import Exporter
from ..silhouettes.plate_making import Box
from ..take.extraction import PlateRequest, make_plate
from .arguments import add_cameras_and_frames, add_progress, add_take, shown_progress, taken
from .console import say

NAME = "plate"
SUMMARY = "make a plate of the empty scene for each camera from footage and further stills"
EXAMPLE = (
    "silhouette-mocap plate take.toml --stills 'stills/{camera}.png' --box cam01=380,500,900,1800"
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)
    parser.add_argument(
        "--stills", metavar="PATTERN",
        help="a picture of each view with the performer elsewhere or absent, with {camera}",
    )  # fmt: skip
    parser.add_argument(
        "--box", type=camera_box, action="append", default=[], metavar="CAM=L,T,R,B",
        help="pixels of the footage that the performer never leaves; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--still-box", type=camera_box, action="append", default=[], metavar="CAM=L,T,R,B",
        help="where the performer is in the still; may be repeated",
    )  # fmt: skip
    add_cameras_and_frames(parser)
    add_progress(parser)


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Makes the plates one by one."""
    take = taken(arguments)
    given = CalibrationSettings(take.cameras.format, take.cameras.units, take.cameras.up)
    names = read_camera_names(take.cameras.calibration, given)
    request = PlateRequest(
        stills=arguments.stills,
        boxes=dict(arguments.box),
        still_boxes=dict(arguments.still_box),
        frames=arguments.frames,
    )
    for name in (*request.boxes, *request.still_boxes, *arguments.without):
        if name not in names:
            raise MocapError(f'there is no camera "{name}"', f"the cameras are {', '.join(names)}")
    used = [name for name in names if name not in arguments.without]
    progress = shown_progress(arguments)
    progress.begin("plate", len(used))
    written = []
    for number, name in enumerate(used):
        written.append(make_plate(take, name, request))
        progress.advance(number)
    for path in written:
        say(f"wrote {path}, made from the footage itself: check that nobody is left in it")
    return 0


def camera_box(text: str) -> tuple[str, Box]:
    """Camera and (left, top, right, bottom) px of ``CAM=L,T,R,B``."""
    camera, equals, numbers = text.rpartition("=")
    parts = numbers.split(",")
    right = equals and camera and len(parts) == 4 and all(p.strip().isdecimal() for p in parts)
    left, top, end, bottom = (int(p) for p in parts) if right else (0, 0, 0, 0)
    if not right or left >= end or top >= bottom:
        raise argparse.ArgumentTypeError(f"expected CAMERA=LEFT,TOP,RIGHT,BOTTOM, got {text!r}")
    return camera, (left, top, end, bottom)
