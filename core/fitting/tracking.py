"""Frames in order: each starts from the pose of the one before and a prediction."""

import logging
import time
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..silhouettes.silhouette import Silhouette
from .scores import FrameScores, frame_scores
from .tracker import Past, PoseFit, Tally, Tracker

_log = logging.getLogger(__name__)
_DAMPING = 0.7
"""Share of the last frame's movement that is expected to go on."""
_REMEMBERED = 60
"""Frames whose lumps are remembered."""
_USUAL = 0.35
"""Share of them that had less than what is taken as usual: a limb may be lost for long."""


@dataclass(frozen=True, eq=False)
class FrameFit:
    """One tracked frame.

    Attributes:
        frame: its number.
        pose: (D,).
        scores: how well the pose explains the silhouettes.
        tally: what the search took.
        seconds: time the fit took, without reading the footage.
        locked: whether the pose was given, not sought.
    """

    frame: int
    pose: np.ndarray
    scores: FrameScores
    tally: Tally
    seconds: float
    locked: bool = False


class History:
    """The frames tracked so far in one direction, as far as the next one needs them.

    Args:
        pose: (D,) the pose that the first frame is searched from.
    """

    def __init__(self, pose: np.ndarray):
        self._poses = [pose, pose]
        self._lumps: deque[np.ndarray] = deque(maxlen=_REMEMBERED)

    def add(self, pose: np.ndarray, lumps: np.ndarray, locked: bool = False) -> None:
        """One more frame: its pose (D,), `FrameScores.lumps` (5,), and whether it was given.

        From a given pose nothing is expected to go on moving.
        """
        self._poses = [pose if locked else self._poses[1], pose]
        self._lumps.append(lumps)

    @property
    def past(self) -> Past:
        """What the next frame is searched from."""
        before, last = self._poses
        usual = np.quantile(self._lumps, _USUAL, axis=0) if self._lumps else np.full(5, np.inf)
        return Past(last, last + _DAMPING * (last - before), usual)


def track(
    tracker: Tracker,
    history: History,
    frames: Iterable[tuple[int, tuple[Silhouette, ...]]],
    locks: Mapping[int, np.ndarray] = MappingProxyType({}),
) -> Iterator[FrameFit]:
    """The fits of ``frames`` (number and silhouettes) in their order, which go into ``history``.

    Frames among the ``locks`` have the pose (D,) given there, and the next one starts from it.
    """
    for frame, silhouettes in frames:
        start = time.perf_counter()
        if frame in locks:
            fit = PoseFit(locks[frame], 0, Tally())
        else:
            fit = tracker.fit(silhouettes, history.past)
        scores = frame_scores(tracker.evaluator, fit.pose, silhouettes)
        history.add(fit.pose, scores.lumps, frame in locks)
        seconds = time.perf_counter() - start
        work = (frame, seconds, fit.tally.evaluated, fit.tally.outside_windows)
        _log.info("frame %d: %.3f s, %d evaluations, %d outside windows", *work)
        _log.info("frame %d: IoU %s, XOR px %s", frame, scores.iou.round(3), scores.xor_px)
        yield FrameFit(frame, fit.pose, scores, fit.tally, seconds, frame in locks)
