"""An objective that evaluates whole lines at once.

A direction-set search asks for its values one by one, but always along a line. The kernel is much
quicker with many candidates in one call. So the first question off the current line opens a new
one: its values are computed at fixed distances from where it starts, in one batch, and what
Brent's minimisation asks afterwards is interpolated between them. Close to the start the samples
lie a quarter of a pixel apart: below that the silhouette energy is piecewise constant and finer
questions have no answer (SPEC §5).

Pixel counts tie all the time, and a tie decided by the last bit of a sum would send the same search
to different places under different builds of the numerical libraries. So questions, distances and
answers are rounded, far below anything that can be seen, before they are compared.
"""

from collections.abc import Callable

import numpy as np

BatchEnergy = Callable[[np.ndarray], np.ndarray]
"""(N, n) parameter vectors to (N,) energies."""

_HALF = np.array([0.125, 0.25, 0.375, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0])
SAMPLES = np.concatenate([-_HALF[::-1], [0.0], _HALF])
"""Distances of a line's samples from its start; 1 is the first step, two pixels at the tip."""
_DECIMALS = 6


class LineEnergies:
    """Callable (n,) -> energy for scipy's line searches, over a batched energy.

    Attributes:
        best: (n,) the point of lowest energy among all that were truly evaluated.
        best_energy: its energy.
    """

    def __init__(self, energies: BatchEnergy, start: np.ndarray):
        self._energies = energies
        self.best = np.array(start, float)
        self.best_energy = np.inf
        self._open(self.best, np.zeros(1), self.best * 0.0)

    def __call__(self, point: np.ndarray) -> float:
        """The energy at ``point``, interpolated along the current line."""
        point = np.round(point, _DECIMALS)
        distance = self._distance_along_line(point)
        if distance is None:
            direction = point - self._last
            self._open(self._last, SAMPLES, direction / np.abs(direction).max())
            distance = self._distance_along_line(point)
        self._last = point
        if distance is None or abs(distance) > self._distances[-1]:
            return float(self._evaluated(np.atleast_2d(point))[0])
        return round(float(np.interp(distance, self._distances, self._values)), _DECIMALS)

    def _open(self, start: np.ndarray, distances: np.ndarray, direction: np.ndarray) -> None:
        self._start, self._distances, self._direction = start, distances, direction
        self._last = start
        self._values = self._evaluated(start + distances[:, None] * direction)

    def _distance_along_line(self, point: np.ndarray) -> float | None:
        """How far ``point`` lies from the line's start, or None if it is not on the line."""
        offset = point - self._start
        length = self._direction @ self._direction
        distance = (offset @ self._direction) / length if length else 0.0
        off_line = np.abs(offset - distance * self._direction).max()
        return round(float(distance), _DECIMALS) if off_line < 1e-9 else None

    def _evaluated(self, points: np.ndarray) -> np.ndarray:
        values = np.round(self._energies(points), _DECIMALS)
        lowest = int(np.argmin(values))
        if values[lowest] < self.best_energy:
            self.best, self.best_energy = points[lowest].copy(), float(values[lowest])
        return values
