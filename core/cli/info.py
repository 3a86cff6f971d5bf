"""``info``: everything that ``fit`` will meet, looked at beforehand."""

import argparse
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from ..body.file import read_body
from ..body.templates import template
from ..cameras.arrangement import millimetres_per_pixel
from ..cameras.camera import Camera
from ..errors import MocapError
from ..initialisation.standing import body_centre
from ..motion.export_request import Exporter
from ..native.library import load
from ..pipeline import initial_frames
from ..results.exporting import check_formats
from ..take.take import Take
from ..take.views import View, Views, open_views
from .arguments import add_take, taken
from .console import say

EXAMPLE = "silhouette-mocap info sample_scenes/walk/take.toml"
_DONE, _INPUT = 0, 2


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The words of the command."""
    add_take(parser)


def run(arguments: argparse.Namespace, exporter: Exporter | None) -> int:
    """Checks part by part; a fault in one does not hide those in others."""
    take = taken(arguments)
    _tell_take(take)
    faults: list[MocapError] = []

    @contextmanager
    def noted() -> Iterator[None]:
        try:
            yield
        except MocapError as error:
            faults.append(error)

    with noted():
        views = _opened(take, faults)
        centre = None
        with noted():
            centre = _performer_place(take, views)
        _tell_cameras(views, centre)
        for view in views.views:
            with noted():
                _tell_footage(view, views.frames)
        for note in views.notes:
            say(f"note: {note}")
    for check in _further_checks(take, exporter):
        with noted():
            check()
    for fault in faults:
        arguments.console.fault(fault, _INPUT)
    say("something is missing" if faults else "all that fit needs is there")
    return _INPUT if faults else _DONE


def _opened(take: Take, faults: list[MocapError]) -> Views:
    """The views of the cameras without a fault; ``faults`` gets one for each of the others.

    Raises:
        MocapError: a fault of another kind.
    """
    without: list[str] = []
    while True:
        try:
            return open_views(take, without)
        except MocapError as error:
            if error.camera is None or error.camera in without:
                raise
            faults.append(error)
            without.append(error.camera)


def _tell_take(take: Take) -> None:
    span = "all" if take.frames is None else f"{take.frames[0]} to {take.frames[1]}"
    pose = take.initial_pose.frames
    shown = "the first frame" if pose is None else f"frames {pose[0]} to {pose[1]}"
    height = take.performer.height_m
    tall = "height from the silhouettes" if height is None else f"{height:.2f} m tall"
    say(f"take        {take.name}, {float(take.fps):.5g} frames per second, frames {span}")
    say(f"initial     pose {take.initial_pose.kind} in {shown}")
    say(f"performer   {take.performer.body}, {tall}; floor at {take.floor:g} m")
    say(f"tracker     {take.search.tracker}, {take.search.setting}")
    say(f"exports     {', '.join(take.exports) or 'none'}")
    truth = take.path.parent / "truth.npz"
    say(f"truth       {truth if truth.exists() else 'none beside the take'}")


def _performer_place(take: Take, views: Views) -> np.ndarray:
    """(3,) world metres of the performer's middle in the initial pose."""
    start = initial_frames(take, views.frames)[0]
    return body_centre(views.cameras, views.silhouettes(start))


def _tell_cameras(views: Views, centre: np.ndarray | None) -> None:
    say(f"{'camera':<16}{'footage px':>14}{'lens':>12}{'distance m':>12}{'mm per px':>11}")
    for view in views.views:
        source = view.undistortion.source
        lens = "pinhole" if source.is_pinhole else "fisheye" if source.fisheye else "distorted"
        size = f"{source.size[0]} x {source.size[1]}"
        say(f"{source.name:<16}{size:>14}{lens:>12}{_distance_and_scale(view.camera, centre)}")


def _distance_and_scale(camera: Camera, centre: np.ndarray | None) -> str:
    if centre is None or camera.depths(centre) <= 0:
        return f"{'?':>12}{'?':>11}"
    distance = np.linalg.norm(camera.centre - centre)
    return f"{distance:>12.2f}{millimetres_per_pixel(camera, centre):>11.1f}"


def _tell_footage(view: View, frames: tuple[int, int]) -> None:
    footage = view.source.footage
    there = footage.frames
    rate = "" if footage.fps is None else f", {footage.fps:.5g} frames per second"
    say(f"footage     {footage.camera}: frames {there[0]} to {there[-1]}{rate}, {view.place}")
    for frame in range(frames[0], frames[1] + 1):
        footage.picture(frame)


def _further_checks(take: Take, exporter: Exporter | None) -> tuple[Callable[[], object], ...]:
    body = take.performer.body
    return (
        lambda: read_body(body) if isinstance(body, Path) else template(body),
        load,
        lambda: check_formats(take.exports, exporter),
    )
