"""The filters that may take the place of the refit: Butterworth both ways, and One-Euro."""

from collections.abc import Callable

import numpy as np
from scipy.signal import butter, sosfiltfilt

_SPEED_CUT_OFF_HZ = 1.0
_CUT_OFF_PER_SPEED = 4.0
"""Hz for each rad/s or m/s."""


def butterworth(values: np.ndarray, rate: float, cut_off: float) -> np.ndarray:
    """(T, K) ``values`` filtered by second order, forwards and backwards: without any delay.

    Half the amplitude is left at ``cut_off`` Hz, as the filter is run twice.
    """
    sections = butter(2, cut_off, fs=rate, output="sos")
    # the ends are turned about themselves, over a period of the cut-off
    padding = min(len(values) - 1, int(np.ceil(rate / cut_off)) + 3)
    return sosfiltfilt(sections, values, axis=0, padlen=padding)


def one_euro(values: np.ndarray, rate: float, cut_off: float) -> np.ndarray:
    """(T, K) ``values`` as a filter gives them that knows the past alone, so with some delay.

    ``cut_off`` Hz hold while nothing moves and rise with the speed (Casiez, Roussel, Vogel:
    1 Euro Filter, CHI 2012).
    """
    found, speed = np.array(values, float), np.zeros(values.shape[1])
    change = _share(_SPEED_CUT_OFF_HZ, rate)
    for t in range(1, len(values)):
        speed += change * ((values[t] - values[t - 1]) * rate - speed)
        share = _share(cut_off + _CUT_OFF_PER_SPEED * float(np.linalg.norm(speed)), rate)
        found[t] = found[t - 1] + share * (values[t] - found[t - 1])
    return found


def _share(cut_off: float, rate: float) -> float:
    """How much of a new value a first-order low-pass takes."""
    return 1.0 / (1.0 + rate / (2 * np.pi * cut_off))


OTHER_FILTERS: dict[str, Callable[[np.ndarray, float, float], np.ndarray]] = {
    "butterworth": butterworth,
    "one-euro": one_euro,
}
"""All but the refit: (T, K) values, frames per second, cut-off in Hz."""
