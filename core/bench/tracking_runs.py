"""Tracking a recording, and what the track is worth."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain

import numpy as np

from ..fitting.passes import Passes, directions_from, with_contours
from ..fitting.tracking import FrameFit
from ..motion.motion import Motion
from ..motion.point_track import PointTrack
from ..motion.recording import recorded
from ..motion.scoring import Score, score
from ..rendering.choice import MakeEvaluator
from ..rendering.detail import with_level_for
from .disturbances.recording import Recording
from .tracking_takes import Beginning, native_choice, truth_of
from .tracking_variants import Variant

Advance = Callable[[int], None]
"""Told the number of each frame that is done."""


@dataclass(frozen=True, eq=False)
class Track:
    """A recording as it was tracked, T frames.

    Attributes:
        motion: poses, points and what the tracker thinks of them.
        score: against the truth.
        errors: (T, 14) mm from the truth, absolute.
        seconds: all fits and the second look took, without footage.
        evaluations: (T,) candidates that were drawn.
    """

    motion: Motion
    score: Score
    errors: np.ndarray
    seconds: float
    evaluations: np.ndarray

    @property
    def seconds_per_frame(self) -> float:
        """Their mean."""
        return self.seconds / len(self.errors)


def tracked(
    recording: Recording,
    start: Beginning,
    variant: Variant,
    advance: Advance,
    make_evaluator: MakeEvaluator | None = None,
) -> Track:
    """The recording tracked as a fit tracks a take.

    Args:
        recording: what is tracked.
        start: the initial pose.
        variant: how.
        advance: told of each frame.
        make_evaluator: what draws; None for what fits draw with.
    """
    make = with_level_for(start.pose, make_evaluator or native_choice())
    tracker = variant.make(start.body, recording.cameras, make)
    directions = directions_from(start.frame, recording.frames)
    fits: dict[int, FrameFit] = {}
    passes = Passes(tracker, start.pose, directions, fits, truth_of(recording).fps or 1.0)
    read = with_contours(recording.silhouettes)
    for fit in chain.from_iterable(passes.first(read)):
        fits[fit.frame] = fit
        advance(fit.frame)
    begin = time.perf_counter()
    for changed in passes.second(read) if variant.second_look else ():
        fits.update((fit.frame, fit) for fit in changed)
    looking = time.perf_counter() - begin
    names = [camera.name for camera in recording.cameras]
    motion = recorded(fits, start.body, names, recording.fps)
    return Track(
        motion=motion,
        score=score(truth_of(recording), _points(motion)),
        errors=_errors(recording, motion),
        seconds=looking + sum(fit.seconds for fit in fits.values()),
        evaluations=np.array([fits[frame].tally.evaluated for frame in sorted(fits)]),
    )


def _points(motion: Motion) -> PointTrack:
    return PointTrack(motion.point_names, motion.frames, motion.points)


def _errors(recording: Recording, motion: Motion) -> np.ndarray:
    truth = np.stack([recording.points(frame) for frame in motion.frames.tolist()])
    return 1000 * np.linalg.norm(motion.points - truth, axis=2)
