"""The performer's body and height, as far as the take tells them."""

from pathlib import Path

from ..body.body import Body
from ..body.file import read_body
from ..body.kinematics import rest_height
from ..body.rig_file import RigFile, RigReader
from ..body.templates import template
from ..errors import MocapError
from ..initialisation.first_pose import PoseRequest
from ..initialisation.plausibility import check_height
from .take import Performer, Take


def performer_body(performer: Performer, read_rig: RigReader | None = None) -> Body:
    """The body file or armature that the take names, or its template, unscaled.

    ``read_rig`` reads armatures; None where there is no Blender.

    Raises:
        MocapError: the file cannot be read.
    """
    wanted = performer.body
    if isinstance(wanted, RigFile):
        if read_rig is None:
            raise MocapError(
                "can be read only with Blender", "pip install silhouette-mocap[blender]",
                file=wanted.path,
            )  # fmt: skip
        return read_rig(wanted)
    return read_body(wanted) if isinstance(wanted, Path) else template(wanted)


def known_height(performer: Performer, body: Body) -> float | None:
    """Metres, as given or of a ``body`` read from a file; None where the silhouettes must tell.

    Raises:
        MocapError: the body of a body.npz has a height that nobody has.
    """
    if performer.measured:
        return None
    if performer.height_m is None and isinstance(performer.body, RigFile):
        # of whatever size it was made
        return rest_height(body)
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
        own_shape=isinstance(take.performer.body, str),
    )
