"""The unit of length of a calibration, told from how far apart the cameras stand.

Most files do not say whether they mean metres or millimetres, and the user's word may be wrong:
whatever unit is taken has to put the cameras around a person.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import MocapError

METRES_PER_UNIT = {"m": 1.0, "cm": 0.01, "mm": 0.001}
_WIDEST_ROOM = 50.0
# beyond these nobody can be filmed: from a pair of small cameras to a stadium
_NEAREST, _FARTHEST = 0.02, 200.0
_LIKELY = (0.3, _WIDEST_ROOM)


@dataclass(frozen=True, eq=False)
class Placing:
    """Where the V cameras of a file stand.

    Attributes:
        names: V names.
        centres: (V, 3) in the file's unit.
    """

    names: tuple[str, ...]
    centres: np.ndarray

    @property
    def spread(self) -> float:
        """The greatest distance between two cameras; of a single one, from the origin."""
        if len(self.centres) == 1:
            return float(np.linalg.norm(self.centres[0]))
        return float(self._distances().max())

    def guessed_unit(self) -> str:
        """Millimetres where metres would put the cameras further apart than rooms are wide."""
        return "mm" if self._typical() > _WIDEST_ROOM else "m"

    def check(self, unit: str, file: Path) -> None:
        """Refuses a ``unit`` in which no performer could stand amid the cameras.

        Raises:
            MocapError: cameras kilometres or millimetres apart.
        """
        if len(self.names) < 2:
            return
        metres = METRES_PER_UNIT[unit]
        nearest = (self._distances() + np.diag(np.full(len(self.names), np.inf))).min(axis=1)
        far = nearest * metres > _FARTHEST
        if far.any() and not far.all():
            name = self.names[int(np.argmax(nearest))]
            raise MocapError(
                f"stands {_shown(nearest.max() * metres)} from the nearest other camera",
                f"calibrate it again, or leave it out with --without {name}",
                file=file, camera=name,
            )  # fmt: skip
        if self.spread * metres < _NEAREST or self._typical() * metres > _FARTHEST:
            typical = self._typical()
            raise MocapError(
                f"taken as {unit}, the cameras stand {_shown(typical * metres)} apart",
                _better_unit(typical), file=file,
            )  # fmt: skip

    def _distances(self) -> np.ndarray:
        return np.linalg.norm(self.centres[:, None] - self.centres, axis=2)

    def _typical(self) -> float:
        """The median distance between two cameras, which one stray camera does not change."""
        if len(self.names) < 2:
            return self.spread
        return float(np.median(self._distances()[np.triu_indices(len(self.names), 1)]))


def _better_unit(distance: float) -> str:
    for unit, metres in METRES_PER_UNIT.items():
        if _LIKELY[0] <= distance * metres <= _LIKELY[1]:
            return (
                f'write units = "{unit}" in [cameras], which would make that '
                f"{_shown(distance * metres)}"
            )
    units = ", ".join(METRES_PER_UNIT)
    return f"calibrate again, or scale the file so that units = one of {units} in [cameras] fits"


def _shown(metres: float) -> str:
    if metres >= 1000:
        return f"{metres / 1000:.3g} km"
    return f"{metres:.2f} m" if metres >= 0.1 else f"{metres * 1000:.3g} mm"
