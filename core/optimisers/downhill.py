"""Downhill search: Powell's direction set with Brent's line minimisation.

Theobalt et al. 2003, sections 3 and 6, name this method; scipy provides it. What is added here is
the scale of the steps, in which one unit moves the tip of the searched part by two pixels, and
lines that are evaluated in batches (`LineEnergies`).
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from .line_energies import BatchEnergy, LineEnergies
from .point_energies import PointEnergies


@dataclass(frozen=True)
class Effort:
    """How far a downhill search goes.

    Attributes:
        sweeps: most passes over the direction set.
        tolerance: a pass that lowers the energy by less than this share ends the search.
        whole_lines: whether lines are evaluated in batches, or point by point.
    """

    sweeps: int = 3
    tolerance: float = 2e-3
    whole_lines: bool = True


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where a search ended.

    Attributes:
        point: (n,) the best point evaluated.
        energy: its energy.
    """

    point: np.ndarray
    energy: float


def downhill(
    energies: BatchEnergy, start: np.ndarray, steps: np.ndarray, effort: Effort
) -> Minimum:
    """The best point that Powell's method finds from ``start``.

    Args:
        energies: (N, n) points to (N,) energies.
        start: (n,) first point.
        steps: (n,) size of the first step in each direction, > 0.
        effort: how far to go.
    """
    start = np.asarray(start, float)
    origin = np.zeros(len(start))
    kind = LineEnergies if effort.whole_lines else PointEnergies
    function = kind(lambda units: energies(start + units * steps), origin)
    options = {"maxiter": effort.sweeps, "ftol": effort.tolerance, "xtol": 1e-3}
    minimize(function, origin, method="Powell", options=options)
    return Minimum(start + function.best * steps, function.best_energy)
