"""``fit``: from a take to a motion and its files."""

import argparse
from dataclasses import replace
from pathlib import Path

from ..fitting.search import TRACKERS
from ..motion.export_request import FORMATS, Exporter
from ..pipeline import FitRequest, fit
from ..rendering.choice import EVALUATORS
from ..results.exporting import check_formats, export
from ..results.folder import occupied
from ..results.writing import FitResult
from .arguments import add_cameras_and_frames, add_take, format_list, taken
from .console import say
from .interrupts import shielded
from .numbers import shown

EXAMPLE = "silhouette-mocap fit sample_scenes/walk/take.toml --out out/walk --export blend,bvh"
_DONE, _LOST = 0, 3


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)
    parser.add_argument(
        "--out", type=Path, required=True, metavar="DIR", help="folder for the result"
    )
    parser.add_argument(
        "--tracker", choices=TRACKERS, help="how to search (default: what the take says)"
    )
    parser.add_argument(
        "--evaluator", choices=tuple(EVALUATORS),
        help="what renders and compares silhouettes: native (the processor; the default), "
        "opengl (a graphics processor), or reference (by definition, slow)",
    )  # fmt: skip
    add_cameras_and_frames(parser)
    parser.add_argument(
        "--lock", type=Path, metavar="LOCKS.npz",
        help="poses that are given: the motion goes through them (default: what the take says)",
    )  # fmt: skip
    parser.add_argument(
        "--export", type=format_list, metavar="LIST",
        help=f"some of {','.join(FORMATS)}, or none (default: what the take says)",
    )  # fmt: skip
    parser.add_argument(
        "--resume", action="store_true",
        help="go on after the last finished frame of a fit that was cut off",
    )  # fmt: skip
    parser.add_argument("--strict", action="store_true", help="exit with 3 when frames were lost")


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Fits, exports and sums up."""
    take = taken(arguments)
    take = replace(take, locks=arguments.lock or take.locks)
    formats = take.exports if arguments.export is None else arguments.export
    check_formats(formats, exporter)
    request = FitRequest(
        out=arguments.out,
        search=replace(take.search, tracker=arguments.tracker or take.search.tracker),
        evaluator=arguments.evaluator,
        frames=arguments.frames,
        without=tuple(arguments.without),
        resume=arguments.resume,
        shield=shielded,
        read_rig=arguments.read_rig,
    )
    with occupied(arguments.out):
        result = fit(take, request, arguments.console)
        files = result.files + export(take, arguments.out, formats, exporter)
    _sum_up(result)
    for path in files:
        arguments.console.wrote(path)
    if result.report["lost_frames"]:
        arguments.console.lost(result.report["lost_frames"])
    return _LOST if arguments.strict and result.report["lost_frames"] else _DONE


def _sum_up(result: FitResult) -> None:
    report = result.report
    frames = len(report["frames"])
    seconds, evaluations = (
        sum(report[f"{name}_per_frame"]) / frames for name in ("seconds", "evaluations")
    )
    say(
        f"{frames} frames, IoU {shown(report['iou'], 3)}, "
        f"contour {shown(report['contour_px'], 2)} px, "
        f"{seconds:.2f} s and {evaluations:.0f} evaluations per frame"
    )
    error = report["error_mm"]
    if error:
        mean = error["offset_removed"]["mean"]
        removed = f"{shown(mean)} mm after removing constant offsets"
        if mean is None:
            removed = "too few frames to remove constant offsets"
        say(f"error to the truth: {shown(error['absolute']['mean'])} mm, {removed}")
