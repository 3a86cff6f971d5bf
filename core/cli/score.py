"""``score``: the error of a motion against a reference."""

import argparse
from pathlib import Path

from ..motion.export_request import Exporter
from ..motion.point_track import read_point_track
from ..motion.scoring import Score, Spread, aligned_in_time, aligned_rigidly, score
from ..results.report import write_report
from .arguments import frame_range
from .console import say
from .numbers import shown

EXAMPLE = "silhouette-mocap score out/walk/motion.npz sample_scenes/walk/truth.npz"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    parser.add_argument("prediction", type=Path, metavar="PREDICTION", help=".npz or .trc")
    parser.add_argument("reference", type=Path, metavar="REFERENCE", help=".npz or .trc")
    parser.add_argument(
        "--align", type=_alignments, default=frozenset(), metavar="time,rigid",
        help="first shift the prediction in time, or turn and move it as a whole, to fit best",
    )  # fmt: skip
    parser.add_argument(
        "--frames", type=frame_range, default=(None, None), metavar="A:B",
        help="only frames A to B of the reference, inclusive",
    )  # fmt: skip
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the numbers there too")


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Aligns, scores and prints."""
    prediction = read_point_track(arguments.prediction)
    reference = read_point_track(arguments.reference)
    first, last = arguments.frames
    reference = reference.between(
        reference.frames.min() if first is None else first,
        reference.frames.max() if last is None else last,
    )
    rigid = "rigid" in arguments.align
    if "time" in arguments.align:
        prediction = aligned_in_time(reference, prediction, rigid)
    if rigid:
        prediction = aligned_rigidly(reference, prediction)
    result = score(reference, prediction)
    _print(result)
    if arguments.json:
        write_report(arguments.json, result.as_dict())
    return 0


def _alignments(text: str) -> frozenset[str]:
    words = frozenset(text.split(","))
    if not words <= {"time", "rigid"}:
        raise argparse.ArgumentTypeError(f"expected time, rigid or time,rigid, got {text!r}")
    return words


def _print(result: Score) -> None:
    say(
        f"{result.frames} frames, {result.missing_frames} missing, {result.lost_frames} lost, "
        f"worst frame {result.worst_frame}"
    )
    space = {"bone": "bones'", "pelvis": "pelvis'", "none": "no"}[result.offset_space]
    say(f"{'error, mm':<34}{'mean':>8}{'median':>8}{'p95':>8}{'max':>8}")
    for name, spread in (
        ("absolute", result.absolute),
        ("about the root", result.root),
        (f"offsets removed ({space} space)", result.offset_removed),
    ):
        say(f"  {name:<32}{_row(spread)}")
    judged = shown(result.offset_frames_absolute)
    say(f"  absolute on the frames that offset removal judges: {judged}")
    say(
        f"limbs lost {result.limb_losses} times, in {result.frames_with_a_lost_limb} frames; "
        f"jitter {shown(result.jitter, 2)} mm/frame²"
    )
    for name, point in result.points.items():
        say(f"  {name:<32}{_row(point.error)}  offset removed {shown(point.offset_removed)}")


def _row(spread: Spread) -> str:
    values = (spread.mean, spread.median, spread.p95, spread.max)
    return "".join(f"{shown(value):>8}" for value in values)
