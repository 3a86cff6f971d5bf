"""Minimising an energy of steps and noise by populations: the covariance-adapting evolution.

Around a mean that moves, candidates are drawn from a normal distribution; the better half of them
draws the mean along, shapes the covariance to the valley they lie in, and lengthens or shortens the
next steps (Hansen 2016, The CMA evolution strategy: a tutorial, arXiv 1604.00772, with its default
weights and rates). It takes many evaluations, all of a generation in one batch, and needs no
gradient: it goes on where searches along single axes stick.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Evolution:
    """How hard to search.

    Attributes:
        population: candidates of a generation.
        generations: at most.
        first_step: standard deviation of the first generation, in units of the basis.
        last_step: where to stop.
    """

    population: int = 100
    generations: int = 200
    first_step: float = 1.0
    last_step: float = 1e-3


def evolved(
    energy: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    basis: np.ndarray,
    settings: Evolution,
    rng: np.random.Generator,
) -> np.ndarray:
    """(D,) the mean of the last generation.

    Args:
        energy: points (N, D) to energies (N,).
        start: (D,) mean of the first generation.
        basis: (D, D) whose columns are steps that change the energy about alike.
        settings: how hard to search.
        rng: draws the candidates.
    """
    size = len(start)
    rates = _Rates.of(size, settings.population)
    mean, step = np.array(start, float), settings.first_step
    covariance, path, long_path = np.eye(size), np.zeros(size), np.zeros(size)
    for _ in range(settings.generations):
        values, axes = np.linalg.eigh(covariance)
        root = (axes * np.sqrt(np.maximum(values, 1e-12))) @ axes.T
        drawn = rng.standard_normal((settings.population, size))
        moves = drawn @ root
        energies = energy(mean + step * moves @ basis.T)
        best = np.argsort(energies, kind="stable")[: len(rates.weights)]
        moved = rates.weights @ moves[best]
        mean = mean + step * basis @ moved
        path = rates.extended(path, rates.path, rates.weights @ drawn[best])
        long_path = rates.extended(long_path, rates.long_path, moved)
        covariance = (
            (1 - rates.spread - rates.line) * covariance
            + rates.line * np.outer(long_path, long_path)
            + rates.spread * (moves[best].T * rates.weights) @ moves[best]
        )
        step *= np.exp(rates.path / rates.damping * (np.linalg.norm(path) / rates.usual - 1))
        if step < settings.last_step:
            break
    return mean


@dataclass(frozen=True, eq=False)
class _Rates:
    """How much is learnt from a generation (Hansen 2016, table 1).

    Attributes:
        weights: (mu,) of the better half, falling, of sum 1.
        mass: how many equal candidates would be worth as much.
        path: of the path that the step's length follows.
        long_path: of the path that the covariance stretches along.
        line: by which it stretches.
        spread: by which the covariance takes on the better half's.
        damping: of the step's changes.
        usual: mean length of a normal vector.
    """

    weights: np.ndarray
    mass: float
    path: float
    long_path: float
    line: float
    spread: float
    damping: float
    usual: float

    @classmethod
    def of(cls, size: int, population: int) -> "_Rates":
        parents = population // 2
        weights = np.log(parents + 0.5) - np.log(np.arange(1, parents + 1))
        weights /= weights.sum()
        mass = float(1 / (weights @ weights))
        path = (mass + 2) / (size + mass + 5)
        line = 2 / ((size + 1.3) ** 2 + mass)
        return cls(
            weights=weights,
            mass=mass,
            path=path,
            long_path=(4 + mass / size) / (size + 4 + 2 * mass / size),
            line=line,
            spread=min(1 - line, 2 * (mass - 2 + 1 / mass) / ((size + 2) ** 2 + mass)),
            damping=1 + 2 * max(0.0, np.sqrt((mass - 1) / (size + 1)) - 1) + path,
            usual=np.sqrt(size) * (1 - 1 / (4 * size) + 1 / (21 * size**2)),
        )

    def extended(self, path: np.ndarray, rate: float, move: np.ndarray) -> np.ndarray:
        """The path with one more move."""
        return (1 - rate) * path + np.sqrt(rate * (2 - rate) * self.mass) * move
