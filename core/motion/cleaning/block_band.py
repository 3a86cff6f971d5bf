"""Least squares over time in which frames couple with their next two alone."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solveh_banded

_SECOND = np.array([1.0, -2.0, 1.0])


@dataclass(frozen=True, eq=False)
class BlockBand:
    """The normal equations of T frames with K values each, as far as they were added up.

    Attributes:
        within: (T, K, K) of a frame with itself.
        across: (T - 1, K, K) of the next frame (rows) with a frame (columns).
        beyond: (T - 2, K) of the frame after the next with a frame, value by value.
        right: (T, K) right side.
    """

    within: np.ndarray
    across: np.ndarray
    beyond: np.ndarray
    right: np.ndarray

    @classmethod
    def zero(cls, frames: int, values: int) -> "BlockBand":
        """Without any term."""
        return cls(
            np.zeros((frames, values, values)),
            np.zeros((max(frames - 1, 0), values, values)),
            np.zeros((max(frames - 2, 0), values)),
            np.zeros((frames, values)),
        )

    def add_smoothness(self, stiffness: np.ndarray, penalty: float) -> None:
        """Adds sum_t stiffness (|x_t|^2 + penalty |x_(t-1) - 2 x_t + x_(t+1)|^2) per value.

        The stiffness is (K,).
        """
        frames, values = self.right.shape
        own, diagonal = np.zeros(frames), np.arange(values)
        own[:] = 1.0
        inner = frames - 2
        for row in range(3 if inner > 0 else 0):
            own[row : row + inner] += penalty * _SECOND[row] ** 2
        next_ = np.zeros(max(frames - 1, 0))
        for row in range(2 if inner > 0 else 0):
            next_[row : row + inner] += penalty * _SECOND[row] * _SECOND[row + 1]
        self.within[:, diagonal, diagonal] += own[:, None] * stiffness
        self.across[:, diagonal, diagonal] += next_[:, None] * stiffness
        self.beyond[:] += penalty * stiffness

    def add_frames(self, slopes: np.ndarray, wanted: np.ndarray, weights: np.ndarray) -> None:
        """Adds sum weights |slopes x_t - wanted|^2 of wanted and weights (T, P).

        Slopes are (T, P, K), or (P, K) for all frames alike.
        """
        weighted = slopes * weights[..., None]
        self.within[:] += weighted.transpose(0, 2, 1) @ slopes
        self.right[:] += np.einsum("tpk,tp->tk", weighted, wanted)

    def add_pairs(
        self, here: np.ndarray, there: np.ndarray, wanted: np.ndarray, weights: np.ndarray
    ) -> None:
        """Adds sum weights |there x_(t+1) - here x_t - wanted|^2; all of T - 1 frames."""
        weighted_here, weighted_there = here * weights[..., None], there * weights[..., None]
        self.within[:-1] += weighted_here.transpose(0, 2, 1) @ here
        self.within[1:] += weighted_there.transpose(0, 2, 1) @ there
        self.across[:] -= weighted_there.transpose(0, 2, 1) @ here
        self.right[:-1] -= np.einsum("tpk,tp->tk", weighted_here, wanted)
        self.right[1:] += np.einsum("tpk,tp->tk", weighted_there, wanted)

    def solved(self) -> np.ndarray:
        """(T, K) the minimum."""
        frames, values = self.right.shape
        band = np.zeros((2 * values + 1, frames, values))
        for column in range(values):
            rows = np.arange(column, values)
            band[rows - column, :, column] = self.within[:, rows, column].T
            rows = np.arange(values)
            band[values + rows - column, :-1, column] = self.across[:, rows, column].T
        band[2 * values, :-2] = self.beyond
        flat = band.reshape(len(band), -1)
        return solveh_banded(flat, self.right.ravel(), lower=True).reshape(frames, values)
