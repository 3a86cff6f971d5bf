"""Everything that a fit of a take will meet, looked at beforehand, faults and all."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

from ..body.body import Body
from ..body.rig_file import RigReader
from ..cameras.arrangement import opposite_pairs
from ..errors import MocapError
from ..initialisation.standing import body_centre, standing_height
from ..native.library import load
from ..progress import SILENCE, Progress
from ..rendering.choice import MakeEvaluator
from ..silhouettes.silhouette import Silhouette
from ..take.first_look import check_first_look, shown
from ..take.performer import known_height, performer_body
from ..take.take import Take
from ..take.views import TooFewCameras, Views, open_views
from .camera_facts import CameraFacts, Performer, camera_facts, units_in_words
from .estimate import Estimate, Trial, estimated
from .footage_check import FootageFacts, checked_footage

_STEPS = 3
"""First pictures, footage, trial."""


@dataclass(frozen=True)
class CheckRequest:
    """How to check.

    Attributes:
        initial_frames: gives the frames that the initial pose is sought in, of a take and its
            first and last frame.
        make_evaluator: renders and compares in the trial.
        further: more checks, which raise MocapError.
        seconds: how long to read footage.
        progress: told of each step.
        read_rig: reads armatures; None where there is no Blender.
    """

    initial_frames: Callable[[Take, tuple[int, int]], Sequence[int]]
    make_evaluator: MakeEvaluator
    further: Sequence[Callable[[], object]] = ()
    seconds: float = 8.0
    progress: Progress = SILENCE
    read_rig: RigReader | None = None


@dataclass(frozen=True, eq=False)
class TakeCheck:
    """What is known of a take.

    Attributes:
        take: the take.
        frames: first and last frame, inclusive; None where that cannot be told.
        units: of the calibration, in words; empty where it cannot be read.
        cameras: those without a fault of their own.
        opposite: pairs of their names that face each other.
        footage: theirs.
        performer: None where the silhouettes do not tell.
        estimate: None where something is at fault.
        notes: sentences that the user should see.
        faults: what keeps a fit from running; empty where nothing does.
    """

    take: Take
    frames: tuple[int, int] | None = None
    units: str = ""
    cameras: tuple[CameraFacts, ...] = ()
    opposite: tuple[tuple[str, str], ...] = ()
    footage: tuple[FootageFacts, ...] = ()
    performer: Performer | None = None
    estimate: Estimate | None = None
    notes: tuple[str, ...] = ()
    faults: tuple[MocapError, ...] = ()


class _Faults:
    """Faults met so far, each once."""

    def __init__(self):
        self._met: dict[str, MocapError] = {}

    def add(self, fault: MocapError) -> None:
        self._met.setdefault(str(fault), fault)

    @contextmanager
    def noted(self) -> Iterator[None]:
        try:
            yield
        except MocapError as error:
            self.add(error)

    def __len__(self) -> int:
        return len(self._met)

    def met(self) -> tuple[MocapError, ...]:
        return tuple(self._met.values())


def checked(take: Take, request: CheckRequest) -> TakeCheck:
    """All that can be found out about ``take``; a fault in one part does not hide others."""
    faults, found = _Faults(), TakeCheck(take)
    with faults.noted():
        found = _checked_views(take, request, faults)
    for check in (
        lambda: performer_body(take.performer, request.read_rig),
        load,
        *request.further,
    ):
        with faults.noted():
            check()
    return replace(found, faults=faults.met())


def _checked_views(take: Take, request: CheckRequest, faults: _Faults) -> TakeCheck:
    views, progress = _opened(take, faults, request.progress), request.progress
    if views is None:
        return TakeCheck(take)
    progress.begin("check", _STEPS)
    units = units_in_words(views.calibration, take.cameras.units)
    found = TakeCheck(take, views.frames, units, notes=views.notes)
    start, silhouettes, performer, body = 0, (), None, None
    with faults.noted():
        begin = request.initial_frames(take, views.frames)
        views, seen = views.reduced_and_seen(begin)
        start, silhouettes = next(iter(shown(take, seen).items()))
        found = replace(found, notes=(*found.notes, *check_first_look(take, views, seen)))
        body = performer_body(take.performer, request.read_rig)
        performer = _performer(take, body, views, silhouettes)
    progress.advance(None)
    footage = checked_footage(views, request.seconds)
    progress.advance(None)
    for fault in footage.faults:
        faults.add(fault)
    estimate = None
    if body is not None and performer is not None and not faults:
        trial = Trial(take, views, start, silhouettes, performer, request.make_evaluator, body)
        with faults.noted():
            estimate = estimated(trial, footage.seconds)
    progress.advance(None)
    return replace(
        found,
        cameras=tuple(camera_facts(view, performer, take.floor) for view in views.views),
        opposite=tuple(opposite_pairs(views.cameras)),
        footage=footage.cameras,
        performer=performer,
        estimate=estimate,
    )


def _opened(take: Take, faults: _Faults, progress: Progress) -> Views | None:
    """The views of the cameras without a fault; ``faults`` gets one for each of the others.

    None where too few are left.

    Raises:
        MocapError: a fault of another kind.
    """
    without: list[str] = []
    while True:
        try:
            return open_views(take, without, progress=progress)
        except TooFewCameras:
            return None
        except MocapError as error:
            if error.camera is None or error.camera in without:
                raise
            faults.add(error)
            without.append(error.camera)


def _performer(
    take: Take, body: Body, views: Views, silhouettes: tuple[Silhouette, ...]
) -> Performer:
    centre = body_centre(views.cameras, silhouettes)
    height = known_height(take.performer, body)
    if height is None:
        height = standing_height(views.cameras, silhouettes, centre, take.floor)
    return Performer(centre, height)
