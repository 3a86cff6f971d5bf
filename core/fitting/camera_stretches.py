"""Stretches of a tracked take in which a camera shows nobody, stands still, or is not trusted.

Where to look is told by the scores of the fits, so that only few frames are read again.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..energy.evaluator import Evaluator
from ..silhouettes.silhouette import Silhouette
from .tracking import Fits, columns

Read = Callable[[int], tuple[Silhouette, ...]]
"""Gives the V silhouettes of a frame."""
_APART = 0.02
"""IoU under which model and silhouette are not in the same place."""
_TRACKED = 0.4
"""Median IoU of the other views, from which on they tell where the performer is."""
_NOBODY = 0.05
"""Share of what the model covers, that is nobody."""
_VISIBLE_M2 = 0.1
"""Of the model, that a camera has to show."""
_DOUBTED, _IGNORED = 0.7, 0.6
"""Trust in a view under which something may be wrong, and is worth telling."""
_FALLEN, _USUALLY = 0.06, 0.8
"""IoU that a view has lost beside the others, where its pictures may have stopped, and the
quantile of what it usually has."""
_SAME, _MOVED = 0.01, 0.1
"""Share of the area that differs between pictures that are the same, and of a model that moved."""
_GAP, _SHORTEST, _BAD = 3, 2, 5
"""Frames: between stretches that are one, of a stretch, and of one with bad silhouettes."""
_MOST, _LOOKS = 3, 5
"""Stretches of a kind that are told of a view, and frames of one that are read."""


@dataclass(frozen=True)
class Stretch:
    """Frames in which something is wrong with one view.

    Attributes:
        view: its index.
        kind: "dead", "frozen" or "bad".
        first: index of the first frame.
        last: index of the last frame.
        trust: mean view weight.
        missing: share of what the model covers that is not in the silhouettes.
        surplus: share that they have beside it.
    """

    view: int
    kind: str
    first: int
    last: int
    trust: float
    missing: float = 0.0
    surplus: float = 0.0


class Stretches:
    """Looks for them in the fits of T frames.

    Args:
        evaluator: draws the body in V cameras.
        fits: theirs.
        read: gives the silhouettes.
    """

    def __init__(self, evaluator: Evaluator, fits: Fits, read: Read):
        self._evaluator, self._fits, self._read = evaluator, fits, read
        self._frames = sorted(fits)
        self._trust, self._iou = columns(
            fits, self._frames, lambda fit: (fit.scores.view_weights, fit.scores.iou)
        )
        self.silent = np.zeros(self._trust.shape, bool)
        """(T, V) where a view shows nobody or stands still, as far as it is known."""

    def silent_ones(self) -> list[Stretch]:
        """Dead and frozen cameras, marked in ``silent``."""
        found = []
        for search in self._dead, self._frozen:
            for view in range(self._trust.shape[1]):
                for stretch in search(view):
                    self.silent[stretch.first : stretch.last + 1, view] = True
                    found.append(stretch)
        return found

    def bad_ones(self, views: Sequence[int]) -> list[Stretch]:
        """Where one of ``views`` is hardly trusted, and it is not known why.

        Of two views alone, neither can be trusted more than the other.
        """
        found = []
        for view in views if self._trust.shape[1] > 2 else ():
            doubted = (self._trust[:, view] < _DOUBTED) & ~self.silent[:, view]
            for first, last in _few_runs(doubted, _GAP, _BAD):
                within = np.flatnonzero(doubted[first : last + 1]) + first
                trust = float(self._trust[within, view].mean())
                if trust < _IGNORED:
                    found.append(
                        Stretch(view, "bad", first, last, trust, *self._shares(view, within))
                    )
        return found

    def _dead(self, view: int) -> list[Stretch]:
        others = np.delete(self._iou, view, axis=1)
        tracked = _median_of_rows(others) > _TRACKED
        apart = (self._iou[:, view] < _APART) & tracked
        return [
            Stretch(view, "dead", first, last, self._mean_trust(view, first, last))
            for first, last in _few_runs(apart, 0, _SHORTEST)
            if self._shows_nobody(view, int(np.flatnonzero(apart[first:])[0]) + first)
        ]

    def _shows_nobody(self, view: int, index: int) -> bool:
        drawn = np.count_nonzero(self._drawn(view, index))
        seen = np.count_nonzero(self._seen(view, index).foreground)
        camera = self._evaluator.cameras[view]
        root = self._evaluator.transforms(self._pose(index)[None])[0, 0, :, 3]
        metre = float(camera.depths(root)) / camera.matrix[0, 0]
        return drawn * metre**2 > _VISIBLE_M2 and seen < _NOBODY * drawn

    def _frozen(self, view: int) -> list[Stretch]:
        beside = np.nan_to_num(self._iou[:, view]) - _median_of_rows(self._iou)
        fallen = beside < np.quantile(beside, _USUALLY) - _FALLEN
        doubted = (fallen | (self._trust[:, view] < _DOUBTED)) & ~self.silent[:, view]
        found: list[Stretch] = []
        for begin, end in _runs(doubted, _GAP):
            if end - begin + 1 < _SHORTEST or any(s.first <= begin <= s.last for s in found):
                continue
            early, middle, late = (round(begin + k * (end - begin) / 4) for k in (1, 2, 3))
            still = self._seen(view, middle).foreground
            if all(self._shows(view, index, still) for index in (early, late)):
                first = self._last_with(view, range(early, -1, -1), still)
                last = self._last_with(view, range(late, len(self._frames)), still)
                ends = self._drawn(view, first), self._drawn(view, last)
                if _differing(*ends) > _MOVED:
                    trust = self._mean_trust(view, first, last)
                    found.append(Stretch(view, "frozen", first, last, trust))
        return found

    def _shows(self, view: int, index: int, still: np.ndarray) -> bool:
        return _differing(self._seen(view, index).foreground, still) < _SAME

    def _last_with(self, view: int, indices: Sequence[int], still: np.ndarray) -> int:
        last = indices[0]
        for index in indices[1:]:
            if not self._shows(view, index, still):
                break
            last = index
        return last

    def _shares(self, view: int, indices: np.ndarray) -> tuple[float, float]:
        """Missing and surplus, see `Stretch`."""
        found = []
        looks = np.linspace(0, len(indices) - 1, _LOOKS).round().astype(int)
        for index in np.unique(indices[looks]).tolist():
            seen, model = self._seen(view, index), self._drawn(view, index)
            model = model & seen.observed
            differing = (model & ~seen.foreground, seen.foreground & ~model)
            found.append([np.count_nonzero(d) / max(np.count_nonzero(model), 1) for d in differing])
        missing, surplus = np.mean(found, axis=0).tolist()
        return missing, surplus

    def _seen(self, view: int, index: int) -> Silhouette:
        return self._read(self._frames[index])[view]

    def _drawn(self, view: int, index: int) -> np.ndarray:
        return self._evaluator.silhouettes(self._pose(index))[view]

    def _pose(self, index: int) -> np.ndarray:
        return self._fits[self._frames[index]].pose

    def _mean_trust(self, view: int, first: int, last: int) -> float:
        return float(self._trust[first : last + 1, view].mean())


def _runs(flags: np.ndarray, gap: int) -> list[tuple[int, int]]:
    """First and last index of the stretches where ``flags`` (T,) hold, gaps of ``gap`` bridged."""
    found: list[tuple[int, int]] = []
    for index in np.flatnonzero(flags).tolist():
        if found and index - found[-1][1] <= gap + 1:
            found[-1] = (found[-1][0], index)
        else:
            found.append((index, index))
    return found


def _few_runs(flags: np.ndarray, gap: int, shortest: int) -> list[tuple[int, int]]:
    """The `_runs` that are not too short, joined over wider gaps where they are many."""
    while True:
        found = [run for run in _runs(flags, gap) if run[1] - run[0] + 1 >= shortest]
        if len(found) <= _MOST:
            return found
        gap = 2 * gap + 1


def _median_of_rows(iou: np.ndarray) -> np.ndarray:
    """(T,) over views (T, V), those without anything counting as 0."""
    return np.median(np.nan_to_num(iou), axis=1)


def _differing(one: np.ndarray, other: np.ndarray) -> float:
    """Share of the area of two pictures together that is in one only; 1 where both are empty."""
    together = np.count_nonzero(one | other)
    return np.count_nonzero(one ^ other) / together if together else 1.0
