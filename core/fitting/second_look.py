"""A second look at what one pass leaves in doubt: from the other end, and the better of both.

Where lumps remain that are unusual in the take, a limb may have been lost; the pose of a frame
further on, where nothing speaks against it, leads back through the stretch the other way. So does
a pose that the user has locked, until both passes agree. Of each frame's candidates (either pass,
and limbs of one with the rest of the other) a path is chosen that explains the silhouettes and
moves as people can (Viterbi), joined to what was tracked before and after.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product

import numpy as np

from ..body.body import Body
from ..body.kinematics import points
from ..energy.weight_maps import xor_weight_maps
from ..silhouettes.silhouette import Silhouette
from .limbs import points_of
from .scores import frame_scores
from .tracker import Tracker
from .tracking import Fits, FrameFit, History, columns, track, usual_lumps

AGREED_M = 0.03
"""Two poses whose points are all nearer to each other are the same."""
APART_M = 0.1
"""Passes that differ by more tell of a frame that is lost, where neither explains it better."""
_EITHER = 0.3
"""Times the confidence that a point has where each pass puts it elsewhere."""
_AGREEING = 2
"""Frames in a row in which both passes have to agree."""
_CALM = 3
"""Frames in a row without doubt, of which the first is trusted."""
_UNUSUAL, _LITTLE_M2 = 1.6, 0.008
"""Lumps that raise doubt: so many times the take's usual ones, and so much more."""
_BACK = 15
"""Frames before a doubtful stretch that the second pass may change."""
_BETTER = 0.005
"""Share of the silhouettes' area that tells two poses apart."""
_MPS = 2.0
"""Speed, m/s, of a point that costs as much."""
_LEAP = 10.0
"""What a leap of any length costs, in the same unit."""
_MIXED = 2
"""Most limbs in which passes may differ for their poses to be mixed."""

Read = Callable[[Sequence[int]], Iterator[tuple[int, tuple[Silhouette, ...]]]]


@dataclass(frozen=True, eq=False)
class Course:
    """Frames in the order they were tracked, all in one direction of time.

    Attributes:
        fits: theirs, perhaps among others.
        frames: numbers of the T frames.
        fps: frames per second.
    """

    fits: Fits
    frames: Sequence[int]
    fps: float

    def fit(self, index: int) -> FrameFit:
        """The fit of the frame that was tracked as number ``index``."""
        return self.fits[self.frames[index]]

    def stretches(self) -> list[tuple[int, int]]:
        """(begin, end) indices, end exclusive, that are looked at again from ``end`` backwards.

        Each ends before a frame that is locked, or trusted after a doubtful stretch; it begins
        after the locked frame before, if there is one within reach.
        """
        _, _, locked = self._signs
        ends = {int(end) for end in np.flatnonzero(locked)}
        doubtful = self.doubtful()
        begins: dict[int, int] = {}
        index = 0
        while index < len(doubtful):
            if not doubtful[index]:
                index += 1
                continue
            begin = index
            while index < len(doubtful) and doubtful[index : index + _CALM].any():
                index += 1
            if index < len(doubtful):
                ends.add(index)
                begins[index] = max(begin - _BACK, 0)
        found = []
        for end in sorted(ends):
            before = [int(lock) + 1 for lock in np.flatnonzero(locked[:end])]
            begin = max([begins.get(end, 0), *before])
            if begin < end:
                found.append((begin, end))
        return found

    @cached_property
    def usual(self) -> np.ndarray:
        """(5,) `FrameScores.lumps` that the frames have usually."""
        return usual_lumps(self._signs[0])

    def doubtful(self) -> np.ndarray:
        """(T,) bool, whether lumps are unusual in the take."""
        lumps, lost, locked = self._signs
        return ((lumps > _UNUSUAL * self.usual + _LITTLE_M2).any(axis=1) | lost) & ~locked

    @cached_property
    def _signs(self) -> list[np.ndarray]:
        """(T, 5) lumps, (T,) lost and (T,) locked, as they are before the second look."""
        return columns(
            self.fits,
            self.frames,
            lambda fit: (fit.scores.lumps, fit.scores.lost, fit.locked),
        )


def looked_again(tracker: Tracker, course: Course, read: Read) -> Iterator[list[FrameFit]]:
    """The fits that a second look changes, stretch by stretch of the ``course``.

    ``read`` yields the number and silhouettes of frames. Those of one stretch are to be put among
    the course's fits before the next are asked for, as stretches may overlap.
    """
    for stretch in course.stretches():
        yield list(_joined(tracker, course, stretch, read))


def _joined(
    tracker: Tracker, course: Course, stretch: tuple[int, int], read: Read
) -> Iterator[FrameFit]:
    """The fits of the frames of a stretch that change."""
    body = tracker.evaluator.body
    back = _passed_back(tracker, course, stretch, read)
    differing = [
        i for i, pose in back.items() if _apart(body, pose, course.fit(i).pose).max() >= AGREED_M
    ]
    if not differing:
        return
    indices = range(min(differing), max(differing) + 1)
    candidates = [_candidates(body, course.fit(i).pose, back[i]) for i in indices]
    costs = [
        _costs(tracker, poses, silhouettes, course.fit(i).scores.view_weights)
        for i, poses, (_, silhouettes) in zip(
            indices, candidates, read([course.frames[i] for i in indices]), strict=True
        )
    ]
    outer = (indices[0] - 1, indices[-1] + 1)
    ends = [course.fit(i).pose for i in outer if 0 <= i < len(course.frames)]
    path = _path(body, candidates, costs, ends if indices[0] else [None, *ends], course.fps)
    chosen: dict[int, tuple[np.ndarray, np.ndarray | None]] = {}
    for index, k, poses, cost in zip(indices, path, candidates, costs, strict=True):
        apart = _apart(body, poses[0], poses[1])
        ambiguous = abs(cost[0] - cost[1]) < 1.0 and apart.max() > APART_M
        if k or ambiguous:
            chosen[index] = poses[k], apart if ambiguous else None
    seen = read([course.frames[i] for i in chosen])
    for (index, (pose, apart)), (_, silhouettes) in zip(chosen.items(), seen, strict=True):
        scores = frame_scores(tracker.evaluator, pose, silhouettes, course.usual)
        if apart is not None:
            likely = np.where(apart > APART_M, _EITHER, 1.0) * scores.confidence
            scores = replace(scores, lost=True, confidence=likely)
        yield replace(course.fit(index), pose=pose, scores=scores)


def _passed_back(
    tracker: Tracker, course: Course, stretch: tuple[int, int], read: Read
) -> dict[int, np.ndarray]:
    """The poses (D,) that a pass from the stretch's end finds, by index, until it agrees."""
    begin, end = stretch
    indices = range(end - 1, begin - 1, -1)
    history = History(tracker.evaluator.body, course.fit(end).pose)
    passed = track(tracker, history, read([course.frames[i] for i in indices]))
    found, agreeing = {}, 0
    for index, fit in zip(indices, passed, strict=False):
        found[index] = fit.pose
        apart = _apart(tracker.evaluator.body, fit.pose, course.fit(index).pose).max()
        agreeing = agreeing + 1 if apart < AGREED_M else 0
        if agreeing == _AGREEING:
            break
    return found


def _costs(
    tracker: Tracker,
    poses: np.ndarray,
    silhouettes: tuple[Silhouette, ...],
    view_weights: np.ndarray,
) -> np.ndarray:
    """(K,) energies of poses (K, D), in the share of the silhouettes' area that counts."""
    maps = xor_weight_maps(silhouettes)
    evaluator = tracker.evaluator
    pixels = evaluator.energies(evaluator.prepared(maps), poses) @ view_weights
    return pixels / max(_BETTER * float(maps.constants @ view_weights), 1.0)


def _path(
    body: Body,
    candidates: Sequence[np.ndarray],
    costs: Sequence[np.ndarray],
    ends: Sequence[np.ndarray | None],
    fps: float,
) -> list[int]:
    """Which of each frame's candidates (K, D) make the cheapest path, joined to the ends (D,)."""
    places = [points(body, poses) for poses in candidates]
    outer = [None if end is None else points(body, end[None]) for end in (*ends, None)[:2]]
    total, origins = costs[0].copy(), []
    if outer[0] is not None:
        total += _moves(outer[0], places[0], fps)[0]
    for before, after, cost in zip(places, places[1:], costs[1:], strict=False):
        sums = total[:, None] + _moves(before, after, fps)
        origins.append(sums.argmin(axis=0))
        total = sums.min(axis=0) + cost
    if outer[1] is not None:
        total += _moves(places[-1], outer[1], fps)[:, 0]
    path = [int(total.argmin())]
    for origin in reversed(origins):
        path.append(int(origin[path[-1]]))
    return path[::-1]


def _moves(before: np.ndarray, after: np.ndarray, fps: float) -> np.ndarray:
    """(K, L) costs of going from poses with points (K, 14, 3) to those with (L, 14, 3)."""
    speeds = np.linalg.norm(after[None] - before[:, None], axis=3) * fps
    cost = ((speeds / _MPS) ** 2).sum(axis=2)
    return cost / (1.0 + cost / _LEAP)


def _apart(body: Body, pose: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(14,) how far the points of two poses (D,) are from each other, m."""
    places = points(body, np.stack([pose, other]))
    return np.linalg.norm(places[0] - places[1], axis=1)


def _candidates(body: Body, pose: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(K, D) both poses, and those with some limbs of the other where only a few differ."""
    apart = _apart(body, pose, other)
    differing = [
        part
        for part in body.parts
        if part.role == "limb" and apart[points_of(part.name)].max() >= AGREED_M
    ]
    found = [pose, other]
    if len(differing) <= _MIXED:
        for swapped in [*product((False, True), repeat=len(differing))][1:-1]:
            mixed = pose.copy()
            for part, takes in zip(differing, swapped, strict=True):
                if takes:
                    mixed[list(part.dofs)] = other[list(part.dofs)]
            found.append(mixed)
    return np.stack(found)
