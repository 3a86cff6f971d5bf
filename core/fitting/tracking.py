"""Frames in order: each starts from the pose of the one before and a prediction."""

import logging
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..silhouettes.silhouette import Silhouette
from .scores import FrameScores, frame_scores
from .tracker import Tally, Tracker

_log = logging.getLogger(__name__)
_DAMPING = 0.7
"""Share of the last frame's movement that is expected to go on."""


@dataclass(frozen=True, eq=False)
class FrameFit:
    """One tracked frame.

    Attributes:
        frame: its number.
        pose: (D,).
        scores: how well the pose explains the silhouettes.
        tally: what the search took.
        seconds: time the fit took, without reading the footage.
    """

    frame: int
    pose: np.ndarray
    scores: FrameScores
    tally: Tally
    seconds: float


def track(
    tracker: Tracker,
    last: np.ndarray,
    frames: Iterable[tuple[int, tuple[Silhouette, ...]]],
    before: np.ndarray | None = None,
) -> Iterator[FrameFit]:
    """The fits of ``frames`` in their order.

    Args:
        tracker: fits each frame.
        last: (D,) the pose that the first is searched from.
        frames: number and silhouettes.
        before: (D,) the pose one frame before ``last``; None where nothing moved.
    """
    predicted = last if before is None else last + _DAMPING * (last - before)
    for frame, silhouettes in frames:
        start = time.perf_counter()
        fit = tracker.fit(silhouettes, last, predicted)
        predicted = fit.pose + _DAMPING * (fit.pose - last)
        last = fit.pose
        scores = frame_scores(tracker.evaluator, fit.pose, silhouettes)
        seconds = time.perf_counter() - start
        work = (frame, seconds, fit.tally.evaluated, fit.tally.outside_windows)
        _log.info("frame %d: %.3f s, %d evaluations, %d outside windows", *work)
        _log.info("frame %d: IoU %s, XOR px %s", frame, scores.iou.round(3), scores.xor_px)
        yield FrameFit(frame, fit.pose, scores, fit.tally, seconds)
