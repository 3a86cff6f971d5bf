"""How long work tells its caller how far it is; the caller decides what to show."""

import math
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True)
class FrameFigures:
    """What is known of a frame that was just fitted.

    Attributes:
        seconds: time the fit took.
        evaluations: poses that were rendered.
        iou: intersection over union by camera; NaN where nothing was observed.
        xor_px: px that differ by camera.
        lost: whether the pose is not to be trusted.
    """

    seconds: float
    evaluations: int
    iou: dict[str, float]
    xor_px: dict[str, int]
    lost: bool

    @property
    def mean_iou(self) -> float:
        """Over the cameras that observed something; NaN where none did."""
        known = [value for value in self.iou.values() if not math.isnan(value)]
        return sum(known) / len(known) if known else math.nan


class Progress(Protocol):
    """Told by long work; shows nothing by itself."""

    def note(self, text: str) -> None:
        """Something the user should know, one sentence."""
        ...

    def warn(self, text: str) -> None:
        """A note on what is done otherwise than asked for, which must be seen by all means."""
        ...

    def begin(self, task: str, total: int) -> None:
        """``total`` frames, or other steps, of ``task`` are about to be worked on."""
        ...

    def advance(self, frame: int | None, figures: FrameFigures | None = None) -> None:
        """One frame is done.

        Args:
            frame: its number; None where the work does not go frame by frame.
            figures: how it was fitted; None where nothing was.
        """
        ...


class Silence:
    """Progress that nobody looks at."""

    def note(self, text: str) -> None:
        """Drops the text."""

    def warn(self, text: str) -> None:
        """A note like others."""
        self.note(text)

    def begin(self, task: str, total: int) -> None:
        """Drops the announcement."""

    def advance(self, frame: int | None, figures: FrameFigures | None = None) -> None:
        """Drops the frame."""


SILENCE = Silence()
