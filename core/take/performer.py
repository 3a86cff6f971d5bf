"""The performer's body and height, as far as the take tells them."""

from pathlib import Path

from ..body.body import Body
from ..body.file import read_body
from ..body.kinematics import rest_height
from ..body.templates import template
from ..initialisation.first_pose import PoseRequest
from ..initialisation.plausibility import check_height
from .take import Performer, Take


def performer_body(performer: Performer) -> Body:
    """The body file that the take names, or its template, unscaled.

    Raises:
        MocapError: the file cannot be read.
    """
    wanted = performer.body
    return read_body(wanted) if isinstance(wanted, Path) else template(wanted)


def known_height(performer: Performer, body: Body) -> float | None:
    """Metres, as given or of a ``body`` read from a file; None where the silhouettes must tell.

    Raises:
        MocapError: the file's body has a height that nobody has.
    """
    if performer.height_m is None and isinstance(performer.body, Path):
        height = rest_height(body)
        check_height(height, performer.body)
        return height
    return performer.height_m


def pose_request(take: Take, body: Body) -> PoseRequest:
    """What is known of the initial pose of ``take``; a body read from a file keeps its shape.

    Raises:
        MocapError: as `known_height`.
    """
    return PoseRequest(
        kind=take.initial_pose.kind,
        height_m=known_height(take.performer, body),
        floor=take.floor,
        own_shape=not isinstance(take.performer.body, Path),
    )
