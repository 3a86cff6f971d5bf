"""The fewest lies of cameras that explain how outlines and contours lie beside each other.

Every offset of every view, lasting from any moment on, is tried alone; the one that takes away most
of the squared distances is taken, all taken so far are estimated anew, and so on (orthogonal
matching pursuit: Pati, Rezaiifar, Krishnaprasad, Asilomar 1993). A view is named only where no
other would explain the same as well: of two cameras that disagree, neither is.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .view_offsets import OFFSETS

KINDS = {"place": (0, 1, 2), "swelling": (3,), "delay": (4,)}
"""Which of the `OFFSETS` belong together."""
_FEWEST = 3
"""Moments before and after a change."""
_CHANGED = 1.5
"""Times what a lasting offset explains, that one which begins later has to."""
_ALIKE = 0.2
"""Share of what a view's lie explains, that another view's can explain as well."""
_STANDS_OUT = 5.0
"""Times what offsets of the same kind explain in the other views."""
_RIDGE = 1e-9
"""Keeps what nothing tells of at zero."""


@dataclass(frozen=True, eq=False)
class Offset:
    """How a view is beside its place, from some moment on.

    Attributes:
        view: its index.
        kind: one of `KINDS`.
        begin: index of the first moment.
        amounts: of the kind's `OFFSETS`.
        gain: the squared distances it takes away, m^2.
        deviations: of the amounts from 0, in standard deviations as moments tell them.
        rivals: views that may be meant as well.
    """

    view: int
    kind: str
    begin: int
    amounts: np.ndarray
    gain: float
    deviations: float
    rivals: tuple[int, ...] = ()

    @property
    def places(self) -> list[int]:
        """Where its `OFFSETS` are among the unknowns."""
        return [self.view * len(OFFSETS) + index for index in KINDS[self.kind]]


class OffsetSearch:
    """Searches the offsets of V views in T moments.

    Args:
        squares: (T, P, P) normal equations as of `OffsetEquations`.
        slopes: (T, P).
    """

    def __init__(self, squares: np.ndarray, slopes: np.ndarray):
        self._squares, self._slopes = squares, slopes
        self._from = np.cumsum(squares[::-1], axis=0)[::-1]
        self._slopes_from = np.cumsum(slopes[::-1], axis=0)[::-1]
        self.views = slopes.shape[1] // len(OFFSETS)

    def found(self, is_enough: Callable[[Offset], bool]) -> list[Offset]:
        """The offsets of fewer than half of the views, strongest first.

        The last one may have rivals. ``is_enough`` says of an `Offset` whether it is worth telling.
        """
        offsets: list[Offset] = []
        while True:
            tried = self._tried_all(offsets)
            worth = [offset for kind in KINDS for offset in tried[kind] if is_enough(offset)]
            for best in sorted(worth, key=lambda offset: -offset.gain):
                liars = {offset.view for offset in (*offsets, best)}
                rivals = self._rivals(best)
                usual = [o.gain for o in tried[best.kind] if o.view not in {*liars, *rivals}]
                if best.gain > _STANDS_OUT * np.median(usual or [0.0]):
                    break
            else:
                return offsets
            if rivals:
                return [*offsets, replace(best, rivals=rivals)]
            if 2 * len(liars) >= self.views:
                return offsets
            offsets = self._estimated([*offsets, best])

    def _rivals(self, best: Offset) -> tuple[int, ...]:
        """Views whose lies would look like the ``best`` one: they explain most of what it does."""
        squares, own = self._from[best.begin], best.places
        whole = best.amounts @ squares[np.ix_(own, own)] @ best.amounts
        rivals = []
        for view in range(self.views):
            shares = [0.0]
            for kind in KINDS if view != best.view else ():
                places = replace(best, view=view, kind=kind).places
                slopes = squares[np.ix_(places, own)] @ best.amounts
                inner = squares[np.ix_(places, places)] + _RIDGE * np.eye(len(places))
                shares.append(slopes @ np.linalg.solve(inner, slopes) / whole)
            if max(shares) > _ALIKE:
                rivals.append(view)
        return tuple(rivals)

    def unknowns(self, offsets: Sequence[Offset]) -> np.ndarray:
        """(T, P) with the offsets, and the girth that goes with them."""
        moments, count = self._slopes.shape
        unknowns = np.zeros((moments, count))
        for offset, amounts in zip(offsets, self._solved(offsets), strict=False):
            unknowns[offset.begin :, offset.places] += amounts
        unknowns[:, -1] = self._solved(offsets)[-1]
        return unknowns

    def _solved(self, offsets: Sequence[Offset]) -> list[np.ndarray]:
        """The amounts of each offset, estimated together, and the girth (1,)."""
        counts = [len(offset.places) for offset in offsets]
        places = np.array([*(p for offset in offsets for p in offset.places), -1])
        begins = np.array([*np.repeat([offset.begin for offset in offsets], counts), 0], int)
        both = np.maximum(begins[:, None], begins)
        squares = self._from[both, places[:, None], places]
        squares += _RIDGE * np.eye(len(places))
        solution = -np.linalg.solve(squares, self._slopes_from[begins, places])
        return np.split(solution, np.cumsum(counts))

    def _estimated(self, offsets: Sequence[Offset]) -> list[Offset]:
        amounts = self._solved(offsets)
        return [replace(o, amounts=a) for o, a in zip(offsets, amounts, strict=False)]

    def _tried_all(self, offsets: Sequence[Offset]) -> dict[str, list[Offset]]:
        """What each kind explains beyond the ``offsets``, view by view."""
        unknowns = self.unknowns(offsets)
        slopes = self._slopes + (self._squares @ unknowns[:, :, None])[:, :, 0]
        return {
            kind: [self._best(slopes, view, kind) for view in range(self.views)] for kind in KINDS
        }

    def _best(self, slopes: np.ndarray, view: int, kind: str) -> Offset:
        """What one kind of offset explains of ``slopes`` (T, P), whenever it begins."""
        later = range(_FEWEST, len(slopes) - _FEWEST + 1)
        lasting, *others = (self._tried(slopes, view, kind, begin) for begin in (0, *later))
        best = max(others, key=lambda offset: offset.gain, default=lasting)
        return best if best.gain > _CHANGED * lasting.gain else lasting

    def _tried(self, slopes: np.ndarray, view: int, kind: str, begin: int) -> Offset:
        offset = Offset(view, kind, begin, np.zeros(len(KINDS[kind])), 0.0, 0.0)
        places = offset.places
        squares = self._from[begin][np.ix_(places, places)] + _RIDGE * np.eye(len(places))
        own = slopes[begin:, places]
        amounts = -np.linalg.solve(squares, own.sum(axis=0))
        apart = own + self._squares[begin:][:, places][:, :, places] @ amounts
        spread, gained = apart.T @ apart, own.sum(axis=0)
        spread += _RIDGE * (1.0 + np.trace(spread)) * np.eye(len(places))
        return replace(
            offset,
            amounts=amounts,
            gain=float(-gained @ amounts) / 2,
            deviations=float(np.sqrt(gained @ np.linalg.solve(spread, gained))),
        )
