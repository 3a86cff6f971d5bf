"""Stretches of a tracked take in which a camera shows nobody, stands still, or is not trusted.

Where to look is told by the scores of the fits, so that only few frames are read again.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ..energy.evaluator import Evaluator
from ..silhouettes.silhouette import Silhouette
from .tracking import FrameFit

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
_DOUBTED, _IGNORED = 0.6, 0.4
"""Trust in a view under which something may be wrong, and is worth telling."""
_SAME, _MOVED = 0.01, 0.1
"""Share of the area that differs between pictures that are the same, and of a model that moved."""
_GAP, _SHORTEST, _BAD = 3, 2, 5
"""Frames: between stretches that are one, of a stretch, and of one with bad silhouettes."""
_LOOKS = 5


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
        fits: in the order of their frames.
        read: gives the silhouettes.
    """

    def __init__(self, evaluator: Evaluator, fits: Sequence[FrameFit], read: Read):
        self._evaluator, self._fits, self._read = evaluator, fits, read
        self._trust = np.stack([fit.scores.view_weights for fit in fits])
        self._iou = np.stack([fit.scores.iou for fit in fits])
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
        """Where one of ``views`` is hardly trusted, and it is not known why."""
        found = []
        for view in views:
            doubted = (self._trust[:, view] < _DOUBTED) & ~self.silent[:, view]
            for first, last in runs(doubted, _GAP):
                trust = self._mean_trust(view, first, last)
                if last - first + 1 >= _BAD and trust < _IGNORED:
                    shares = self._shares(view, first, last)
                    found.append(Stretch(view, "bad", first, last, trust, *shares))
        return found

    def _dead(self, view: int) -> list[Stretch]:
        others = np.delete(self._iou, view, axis=1)
        tracked = np.nanmedian(np.where(np.isfinite(others), others, 0.0), axis=1) > _TRACKED
        apart = (self._iou[:, view] < _APART) & tracked
        return [
            Stretch(view, "dead", first, last, self._mean_trust(view, first, last))
            for first, last in runs(apart, 0)
            if last - first + 1 >= _SHORTEST and self._shows_nobody(view, (first + last) // 2)
        ]

    def _shows_nobody(self, view: int, index: int) -> bool:
        drawn = np.count_nonzero(self._drawn(view, index))
        seen = np.count_nonzero(self._seen(view, index).foreground)
        camera = self._evaluator.cameras[view]
        root = self._evaluator.transforms(self._fits[index].pose[None])[0, 0, :, 3]
        metre = float(camera.depths(root)) / camera.matrix[0, 0]
        return drawn * metre**2 > _VISIBLE_M2 and seen < _NOBODY * drawn

    def _frozen(self, view: int) -> list[Stretch]:
        doubted = (self._trust[:, view] < _DOUBTED) & ~self.silent[:, view]
        found: list[Stretch] = []
        for begin, end in runs(doubted, _GAP):
            if end - begin + 1 < _SHORTEST or any(s.first <= begin <= s.last for s in found):
                continue
            early, middle, late = (round(begin + k * (end - begin) / 4) for k in (1, 2, 3))
            still = self._seen(view, middle).foreground
            if all(self._shows(view, index, still) for index in (early, late)):
                first = self._last_with(view, range(early, -1, -1), still)
                last = self._last_with(view, range(late, len(self._fits)), still)
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

    def _shares(self, view: int, first: int, last: int) -> tuple[float, float]:
        """Missing and surplus, see `Stretch`."""
        found = []
        for index in np.unique(np.linspace(first, last, _LOOKS).round().astype(int)).tolist():
            seen, model = self._seen(view, index), self._drawn(view, index)
            model = model & seen.observed
            differing = (model & ~seen.foreground, seen.foreground & ~model)
            found.append([np.count_nonzero(d) / max(np.count_nonzero(model), 1) for d in differing])
        missing, surplus = np.mean(found, axis=0).tolist()
        return missing, surplus

    def _seen(self, view: int, index: int) -> Silhouette:
        return self._read(self._fits[index].frame)[view]

    def _drawn(self, view: int, index: int) -> np.ndarray:
        return self._evaluator.silhouettes(self._fits[index].pose)[view]

    def _mean_trust(self, view: int, first: int, last: int) -> float:
        return float(self._trust[first : last + 1, view].mean())


def runs(flags: np.ndarray, gap: int) -> list[tuple[int, int]]:
    """First and last index of the stretches where ``flags`` (T,) hold, gaps of ``gap`` bridged."""
    found: list[tuple[int, int]] = []
    for index in np.flatnonzero(flags).tolist():
        if found and index - found[-1][1] <= gap + 1:
            found[-1] = (found[-1][0], index)
        else:
            found.append((index, index))
    return found


def _differing(one: np.ndarray, other: np.ndarray) -> float:
    """Share of the area of two pictures together that is in one only; 1 where both are empty."""
    together = np.count_nonzero(one | other)
    return np.count_nonzero(one ^ other) / together if together else 1.0
