"""The offsets of a tracked take's views, told from a few of its moments.

Offsets move outlines in straight lines only as long as they are small, so that the equations are
made anew about what was found, until nothing changes. As a delay of a frame or more is not small,
the outlines of the frames before and after are looked at, too; of two ends the better one counts.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..energy.evaluator import Evaluator
from .camera_stretches import Read
from .offset_search import Offset, OffsetSearch
from .tracking import Fits, columns
from .view_offsets import OFFSETS, Moment, OffsetEquations

_ROUNDS, _SETTLED = 6, 0.05
"""Most times that equations are made anew, and px or frames that are no change."""
_SHIFTS = (-2, -1, 0, 1, 2)
_BETTER = 0.85
"""Of the misfit, at which another frame's outlines are worth a try."""
_EXPLAINED = 0.08
"""Of a view's misfit, that its offsets have to take away from all views together."""
_NOWHERE = 0.25
"""Misfit of a view whose outlines fit nowhere, wherever they are moved."""
_DELAY = OFFSETS.index("delay")


class ViewComparison:
    """Compares V views at some moments of T tracked frames.

    Args:
        evaluator: draws the body.
        fits: theirs.
        read: gives the silhouettes.
        chosen: indices of the moments.
        silent: (T, V) bool, views that say nothing.
    """

    def __init__(
        self,
        evaluator: Evaluator,
        fits: Fits,
        read: Read,
        chosen: Sequence[int],
        silent: np.ndarray,
    ):
        frames = sorted(fits)
        (self._poses,) = columns(fits, frames, lambda fit: (fit.pose,))
        self._chosen, self._views = chosen, len(evaluator.cameras)
        self._equations = OffsetEquations(evaluator)
        self._fields = [
            [
                # half the memory; a contour's own pixels lose less than 0.001 px
                None if quiet else silhouette.contour.field.astype(np.float16)
                for silhouette, quiet in zip(read(frames[i]), silent[i], strict=True)
            ]
            for i in chosen
        ]

    def offsets(self, is_enough: Callable[[Offset], bool]) -> list[Offset]:
        """Those worth telling, strongest first; ``begin`` counts the moments chosen."""
        nothing = np.zeros((len(self._chosen), self._views, len(OFFSETS)))
        found, known = self._settled(nothing, is_enough)
        late = self._out_of_step()
        if late is not None:
            other, other_known = self._settled(nothing + late, is_enough)
            if self._misfits(other_known).sum() < self._misfits(known).sum():
                found, known = other, other_known
        return self._proved(found, known)

    def _proved(self, found: Sequence[Offset], known: np.ndarray) -> list[Offset]:
        """Those of views without whose offsets outlines fit clearly worse, poses let go."""
        if not found:
            return []
        misfits, proved = self._freed_misfits(known), []
        for view in {offset.view for offset in found}:
            without = known.copy()
            without[:, view] = 0.0
            before = self._freed_misfits(without)
            explained = before.sum() - misfits.sum() > _EXPLAINED * before[:, view].sum()
            if explained and misfits[:, view].mean() < _NOWHERE:
                proved.append(view)
        return [offset for offset in found if offset.view in proved]

    def _freed_misfits(self, known: np.ndarray) -> np.ndarray:
        """(T, V) with offsets (T, V, 5), for poses that are not pulled by them."""
        moments = [self._moment(k, offsets) for k, offsets in enumerate(known)]
        steps = [self._equations.freed(moment) for moment in moments]
        freed = (
            replace(moment, poses=moment.poses + step)
            for moment, step in zip(moments, steps, strict=True)
        )
        return np.stack([self._equations.misfits(moment) for moment in freed])

    def _settled(
        self, known: np.ndarray, is_enough: Callable[[Offset], bool]
    ) -> tuple[list[Offset], np.ndarray]:
        """The offsets, and all of them as (T, V, 5), found from those ``known`` on."""
        found: list[Offset] = []
        for _ in range(_ROUNDS):
            made = [self._equations.of(self._moment(k, known[k])) for k in range(len(known))]
            search = OffsetSearch(*(np.stack(part) for part in zip(*made, strict=True)))
            found, before = search.found(is_enough), known
            known = search.unknowns(found)[:, :-1].reshape(known.shape)
            if np.abs(known - before).max() < _SETTLED:
                break
        return found, known

    def _out_of_step(self) -> np.ndarray | None:
        """(V, 5) the offsets of the view that other frames' outlines fit best; None for no view."""
        known = np.zeros((len(_SHIFTS), 1, self._views, len(OFFSETS)))
        known[..., _DELAY] = np.array(_SHIFTS)[:, None, None]
        moments = range(0, len(self._chosen), 2)
        misfits = np.stack([self._misfits(shift, moments).sum(axis=0) for shift in known])
        ratios = misfits / np.maximum(misfits[_SHIFTS.index(0)], 1e-9)
        best, view = np.unravel_index(int(ratios.argmin()), ratios.shape)
        if ratios[best, view] > _BETTER:
            return None
        late = np.zeros((self._views, len(OFFSETS)))
        late[view, _DELAY] = _SHIFTS[best]
        return late

    def _misfits(self, known: np.ndarray, moments: Sequence[int] | None = None) -> np.ndarray:
        """(n, V) at the moments, all if None, with offsets (T or 1, V, 5)."""
        known = np.broadcast_to(known, (len(self._chosen), *known.shape[1:]))
        chosen = range(len(self._chosen)) if moments is None else moments
        return np.stack([self._equations.misfits(self._moment(k, known[k])) for k in chosen])

    def _moment(self, k: int, known: np.ndarray) -> Moment:
        times = self._chosen[k] + known[:, _DELAY] + np.array([[-1], [0], [1]])
        times = np.clip(times, 0, len(self._poses) - 1)
        before = np.minimum(times.astype(int), len(self._poses) - 2)
        share = (times - before)[..., None]
        poses = (1 - share) * self._poses[before] + share * self._poses[before + 1]
        fields = [None if f is None else f.astype(np.float32) for f in self._fields[k]]
        return Moment(poses, fields, known)
