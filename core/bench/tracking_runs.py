"""Tracking a recording, and what the track is worth."""

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..ahead import made_ahead
from ..fitting.second_look import Course, looked_again
from ..fitting.tracker import Tracker
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
    passes = Passes(recording, start, variant, variant.make(start.body, recording.cameras, make))
    fits = []
    for fit in passes.first():
        fits.append(fit)
        advance(fit.frame)
    begin = time.perf_counter()
    fits = passes.second()
    looking = time.perf_counter() - begin
    names = [camera.name for camera in recording.cameras]
    motion = recorded(fits, start.body, names, recording.fps)
    return Track(
        motion=motion,
        score=score(truth_of(recording), _points(motion)),
        errors=_errors(recording, motion),
        seconds=looking + sum(fit.seconds for fit in fits),
        evaluations=np.array([fit.tally.evaluated for fit in fits]),
    )


class Passes:
    """The passes over a recording, as `results.passes` has them over a take.

    Args:
        recording: what is tracked.
        start: the initial pose.
        variant: whether there is a second look.
        tracker: fits each frame.
    """

    def __init__(self, recording: Recording, start: Beginning, variant: Variant, tracker: Tracker):
        self._recording, self._variant, self._tracker = recording, variant, tracker
        self._start, self._courses = start, []
        after = [frame for frame in recording.frames if frame >= start.frame]
        before = [frame for frame in reversed(recording.frames) if frame < start.frame]
        self._directions = [frames for frames in (after, before) if frames]

    def first(self) -> Iterator[FrameFit]:
        """The fits from the initial pose on, then of what comes before."""
        for frames in self._directions:
            fits = []
            history = History(self._start.body, self._start.pose)
            for fit in track(self._tracker, history, made_ahead(self._read(frames))):
                fits.append(fit)
                yield fit
            self._courses.append(Course(fits, truth_of(self._recording).fps or 1.0))

    def second(self) -> list[FrameFit]:
        """All fits, what the first passes left in doubt looked at again."""
        found = {fit.frame: fit for course in self._courses for fit in course.fits}
        for course in self._courses if self._variant.second_look else ():
            for changed in looked_again(self._tracker, course, self._read):
                found.update((fit.frame, fit) for fit in changed)
        return [found[frame] for frame in sorted(found)]

    def _read(self, frames: Iterable[int]) -> Iterator[tuple[int, tuple[Silhouette, ...]]]:
        for frame in frames:
            silhouettes = self._recording.silhouettes(frame)
            for silhouette in silhouettes:
                _ = silhouette.contour
            yield frame, silhouettes


def _points(motion: Motion) -> PointTrack:
    return PointTrack(motion.point_names, motion.frames, motion.points)


def _errors(recording: Recording, motion: Motion) -> np.ndarray:
    truth = np.stack([recording.points(frame) for frame in motion.frames.tolist()])
    return 1000 * np.linalg.norm(motion.points - truth, axis=2)
