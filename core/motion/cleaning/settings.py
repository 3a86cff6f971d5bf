"""What is asked of a cleaning."""

from dataclasses import dataclass
from fractions import Fraction

from ...errors import MocapError

REFIT = "refit"
FILTERS = (REFIT, "butterworth", "one-euro")
_USUAL_HZ = {REFIT: 6.0, "butterworth": 6.0, "one-euro": 3.0}
_MOST_OF_RATE = 0.4
"""A usual cut-off is lowered to this share of the frame rate."""


@dataclass(frozen=True)
class CleanSettings:
    """How a motion is cleaned.

    Attributes:
        filter: one of `FILTERS`.
        smooth_hz: the frequency of which half the amplitude is left, where the fit is sure of
            itself; for one-euro the cut-off of what stands still. None for the filter's usual one.
        contacts: whether feet are held where they touch the floor.
        keys_mm: how far key reduction may move any of the 14 points; None keeps every frame a key.

    Raises:
        MocapError: an unknown filter, or a number that is not above 0.
    """

    filter: str = REFIT
    smooth_hz: float | None = None
    contacts: bool = True
    keys_mm: float | None = None

    def __post_init__(self):
        if self.filter not in FILTERS:
            raise MocapError(f"there is no filter {self.filter!r}", f"use {', '.join(FILTERS)}")
        numbers = (
            ("a cut-off", self.smooth_hz, "Hz, such as --smooth 6"),
            ("a tolerance of keys", self.keys_mm, "mm, such as --keys 5"),
        )
        for name, value, remedy in numbers:
            if value is not None and not 0 < value < float("inf"):
                raise MocapError(f"{name} of {value:g} is none", f"give it in {remedy}")

    def cut_off(self, rate: Fraction) -> float:
        """Hz, for a motion of ``rate`` frames per second.

        Raises:
            MocapError: as much as half the frame rate or more was asked for.
        """
        usual = min(_USUAL_HZ[self.filter], _MOST_OF_RATE * float(rate))
        asked = usual if self.smooth_hz is None else self.smooth_hz
        highest = float(rate) / 2
        if asked >= highest:
            raise MocapError(
                f"a cut-off of {asked:g} Hz is not below {highest:g} Hz, half the take's "
                f"{float(rate):g} frames per second",
                f"give --smooth less, such as {usual:g}, or leave it out",
            )
        return asked
