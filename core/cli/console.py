"""What the commands write: results to standard output, progress and notes to standard error."""

import sys
import time
from typing import TextIO

from ..progress import FrameFigures

_WIDTH = 24
_CLEAR_LINE = "\r\x1b[K"


def say(line: str = "") -> None:
    """Writes a line of the result."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def complain(line: str) -> None:
    """Writes one line about what went wrong."""
    sys.stdout.flush()
    clear = _CLEAR_LINE if sys.stderr.isatty() else ""
    sys.stderr.write(f"{clear}silhouette-mocap: {' '.join(line.split())}\n")
    sys.stderr.flush()


class ProgressBar:
    """Progress as a bar on a terminal, as plain lines elsewhere.

    Args:
        stream: where to write.
    """

    def __init__(self, stream: TextIO | None = None):
        self.stream = sys.stderr if stream is None else stream
        self.on_terminal = self.stream.isatty()
        self.task, self.total, self.done, self.seconds = "", 0, 0, 0.0
        self._mark = time.monotonic()

    def note(self, text: str) -> None:
        """The text as a line of its own."""
        clear = _CLEAR_LINE if self.on_terminal else ""
        self._write(f"{clear}note: {text}\n")

    def begin(self, task: str, total: int) -> None:
        """A new bar, shown on a terminal before the first frame is done."""
        self.task, self.total, self.done, self.seconds = task, total, 0, 0.0
        self._mark = time.monotonic()
        if self.on_terminal:
            self._write(f"{_CLEAR_LINE}{task} [{'.' * _WIDTH}] 0/{total}")

    def advance(self, frame: int, figures: FrameFigures | None = None) -> None:
        """One more frame; the mean time per frame counts what is around the work too."""
        now = time.monotonic()
        self.seconds += now - self._mark
        self._mark = now
        self.done += 1
        quality = "" if figures is None else f"  IoU {figures.mean_iou:.3f}"
        if not self.on_terminal:
            took = "" if figures is None else f"  {figures.seconds:.2f} s"
            self._write(f"{self.task} {self.done}/{self.total}  frame {frame}{took}{quality}\n")
            return
        filled = round(_WIDTH * self.done / max(self.total, 1))
        bar = "#" * filled + "." * (_WIDTH - filled)
        pace = self.seconds / self.done
        end = "\n" if self.done == self.total else ""
        self._write(
            f"{_CLEAR_LINE}{self.task} [{bar}] {self.done}/{self.total}"
            f"  {pace:.2f} s/frame{quality}{end}"
        )

    def _write(self, text: str) -> None:
        self.stream.write(text)
        self.stream.flush()
