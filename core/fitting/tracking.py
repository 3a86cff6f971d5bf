"""Frames in order: each starts from the pose of the one before and a prediction."""

import logging
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..body.body import Body
from ..silhouettes.silhouette import Silhouette
from .limbs import limb_names
from .lumps import unexplained
from .scores import FrameScores, frame_scores
from .tracker import Past, PoseFit, Tally, Tracker

_log = logging.getLogger(__name__)
_DAMPING = 0.7
"""Share of the last frame's movement that is expected to go on."""
_REMEMBERED = 60
"""Frames whose lumps are remembered."""
_USUAL = 0.35
"""Share of them that had less than what is taken as usual: a limb may be lost for long."""
_TROUBLE, _TROUBLE_M2 = 1.5, 0.03
"""Lumps of a limb in trouble: so many times the usual ones, and so much more."""
_PATIENCE = 10
"""Frames that a limb in trouble is expected where it was before."""


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


Fits = Mapping[int, FrameFit]
"""Tracked frames by number; long takes have them read from a file whenever one is asked for."""


def columns(
    fits: Fits, frames: Sequence[int], values: Callable[[FrameFit], tuple]
) -> list[np.ndarray]:
    """(T, …) arrays, one for each of the ``values`` of a fit, over T of the ``fits``, at least one.

    The fits are looked at one after another, so that none is held.
    """
    found: list[np.ndarray] = []
    for row, frame in enumerate(frames):
        own = values(fits[frame])
        if not found:
            found = [np.repeat(np.asarray(value)[None], len(frames), axis=0) for value in own]
        for column, value in zip(found, own, strict=True):
            column[row] = value
    return found


def usual_lumps(lumps: Sequence[np.ndarray] | np.ndarray) -> np.ndarray:
    """(L,) what is usual of `FrameScores.lumps`, n of (L,)."""
    return np.quantile(lumps, _USUAL, axis=0)


class History:
    """The frames tracked so far in one direction, as far as the next one needs them.

    Args:
        body: whose.
        pose: (D,) that the first frame is searched from.
    """

    def __init__(self, body: Body, pose: np.ndarray):
        self._poses, self._trusted = [pose, pose], pose
        names = limb_names(body)
        self._troubled, self._amiss = np.zeros(len(names), int), 0
        self._lumps: deque[np.ndarray] = deque(maxlen=_REMEMBERED)
        self._limbs = {
            names.index(part.name): list(part.dofs) for part in body.parts if part.role == "limb"
        }

    def add(self, pose: np.ndarray, lumps: np.ndarray, locked: bool = False) -> None:
        """One more frame: its pose (D,), `FrameScores.lumps` (L,), and whether it was given.

        From a given pose nothing is expected to go on moving.
        """
        troubled = (lumps > _TROUBLE * self._usual + _TROUBLE_M2) & (not locked)
        self._troubled = np.where(troubled, self._troubled + 1, 0)
        self._amiss = self._amiss + 1 if unexplained(lumps, self._usual) and not locked else 0
        self._trusted = np.where(self._held, self._trusted, pose)
        self._poses = [pose if locked else self._poses[1], pose]
        self._lumps.append(lumps)

    @property
    def past(self) -> Past:
        """What the next frame is searched from."""
        before, last = self._poses
        predicted = last + _DAMPING * (last - before)
        trusted = np.where(self._held, self._trusted, predicted)
        patient = self._troubled < _PATIENCE
        return Past(last, predicted, self._usual, trusted, patient, self._amiss)

    @property
    def _held(self) -> np.ndarray:
        """(D,) bool, the DOFs of limbs in trouble, unless they are for too long."""
        held = np.zeros(len(self._trusted), bool)
        for limb, dofs in self._limbs.items():
            held[dofs] = 0 < self._troubled[limb] <= _PATIENCE
        return held

    @property
    def _usual(self) -> np.ndarray:
        return usual_lumps(self._lumps) if self._lumps else np.full(len(self._troubled), np.inf)


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
        start, past = time.perf_counter(), history.past
        if frame in locks:
            fit = PoseFit(locks[frame], 0, Tally())
        else:
            fit = tracker.fit(silhouettes, past)
        scores = frame_scores(tracker.evaluator, fit.pose, silhouettes, past.usual)
        history.add(fit.pose, scores.lumps, frame in locks)
        seconds = time.perf_counter() - start
        work = (frame, seconds, fit.tally.evaluated, fit.tally.outside_windows)
        _log.info("frame %d: %.3f s, %d evaluations, %d outside windows", *work)
        _log.info("frame %d: IoU %s, XOR px %s", frame, scores.iou.round(3), scores.xor_px)
        yield FrameFit(frame, fit.pose, scores, fit.tally, seconds, frame in locks)
