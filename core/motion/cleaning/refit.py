"""A smooth curve through uncertain values: the whole take at once, acceleration penalised.

The curve x minimises

    sum_t w_t |x_t - y_t|^2 + penalty * sum_t |x_(t-1) - 2 x_t + x_(t+1)|^2

(Whittaker 1923, the discrete smoothing spline). Where all w are 1 a sine of frequency f keeps

    1 / (1 + (sin(pi f / rate) / sin(pi cut_off / rate))^4)

of its amplitude, half of it at the cut-off: the gain of a Butterworth filter of second order run
forwards and backwards, but with ends that need no padding, weights, and frames that are held. The
penalty follows from cut-off and rate, so that the frame rate changes nothing.

Gaps, frames of hardly any weight, are bridged with the least acceleration; a little tension there
keeps long ones from swinging out. Single wrong values are those that nobody could reach and leave
again within a frame; they lose weight until nothing changes (iteratively reweighted least squares).
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded

_SECOND = np.array([1.0, -2.0, 1.0])
_GAP_WEIGHT = 1e-9
_TENSION_S = 0.25
"""Within a gap speed changes over this time where only tension is left."""
_ROUNDS = 8
_OUTLIER_SPREADS = 5.0
_MEDIAN_SPREADS = 1.4826
_FREQUENCIES = 256


@dataclass(frozen=True, eq=False)
class Refit:
    """How curves over T frames are fitted.

    Attributes:
        rate: frames per second.
        cut_off: Hz, below half the rate.
        weights: (T,) above 0 and at most 1.
        gaps: (T,) bool, frames whose values count for nothing.
        held: (T,) bool, frames whose values stay as they are.
    """

    rate: float
    cut_off: float
    weights: np.ndarray
    gaps: np.ndarray
    held: np.ndarray

    @property
    def penalty(self) -> float:
        """Of the squared second difference."""
        return (2 * np.sin(np.pi * self.cut_off / self.rate)) ** -4

    def curve(self, values: np.ndarray, fastest: float) -> np.ndarray:
        """(T, K) the curve through ``values`` (T, K).

        A value counts as wrong that is off the curve by more than five times what others are, and
        by more than an acceleration of ``fastest`` per s² explains.
        """
        weights = np.where(self.gaps, _GAP_WEIGHT, self.weights)
        # how far a frame of that acceleration is out of its neighbours' line, and the curve not
        usual = fastest / (2 * self.rate**2) * (1 - self._own_share())
        found, trust = self._solved(values, weights), np.ones(len(values))
        for _ in range(_ROUNDS):
            before, trust = trust, self._trust(np.linalg.norm(values - found, axis=1), usual)
            if np.allclose(trust, before, rtol=0, atol=1e-3):
                break
            found = self._solved(values, weights * trust)
        return found

    def _own_share(self) -> float:
        """How much of a single value that is off the curve goes after, where all weights are 1."""
        squares = (2 * np.sin(np.linspace(0, np.pi / 2, _FREQUENCIES))) ** 4
        return float(np.mean(1 / (1 + self.penalty * squares)))

    def pinned(self, values: np.ndarray, held_values: np.ndarray) -> np.ndarray:
        """Values (T, K) bent smoothly to ``held_values`` (T, K) in the frames that are held."""
        away = np.where(self.held[:, None], held_values - values, 0.0)
        return values + self._solved(away, np.ones(len(values)))

    def _trust(self, off: np.ndarray, usual: float) -> np.ndarray:
        """(T,) factors of the weights of values that are ``off`` (T,) the curve by so much."""
        judged = off[~(self.gaps | self.held)]
        spread = _MEDIAN_SPREADS * np.median(judged) if len(judged) else 0.0
        return np.minimum(1.0, max(usual, _OUTLIER_SPREADS * spread) / np.maximum(off, 1e-12)) ** 2

    def _solved(self, values: np.ndarray, weights: np.ndarray) -> np.ndarray:
        band, right = self._smoothness(len(values)), weights[:, None] * values
        band[0] += weights
        for below in (1, 2):
            entries = band[below, :-below]
            upper, lower = self.held[:-below, None], self.held[below:, None]
            # what is held moves to the right side of its neighbours' equations
            right[below:] -= np.where(upper, entries[:, None] * values[:-below], 0.0)
            right[:-below] -= np.where(lower, entries[:, None] * values[below:], 0.0)
            entries[(upper | lower)[:, 0]] = 0.0
        band[0, self.held] = 1.0
        right[self.held] = values[self.held]
        return solveh_banded(band, right, lower=True)

    def _smoothness(self, count: int) -> np.ndarray:
        """(3, T) lower bands of the matrix of the penalties of acceleration and tension."""
        band = np.zeros((3, max(count, 3)))
        for row in range(3):
            for column in range(row + 1):
                ones = self.penalty * _SECOND[row] * _SECOND[column]
                band[row - column, column : column + max(count - 2, 0)] += ones
        band = band[:, :count]
        tension = self.penalty / (_TENSION_S * self.rate) ** 2 * (self.gaps[1:] | self.gaps[:-1])
        band[0, :-1] += tension
        band[0, 1:] += tension
        band[1, :-1] -= tension
        return band
