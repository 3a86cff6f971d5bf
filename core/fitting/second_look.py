"""A second look at what one pass leaves in doubt: other passes, and the best of all of them.

Where lumps remain that are unusual in the take, a limb may have been lost; the pose of a frame
further on, where nothing speaks against it, leads back through the stretch the other way. So does
the pose after a leap within the stretch, as a limb may have been found again there, and one that
the user has locked, until both passes agree. And where the doubt begins, other poses
may explain the frame as well as the one that was taken: from these rivals the stretch is passed
through once more. Of each frame's candidates (all passes, and limbs of one with the rest of the
other) a path is chosen that explains the silhouettes and moves as people can (Viterbi), joined to
what was tracked before and after.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np

from ..body.body import Body
from ..body.kinematics import in_blocks, points
from ..energy.weight_maps import xor_weight_maps
from ..silhouettes.silhouette import Silhouette
from .limbs import points_of
from .scores import frame_scores
from .tracker import Tracker
from .tracking import Fits, FrameFit, History, columns, track, usual_lumps

AGREED_M = 0.03
"""Two poses whose points are all nearer to each other are the same."""
APART_M = 0.1
"""Passes from both ends that differ by more tell of a frame that is lost, where neither explains it
better."""
_EITHER = 0.3
"""Times the confidence of a point that another pass puts elsewhere and explains as much."""
_AGREEING = 2
"""Frames in a row in which both passes have to agree."""
_WORSE, _HOPELESS = 1.1, 8
"""Times the px that differ in the first pass, and frames in a row with more, that end another."""
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
_LEAP_MPS = 6.0
"""Speed, m/s, of a point between two frames, that tells of a loss or of its end."""
_LEAPS = 3
"""Most of them that a doubtful stretch is passed back from."""
_LEAP = 30.0
"""What a leap of any length costs, in the same unit."""
_MIXED = 2
"""Most limbs in which passes may differ for their poses to be mixed."""
_RIVALS = 3
"""Most other poses that a doubtful stretch is passed through from."""

Read = Callable[[Sequence[int]], Iterator[tuple[int, tuple[Silhouette, ...]]]]


class Stretch(NamedTuple):
    """Frames that are looked at again, as indices of a course.

    Attributes:
        begin: the first.
        end: the one after the last, which is trusted or locked, or the number of all frames.
        doubt: the first that is doubtful; None where only a locked pose leads back.
        leaps: those after ``doubt`` whose pose nobody reaches in time from the one before: there a
            limb was lost, or found again.
    """

    begin: int
    end: int
    doubt: int | None = None
    leaps: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class Course:
    """Frames in the order they were tracked, all in one direction of time.

    Attributes:
        fits: theirs, perhaps among others.
        frames: numbers of the T frames.
        fps: frames per second.
        body: whose poses they are.
    """

    fits: Fits
    frames: Sequence[int]
    fps: float
    body: Body

    def fit(self, index: int) -> FrameFit:
        """The fit of the frame that was tracked as number ``index``."""
        return self.fits[self.frames[index]]

    def stretches(self) -> list[Stretch]:
        """What is looked at again, each before a locked frame or about doubtful ones.

        They begin after the locked frame before, if there is one within reach.
        """
        _, _, locked = self._signs
        found = {int(end): Stretch(0, int(end)) for end in np.flatnonzero(locked)}
        doubtful = self.doubtful()
        index = 0
        while index < len(doubtful):
            if not doubtful[index]:
                index += 1
                continue
            doubt = index
            while doubtful[index : index + _CALM].any() and not locked[index]:
                index += 1
            begin = 0 if index in found else max(doubt - _BACK, 0)
            found[index] = Stretch(begin, index, doubt, self._leaps(doubt, index))
        stretches = []
        for end, stretch in sorted(found.items()):
            before = [int(lock) + 1 for lock in np.flatnonzero(locked[:end])]
            begin = max([stretch.begin, *before])
            if begin < end:
                stretches.append(stretch._replace(begin=begin))
        return stretches

    def _leaps(self, begin: int, end: int) -> tuple[int, ...]:
        """The farthest leaps of poses after ``begin`` and before ``end``, see `Stretch`."""
        poses = columns(self.fits, self.frames[begin:end], lambda fit: (fit.pose,))[0]
        moves = np.diff(in_blocks(points, self.body, poses), axis=0) * self.fps
        speeds = np.linalg.norm(moves, axis=2).max(axis=1, initial=0.0)
        farthest = np.argsort(-speeds, kind="stable")[:_LEAPS]
        return tuple(sorted((farthest[speeds[farthest] > _LEAP_MPS] + begin + 1).tolist()))

    @cached_property
    def usual(self) -> np.ndarray:
        """(L,) `FrameScores.lumps` that the frames have usually."""
        return usual_lumps(self._signs[0])

    def doubtful(self) -> np.ndarray:
        """(T,) bool, whether lumps are unusual in the take."""
        lumps, lost, locked = self._signs
        return ((lumps > _UNUSUAL * self.usual + _LITTLE_M2).any(axis=1) | lost) & ~locked

    @cached_property
    def _signs(self) -> list[np.ndarray]:
        """(T, L) lumps, (T,) lost and (T,) locked, as they are before the second look."""
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


def _joined(tracker: Tracker, course: Course, stretch: Stretch, read: Read) -> Iterator[FrameFit]:
    """The fits of the frames of a stretch that change."""
    body = tracker.evaluator.body
    back = _passed_back(tracker, course, (stretch.begin, stretch.end), read)
    passes = [back, *_passed_by_rivals(tracker, course, stretch, read)]
    passes += [_passed_back(tracker, course, (stretch.begin, leap), read) for leap in stretch.leaps]
    others = {
        i: [found[i] for found in passes if i in found and _differs(course, body, i, found[i])]
        for i in range(stretch.begin, stretch.end)
    }
    differing = [i for i, poses in others.items() if poses]
    if not differing:
        return
    indices = range(min(differing), max(differing) + 1)
    candidates = [_candidates(body, course.fit(i).pose, others[i]) for i in indices]
    costs = [
        _costs(tracker, poses, silhouettes, course.fit(i).scores.view_weights)
        for i, poses, (_, silhouettes) in zip(
            indices, candidates, read([course.frames[i] for i in indices]), strict=True
        )
    ]
    outer = (indices[0] - 1, indices[-1] + 1)
    ends = [course.fit(i).pose for i in outer if 0 <= i < len(course.frames)]
    path = _path(body, candidates, costs, ends if indices[0] else [None, *ends], course.fps)
    chosen: dict[int, tuple[np.ndarray, np.ndarray, bool]] = {}
    for index, k, poses, cost in zip(indices, path, candidates, costs, strict=True):
        apart = _as_good_elsewhere(body, poses, cost, k)
        if k or apart.any():
            both_ends = bool(others[index]) and others[index][0] is back.get(index)
            lost = both_ends and bool(apart[0 if k == 1 else 1].any())
            chosen[index] = poses[k], apart.any(axis=0), lost
    seen = read([course.frames[i] for i in chosen])
    for (index, found), (_, silhouettes) in zip(chosen.items(), seen, strict=True):
        pose, elsewhere, lost = found
        scores = frame_scores(tracker.evaluator, pose, silhouettes, course.usual)
        likely = np.where(elsewhere, _EITHER, 1.0) * scores.confidence
        scores = replace(scores, lost=scores.lost or lost, confidence=likely)
        yield replace(course.fit(index), pose=pose, scores=scores)


def _as_good_elsewhere(body: Body, poses: np.ndarray, costs: np.ndarray, k: int) -> np.ndarray:
    """(K, P) bool, points that poses (K, D) put elsewhere than the k-th, and cost no more."""
    places = points(body, poses)
    apart = np.linalg.norm(places - places[k], axis=2) > APART_M
    return apart & (np.abs(costs - costs[k]) < 1.0)[:, None]


def _differs(course: Course, body: Body, index: int, pose: np.ndarray) -> bool:
    return bool(_apart(body, course.fit(index).pose, pose).max() >= AGREED_M)


def _passed_back(
    tracker: Tracker, course: Course, span: tuple[int, int], read: Read
) -> dict[int, np.ndarray]:
    """The poses (D,) by index of a pass from after the span (begin, end), if a frame is there."""
    begin, end = span
    if end == len(course.frames):
        return {}
    history = History(tracker.evaluator.body, course.fit(end).pose)
    return _passed(tracker, course, history, range(end - 1, begin - 1, -1), read)


def _passed_by_rivals(
    tracker: Tracker, course: Course, stretch: Stretch, read: Read
) -> Iterator[dict[int, np.ndarray]]:
    """The same of passes on from other poses that explain the first doubtful frame as well."""
    if not stretch.doubt:
        return
    body, doubt = tracker.evaluator.body, stretch.doubt
    history = History(body, course.fit(max(doubt - 2, 0)).pose)
    history.add(course.fit(doubt - 1).pose, course.usual)
    ((_, silhouettes),) = read([course.frames[doubt]])
    fit = tracker.fit(silhouettes, replace(history.past, usual=np.zeros_like(course.usual)))
    known = [course.fit(doubt).pose]
    for rival in (fit.pose, *fit.rivals):
        if len(known) <= _RIVALS and all(_apart(body, rival, k).max() > APART_M for k in known):
            known.append(rival)
            history = History(body, rival)
            history.add(rival, course.usual)
            found = _passed(tracker, course, history, range(doubt + 1, stretch.end), read)
            yield {doubt: rival, **found}


def _passed(
    tracker: Tracker, course: Course, history: History, indices: Sequence[int], read: Read
) -> dict[int, np.ndarray]:
    """The poses (D,) by index of a pass over ``indices``, until it agrees or is hopeless."""
    passed = track(tracker, history, read([course.frames[i] for i in indices]))
    found, agreeing, worse = {}, 0, 0
    for index, fit in zip(indices, passed, strict=False):
        found[index], first = fit.pose, course.fit(index)
        differs = _differs(course, tracker.evaluator.body, index, fit.pose)
        agreeing = 0 if differs else agreeing + 1
        is_worse = fit.scores.xor_px.sum() > _WORSE * first.scores.xor_px.sum()
        worse = worse + 1 if is_worse else 0
        if agreeing == _AGREEING or worse == _HOPELESS:
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
    """(K, L) costs of going from poses with points (K, P, 3) to those with (L, P, 3)."""
    speeds = np.linalg.norm(after[None] - before[:, None], axis=3) * fps
    cost = ((speeds / _MPS) ** 2).sum(axis=2)
    return cost / (1.0 + cost / _LEAP)


def _apart(body: Body, pose: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(P,) how far the points of two poses (D,) are from each other, m."""
    places = points(body, np.stack([pose, other]))
    return np.linalg.norm(places[0] - places[1], axis=1)


def _candidates(body: Body, pose: np.ndarray, others: Sequence[np.ndarray]) -> np.ndarray:
    """(K, D) all poses, and the first with some limbs of another where only a few differ."""
    found = [pose, *others]
    for other in others:
        apart = _apart(body, pose, other)
        differing = [
            part
            for part in body.parts
            if part.role == "limb" and apart[points_of(body, part.name)].max() >= AGREED_M
        ]
        if len(differing) <= _MIXED:
            for swapped in [*product((False, True), repeat=len(differing))][1:-1]:
                mixed = pose.copy()
                for part, takes in zip(differing, swapped, strict=True):
                    if takes:
                        mixed[list(part.dofs)] = other[list(part.dofs)]
                found.append(mixed)
    return np.stack(found)
