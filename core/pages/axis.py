"""Axes of charts: where they end and what they are labelled with."""

from dataclasses import dataclass

import numpy as np

_STEPS = (1.0, 2.0, 5.0, 10.0)
_FRAME_PIECES = 8


@dataclass(frozen=True)
class Axis:
    """A linear scale.

    Attributes:
        low: value at its start.
        high: value at its end, above ``low``.
        pieces: how many parts the marks divide it into at most.
    """

    low: float
    high: float
    pieces: int = 5

    def shares(self, values: np.ndarray) -> np.ndarray:
        """Where ``values`` lie, 0 at the start and 1 at the end."""
        return (values - self.low) / (self.high - self.low)

    @property
    def step(self) -> float:
        """Distance between marks: 1, 2 or 5 times a power of ten."""
        rough = (self.high - self.low) / self.pieces
        power = 10.0 ** np.floor(np.log10(rough))
        return float(power * next(s for s in _STEPS if s * power >= rough * (1 - 1e-9)))

    @property
    def marks(self) -> list[float]:
        """Round values from start to end."""
        first, last = np.ceil(self.low / self.step - 1e-9), np.floor(self.high / self.step + 1e-9)
        return [float(k * self.step + 0.0) for k in np.arange(first, last + 1)]

    def label(self, value: float) -> str:
        """A mark's text, with as many decimals as the step needs."""
        digits = max(0, int(-np.floor(np.log10(self.step) + 1e-9)))
        return f"{value:.{digits}f}".replace("-", "−")


def value_axis(values: np.ndarray, low: float | None = None, high: float | None = None) -> Axis:
    """An axis that holds all finite ``values`` and ends at round ones.

    Args:
        values: of any shape.
        low: a fixed start; None for a round value below all.
        high: a fixed end; None for a round value above all.
    """
    finite = values[np.isfinite(values)]
    least, most = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    start = least if low is None else low
    end = most if high is None else high
    if end <= start:
        start, end = (start, start + 1.0) if high is None else (end - 1.0, end)
    step = Axis(start, end).step
    if low is None:
        start = float(np.floor(start / step + 1e-9) * step)
    if high is None:
        end = float(np.ceil(end / step - 1e-9) * step)
    return Axis(start, end)


def frame_axis(frames: np.ndarray) -> Axis:
    """The axis of ``frames`` (T,), T >= 1, from the first to the last."""
    first, last = float(frames[0]), float(frames[-1])
    if last == first:
        return Axis(first - 0.5, first + 0.5)
    return Axis(first, last, _FRAME_PIECES)
