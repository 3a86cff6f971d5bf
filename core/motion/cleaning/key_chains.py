"""The fewest keys of one joint whose curves stay near its motion.

A curve (`curves`), with the slopes of the motion itself, may lead from one key to the next if it
displaces nothing by more than an allowance. Of all chains of such curves the shortest is found by
dynamic programming (after Perez and Vidal: Optimum polygonal approximation of digitized curves,
1994).
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ..curves import components, hermite, slopes

_LONGEST_S, _LENGTHS, _SAMPLES = 2.0, 40, 12
"""Of a curve: seconds, how many lengths are tried, and in how many frames it is compared."""
_TIE = 1e-3
"""Of chains with as many keys, the one nearer to the motion."""


@dataclass(frozen=True, eq=False)
class Track:
    """One joint's motion as it is keyed.

    Attributes:
        values: (T, 7) see `components`.
        slopes: (T, 7) per frame.
        reach: metres to the end of what hangs on the joint.
    """

    values: np.ndarray
    slopes: np.ndarray
    reach: float

    @classmethod
    def of(cls, motions: np.ndarray, reach: float) -> "Track":
        """Of a joint's own motions (T, 3, 4)."""
        values = components(motions)
        return cls(values, slopes(values), reach)

    def displacements(self, length: int) -> np.ndarray:
        """(T - length,) metres that curves over so many frames displace at most in between."""
        inside = np.unique(np.linspace(1, length - 1, _SAMPLES).round().astype(int))
        ends = (self.values[:-length], self.values[length:])
        slopes_ = (self.slopes[:-length] * length, self.slopes[length:] * length)
        worst = np.zeros(len(ends[0]))
        for frame in inside[(inside > 0) & (inside < length)].tolist():
            curve = hermite(ends, slopes_, frame / length)
            there = self.values[frame : frame + len(worst)]
            turns = curve[:, :4] / np.linalg.norm(curve[:, :4], axis=1, keepdims=True)
            chords = np.linalg.norm(turns - there[:, :4], axis=1)
            angles = 4 * np.arcsin(np.minimum(chords / 2, 1.0))
            shifts = np.linalg.norm(curve[:, 4:] - there[:, 4:], axis=1)
            worst = np.maximum(worst, self.reach * angles + shifts)
        return worst


@dataclass(frozen=True, eq=False)
class Chains:
    """All curves between keys of J joints.

    Attributes:
        lengths: (N,) frames that curves span, rising from 1.
        displacements: (T, N, J) metres, of the curve of each length that ends at a frame; infinite
            where it would begin before the motion or lead over a frame that must be a key.
    """

    lengths: np.ndarray
    displacements: np.ndarray

    @classmethod
    def of(cls, tracks: Iterable[Track], fixed: np.ndarray, lengths: np.ndarray) -> "Chains":
        """Those of ``tracks``, with the frames ``fixed`` (T,) as keys."""
        frames = np.arange(len(fixed))
        last_fixed = np.maximum.accumulate(np.where(np.r_[False, fixed[:-1]], frames - 1, 0))
        barred = frames[:, None] - lengths < last_fixed[:, None]
        joints = []
        for track in tracks:
            displacements = np.full(barred.shape, np.inf)
            for column, length in enumerate(lengths.tolist()):
                displacements[length:, column] = track.displacements(length)
            joints.append(np.where(barred, np.inf, displacements))
        return cls(lengths, np.stack(joints, axis=2))

    def fewest(self, allowance: float) -> np.ndarray:
        """(T, J) bool, keys of the shortest chains of curves that displace by ``allowance`` m."""
        share = self.displacements / allowance
        costs = np.where(share <= 1, 1 + _TIE * share, np.inf)
        # neighbours are always joined: nothing lies between
        costs[1:, 0] = 1.0
        best = np.zeros((len(costs), costs.shape[2]))
        via = np.zeros(best.shape, int)
        for frame in range(1, len(costs)):
            reachable = int(np.searchsorted(self.lengths, frame, "right"))
            totals = best[frame - self.lengths[:reachable]] + costs[frame, :reachable]
            via[frame] = self.lengths[totals.argmin(axis=0)]
            best[frame] = totals.min(axis=0)
        return np.column_stack([_walked_back(column) for column in via.T])


def _walked_back(via: np.ndarray) -> np.ndarray:
    """(T,) bool, the keys of the chain whose last curve to each frame spans ``via`` (T,) frames."""
    keyed, frame = np.zeros(len(via), bool), len(via) - 1
    while frame > 0:
        keyed[frame], frame = True, frame - via[frame]
    keyed[0] = True
    return keyed


def curve_lengths(rate: float, frames: int) -> np.ndarray:
    """(N,) frames that curves may span, rising from 1, of a motion of so many frames."""
    longest = min(max(2.0, _LONGEST_S * rate), max(frames - 1, 1))
    return np.unique(np.geomspace(1, longest, _LENGTHS).round().astype(int))
