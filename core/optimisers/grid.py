"""Grid search: the starting point for a downhill search (Theobalt et al. 2003, section 3)."""

import numpy as np

from .downhill import Minimum
from .line_energies import BatchEnergy


def grid_points(centre: np.ndarray, half_width: float, steps: int, axes: np.ndarray) -> np.ndarray:
    """(steps ** len(axes), n) regular points about ``centre`` (n,), varied along ``axes`` only."""
    ticks = np.linspace(-half_width, half_width, steps)
    offsets = np.stack(np.meshgrid(*[ticks] * len(axes), indexing="ij"), -1).reshape(-1, len(axes))
    points = np.repeat(centre[None], len(offsets), axis=0)
    points[:, axes] += offsets
    return points


def lowest(energies: BatchEnergy, points: np.ndarray) -> Minimum:
    """The point of lowest energy among ``points`` (N, n); the first of equals."""
    values = energies(points)
    best = int(np.argmin(values))
    return Minimum(points[best].copy(), float(values[best]))
