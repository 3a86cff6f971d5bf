"""How long work tells its caller how far it is; the caller decides what to show."""

from typing import Protocol


class Progress(Protocol):
    """Told by long work; shows nothing by itself."""

    def note(self, text: str) -> None:
        """Something the user should know, one sentence."""
        ...

    def begin(self, task: str, total: int) -> None:
        """``total`` frames of ``task`` are about to be worked on."""
        ...

    def advance(self, frame: int, seconds: float | None = None, iou: float | None = None) -> None:
        """One frame is done.

        Args:
            frame: its number.
            seconds: time it took; None where it is of no interest.
            iou: mean intersection over union of its views; None where nothing was fitted.
        """
        ...


class Silence:
    """Progress that nobody looks at."""

    def note(self, text: str) -> None:
        """Drops the text."""

    def begin(self, task: str, total: int) -> None:
        """Drops the announcement."""

    def advance(self, frame: int, seconds: float | None = None, iou: float | None = None) -> None:
        """Drops the frame."""
