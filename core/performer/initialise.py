"""From a take to the performer's own body: the whole story on one screen."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path

from ..beginning import Beginning, take_begun
from ..body.rig_file import RigFile
from ..errors import MocapError
from ..files import made_folder
from ..initialisation.contour_rules.from_frames import ContourSettings, contour_skeleton
from ..initialisation.contour_rules.skeleton import ContourSkeleton
from ..initialisation.further_frames import straight_joints
from ..progress import Progress
from ..rendering.choice import Choice
from ..results.writing import MOTION
from ..take.performer import performer_body
from ..take.take import Take
from ..take.views import narrowed, open_views
from .files import Performer, write_performer
from .shapes import first_shape, shape_from_track


@dataclass(frozen=True)
class InitialiseRequest:
    """What to look at, and where to write it.

    Attributes:
        out: the folder of the result; made where it is missing.
        further: first and last frame that are tracked for limbs that bend, None for an end of the
            take; None for no more than the initial pose.
        without: names of cameras to leave out.
        shield: entered while files are written, so that nothing interrupts it.
    """

    out: Path
    further: tuple[int | None, int | None] | None = None
    without: tuple[str, ...] = ()
    shield: Callable[[], AbstractContextManager] = nullcontext


def initialise(
    take: Take, request: InitialiseRequest, progress: Progress
) -> tuple[Performer, tuple[Path, ...]]:
    """The performer's body and measures, and the files that tell of them.

    Raises:
        MocapError: the take, its calibration or its footage is at fault, its body is fitted
            already, or the folder holds a fit, which its body belongs to.
    """
    if isinstance(take.performer.body, Path):
        raise MocapError(
            f"names a body that is fitted already, {take.performer.body.name}",
            'name a template under [performer], such as body = "performer"', file=take.path,
        )  # fmt: skip
    if isinstance(take.performer.body, RigFile):
        raise MocapError(
            f"names a rig, {take.performer.body.path.name}, which keeps its own shape",
            'name a template under [performer], such as body = "performer"', file=take.path,
        )  # fmt: skip
    if (request.out / MOTION).exists():
        raise MocapError(
            "holds a fit, whose body would be replaced", "give another folder", file=request.out
        )
    views = open_views(take, request.without, (None, None), progress)
    further = request.further and narrowed(take, views.frames, request.further)
    choice = Choice(None, progress.warn)
    begin = take_begun(take, performer_body(take.performer), views, choice, progress)
    if further is None:
        shown = first_shape(begin)
    else:
        shown = shape_from_track(take, begin, further, choice, progress)
    settings = ContourSettings(floor=take.floor, height_m=take.performer.height_m)
    skeleton, told = _skeleton(take, begin, settings)
    for note in told:
        progress.note(note)
    performer = Performer(
        shape=shown.shape,
        body=shown.body,
        skeleton=skeleton,
        straight=straight_joints(shown.body, shown.poses),
        notes=(*begin.notes, *shown.notes, *told),
    )
    made_folder(request.out)
    with request.shield():
        return performer, write_performer(take, begin, performer, settings, request.out)


def _skeleton(
    take: Take, begin: Beginning, settings: ContourSettings
) -> tuple[ContourSkeleton | None, tuple[str, ...]]:
    """What the contours of the initial pose show, and what a user should know of it."""
    kind = take.initial_pose.kind
    if kind is None:
        return None, ("no initial pose is given, so its contour is not read",)
    colours = None
    if take.footage.video is not None:
        colours = tuple(begin.views.pictures(frame) for frame in begin.seen)
    frames = tuple(begin.seen.values())
    try:
        skeleton = contour_skeleton(begin.views.cameras, frames, kind, colours, settings)
    except MocapError as error:
        return None, (f"{error.problem}; the body comes from the silhouettes as a whole",)
    return skeleton, skeleton.notes
