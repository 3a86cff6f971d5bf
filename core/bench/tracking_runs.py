"""Tracking a recording, and what the track is worth."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..fitting.contour import ContourSettings, ContourTracker
from ..fitting.contour_descent import DescentSettings
from ..fitting.limb_search import LimbSettings
from ..fitting.search import Search
from ..fitting.second_look import Course, looked_again
from ..fitting.tracker import EvaluatorFactory, Past, PoseFit, Tally, Tracker
from ..fitting.tracking import FrameFit, History, track
from ..motion.motion import Motion
from ..motion.point_track import PointTrack
from ..motion.recording import recorded
from ..motion.scoring import Score, score
from ..rendering.choice import MakeEvaluator
from ..rendering.detail import with_level_for
from ..silhouettes.silhouette import Silhouette
from .disturbances.recording import Recording
from .tracking_takes import Beginning, native_choice, truth_of

MakeTracker = Callable[[Body, tuple[Camera, ...], EvaluatorFactory], Tracker]
Advance = Callable[[int], None]
"""Told the number of each frame that is done."""


@dataclass(frozen=True, eq=False)
class Variant:
    """A way to track.

    Attributes:
        name: in tables.
        make: the tracker of a body in cameras.
        second_look: whether doubtful stretches are tracked from the other end, too.
    """

    name: str
    make: MakeTracker
    second_look: bool = True


@dataclass(frozen=True, eq=False)
class Track:
    """A recording as it was tracked, T frames.

    Attributes:
        motion: poses, points and what the tracker thinks of them.
        score: against the truth.
        errors: (T, 14) mm from the truth, absolute.
        seconds: (T,) of each fit.
        evaluations: (T,) candidates that were drawn.
    """

    motion: Motion
    score: Score
    errors: np.ndarray
    seconds: np.ndarray
    evaluations: np.ndarray


def tracked(
    recording: Recording,
    start: Beginning,
    variant: Variant,
    advance: Advance,
    make_evaluator: MakeEvaluator | None = None,
) -> Track:
    """The recording tracked from ``start`` on, forward to its end and backward to its begin.

    Args:
        recording: what is tracked.
        start: the initial pose.
        variant: how.
        advance: told of each frame.
        make_evaluator: what draws; None for what fits draw with.
    """
    found_by_frame = {}
    for fit in take_fits(recording, start, variant, make_evaluator or native_choice()):
        if fit.frame not in found_by_frame:
            advance(fit.frame)
        found_by_frame[fit.frame] = fit
    fits = [found_by_frame[frame] for frame in sorted(found_by_frame)]
    names = [camera.name for camera in recording.cameras]
    motion = recorded(fits, start.body, names, recording.fps)
    truth = truth_of(recording)
    found = PointTrack(motion.point_names, motion.frames, motion.points)
    return Track(
        motion=motion,
        score=score(truth, found),
        errors=_errors(recording, motion),
        seconds=np.array([fit.seconds for fit in fits]),
        evaluations=np.array([fit.tally.evaluated for fit in fits]),
    )


def take_fits(
    recording: Recording, start: Beginning, variant: Variant, make_evaluator: MakeEvaluator
) -> Iterator[FrameFit]:
    """The fits of all frames, in the order in which a fit of the take finds them.

    Those that a second look changes come once more.
    """
    make = with_level_for(start.pose, make_evaluator)
    tracker = variant.make(start.body, recording.cameras, make)
    after = [frame for frame in recording.frames if frame >= start.frame]
    before = [frame for frame in reversed(recording.frames) if frame < start.frame]

    def read(frames: Iterable[int]) -> Iterator[tuple[int, tuple[Silhouette, ...]]]:
        return ((frame, recording.silhouettes(frame)) for frame in frames)

    for frames in after, before:
        fits = []
        for fit in track(tracker, History(start.pose), read(frames)):
            fits.append(fit)
            yield fit
        if fits and variant.second_look:
            for changed in looked_again(tracker, Course(fits, float(recording.fps)), read):
                yield from changed


def _errors(recording: Recording, motion: Motion) -> np.ndarray:
    truth = np.stack([recording.points(frame) for frame in motion.frames.tolist()])
    return 1000 * np.linalg.norm(motion.points - truth, axis=2)


class HoldLast:
    """The tracker that does nothing: every frame's pose is the last one's."""

    def __init__(self, body: Body, cameras: tuple[Camera, ...], make_evaluator: EvaluatorFactory):
        self.evaluator = make_evaluator(body, cameras)

    def fit(self, silhouettes, past: Past) -> PoseFit:
        """The last pose (D,), whatever the silhouettes show."""
        return PoseFit(past.last, 0, Tally())


DEFAULT = Variant("contour", Search("contour").made)
BASELINES = (
    Variant("hierarchical", Search("hierarchical").made),
    Variant("hold the first pose", HoldLast),
)


def ablations() -> tuple[Variant, ...]:
    """The default tracker with one of its parts off at a time."""
    return (
        Variant("no second look", Search("contour").made, second_look=False),
        Variant("no limb is sought again", _contour(limbs=None)),
        Variant("limbs never sought everywhere", _contour(limbs=LimbSettings(everywhere=0))),
        Variant("all views trusted alike", _contour(views_weighed=False)),
        Variant("no rest prior where ends are compared", _contour(prior_share=0.0)),
        Variant("no rest prior in descents", _contour(descent=DescentSettings(rest=0.0))),
        Variant("no normals in descents", _contour(descent=DescentSettings(turn_m=0.0))),
        Variant("descents reach 6 cm from the start", _contour(reaches_m=(0.06, 0.06))),
    )


def _contour(**changes) -> MakeTracker:
    return partial(ContourTracker, settings=ContourSettings(**changes))
