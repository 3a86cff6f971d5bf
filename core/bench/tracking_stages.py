"""Where the time of tracking goes, stage by stage.

Reading, tracking and writing go on beside each other in a fit. Stages are therefore told in the
processors' time, all threads together, and gone through one after another.
"""

import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ..beginning import initial_frames
from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from ..fitting.second_look import Course, looked_again
from ..fitting.tracker import Tracker
from ..fitting.tracking import FrameFit, History, track
from ..rendering.choice import MakeEvaluator
from ..rendering.detail import with_level_for
from ..silhouettes.silhouette import Silhouette
from ..take.take import Take
from ..take.views import Views, open_views
from .disturbances.recording import Recording
from .stopwatch import Stopwatch
from .tracking_runs import Advance
from .tracking_takes import Beginning, native_choice
from .tracking_variants import DEFAULT

READ, CONTOURS, PREPARED = "footage read", "contours found", "weights and doubts"
OUTLINES, EQUATIONS = "descents: outlines drawn", "descents: equations"
JUDGED, LIMBS, SCORES = "poses judged", "limbs sought", "scores"
AGAIN, KEPT = "second look", "overlay, files, threads in each other's way"
STAGES = (READ, CONTOURS, PREPARED, OUTLINES, EQUATIONS, JUDGED, LIMBS, SCORES, AGAIN, KEPT)


def stage_seconds(
    take: Take, recording: Recording, start: Beginning, advance: Advance
) -> dict[str, float]:
    """Processor seconds per frame of all stages but the last."""
    watch = Stopwatch()
    views = open_views(take)
    views, _ = views.reduced_and_seen(initial_frames(take, views.frames))
    read = watch.timed(READ, views.silhouettes)
    find = watch.timed(CONTOURS, lambda silhouettes: [s.contour for s in silhouettes])

    def footage(frames: Sequence[int]):
        for frame in frames:
            silhouettes: tuple[Silhouette, ...] = read(frame)
            find(silhouettes)
            yield frame, silhouettes

    make = with_level_for(start.pose, _timed_evaluators(watch))
    tracker = _timed_tracker(DEFAULT.make(start.body, recording.cameras, make), watch)
    fits, begin = {}, time.process_time()
    for found in track(tracker, History(start.body, start.pose), footage(recording.frames)):
        fits[found.frame] = found
        advance(found.frame)
    watch.seconds[SCORES] = time.process_time() - begin - sum(watch.seconds.values())
    watch.timed(AGAIN, _looked_again)(fits, float(take.fps), views, start)
    return {stage: watch.seconds[stage] / len(recording.frames) for stage in STAGES[:-1]}


def _looked_again(fits: dict[int, FrameFit], fps: float, views: Views, start: Beginning) -> None:
    """The second look, with a tracker that nobody watches."""
    make = with_level_for(start.pose, native_choice())
    tracker = DEFAULT.make(start.body, views.cameras, make)

    def read(frames: Sequence[int]) -> Iterator[tuple[int, tuple[Silhouette, ...]]]:
        return ((frame, views.silhouettes(frame)) for frame in frames)

    for changed in looked_again(tracker, Course(fits, list(fits), fps, start.body), read):
        fits.update((fit.frame, fit) for fit in changed)


def _timed_tracker(tracker: Any, watch: Stopwatch) -> Tracker:
    """``tracker``, told apart by stages as far as it has them."""
    if hasattr(tracker, "descent"):
        tracker.descent = watch.watched(tracker.descent, {"run": EQUATIONS})
    return watch.watched(tracker, {"fit": PREPARED})


def _timed_evaluators(watch: Stopwatch) -> MakeEvaluator:
    """What fits draw with, told apart by what is asked of it."""

    def make(body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
        inner = native_choice()(body, cameras, level)
        timed = watch.watched(inner, {"outline": OUTLINES, "masked": LIMBS})
        whole, limbs = (watch.timed(stage, inner.energies) for stage in (JUDGED, LIMBS))

        def energies(weights, poses: np.ndarray, segments: Sequence[int] | None = None):
            return (whole if segments is None else limbs)(weights, poses, segments)

        timed.energies = energies
        return timed

    return make
