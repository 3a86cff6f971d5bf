"""Progress for people: a bar on a terminal, lines in a log."""

import math
import shutil
import time

from ..progress import FrameFigures
from .console import CLEAR_LINE, PlainConsole

_WIDTH = 24
_SECONDS_BETWEEN_BARS = 0.1
_MOST_LINES = 100
_SECONDS_WITHOUT_LINE = 60.0


class _TellingConsole(PlainConsole):
    """Shows notes, too."""

    def note(self, text: str) -> None:
        """The text as a line, above a bar."""
        super().note(text)
        self.line(f"note: {text}")


class BarConsole(_TellingConsole):
    """One line that grows, and how long the rest will take."""

    _drawn = 0.0

    def begin(self, task: str, total: int) -> None:
        """An empty bar."""
        super().begin(task, total)
        self._draw("")

    def advance(self, frame: int | None, figures: FrameFigures | None = None) -> None:
        """The bar, not drawn more often than it can be looked at."""
        super().advance(frame, figures)
        task = self.task
        last = task.done == task.total
        if not last and time.monotonic() - self._drawn < _SECONDS_BETWEEN_BARS:
            return
        pace = f"  {task.elapsed / task.done:.2f} s/frame"
        self._draw(pace + _quality(figures) + (_rest(task.remaining) if not last else ""))
        if last:
            self.write("\n")

    def line(self, text: str) -> None:
        """A line in the place of the bar, which comes back with the next frame."""
        super().line(CLEAR_LINE + text)

    def _draw(self, figures: str) -> None:
        self._drawn = time.monotonic()
        task = self.task
        filled = _WIDTH * task.done // max(task.total, 1)
        bar = "#" * filled + "." * (_WIDTH - filled)
        text = f"{task.name} [{bar}] {task.done}/{task.total}{figures}"
        # a line that wraps could not be drawn over
        columns = shutil.get_terminal_size().columns - 1
        self.write(CLEAR_LINE + text[:columns])


class LineConsole(_TellingConsole):
    """A line per frame of short tasks and per percent of long ones, and a sign of life."""

    _shown = 0.0

    def begin(self, task: str, total: int) -> None:
        """Nothing to show yet."""
        super().begin(task, total)
        self._shown = time.monotonic()

    def advance(self, frame: int | None, figures: FrameFigures | None = None) -> None:
        """The frame, unless it is one of too many."""
        super().advance(frame, figures)
        task, now = self.task, time.monotonic()
        lines = min(_MOST_LINES, task.total)
        due = lines * task.done // task.total > lines * (task.done - 1) // task.total
        if not due and now - self._shown < _SECONDS_WITHOUT_LINE:
            return
        self._shown = now
        took = "" if figures is None else f"  {figures.seconds:.2f} s"
        rest = _rest(task.remaining) if task.done < task.total else ""
        step = "" if frame is None else f"  frame {frame}"
        place = f"{task.name} {task.done}/{task.total}{step}"
        self.line(place + took + _quality(figures) + rest)


def duration(seconds: float) -> str:
    """Hours, minutes and seconds as 1:02:03, or 2:03 where there are no hours."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


def _rest(seconds: float) -> str:
    return f"  {duration(seconds)} left"


def _quality(figures: FrameFigures | None) -> str:
    if figures is None or math.isnan(figures.mean_iou):
        return ""
    return f"  IoU {figures.mean_iou:.3f}"
