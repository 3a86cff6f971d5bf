"""An objective that evaluates the points it is asked for, one by one, each once.

For counting what a search needs: `LineEnergies` is quicker and asks for more. Questions are moved
to the nearest point of a lattice an eighth of a step (a quarter of a pixel) wide, below which the
silhouette energy is piecewise constant (SPEC §5), and answered from memory the second time.
"""

import numpy as np

from .line_energies import BatchEnergy

_SPACING = 0.125


class PointEnergies:
    """Callable (n,) -> energy for scipy's line searches.

    Attributes:
        best: (n,) the lattice point of lowest energy so far.
        best_energy: its energy.
    """

    def __init__(self, energies: BatchEnergy, start: np.ndarray):
        self._energies = energies
        self._known: dict[bytes, float] = {}
        self.best = np.array(start, float)
        self.best_energy = np.inf

    def __call__(self, point: np.ndarray) -> float:
        """The energy at the lattice point nearest to ``point``."""
        # + 0.0: a zero has one form only
        place = np.rint(point.round(6) / _SPACING) + 0.0
        key = place.tobytes()
        energy = self._known.get(key)
        if energy is None:
            nearest = place * _SPACING
            energy = self._known[key] = float(self._energies(nearest[None])[0])
            if energy < self.best_energy:
                self.best, self.best_energy = nearest, energy
        return energy
