"""Downhill search: Powell's direction set with Brent's line minimisation.

Theobalt et al. 2003, sections 3 and 6, name this method; scipy provides it. What is added here is
the scale of the steps, in which one unit moves the tip of the searched part by two pixels, and
lines that are evaluated in batches (`LineEnergies`).
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from .line_energies import BatchEnergy, LineEnergies


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where a search ended.

    Attributes:
        point: (n,) the best point evaluated.
        energy: its energy.
        evaluations: how many points were evaluated.
    """

    point: np.ndarray
    energy: float
    evaluations: int


def downhill(
    energies: BatchEnergy, start: np.ndarray, steps: np.ndarray, sweeps: int, tolerance: float
) -> Minimum:
    """The best point that Powell's method finds from ``start``.

    Args:
        energies: (N, n) points to (N,) energies.
        start: (n,) first point.
        steps: (n,) size of the first step in each direction, > 0.
        sweeps: most passes over the direction set.
        tolerance: a pass that lowers the energy by less than this share ends the search.
    """
    start = np.asarray(start, float)
    line_energies = LineEnergies(
        lambda units: energies(start + units * steps), np.zeros(len(start))
    )
    minimize(
        line_energies,
        np.zeros(len(start)),
        method="Powell",
        options={"maxiter": sweeps, "ftol": tolerance, "xtol": 1e-3},
    )
    return Minimum(
        start + line_energies.best * steps, line_energies.best_energy, line_energies.evaluations
    )
