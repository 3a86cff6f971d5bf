"""What the commands tell: results on standard output, everything else on standard error.

A console is the progress that long work is given, and more. All of it goes to the log; the kinds
of consoles differ in what they show meanwhile.
"""

import io
import logging
import os
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from ..errors import MocapError
from ..files import unwritable
from ..progress import FrameFigures

PROGRAM = "silhouette-mocap"
CLEAR_LINE = "\r\x1b[K"
SHOWN = f"{__name__}.shown"
"""The logger of what is shown anyway."""
_log, _shown = logging.getLogger(__name__), logging.getLogger(SHOWN)


def say(line: str = "") -> None:
    """Writes a line of the result; work goes on where nobody reads it any more.

    Raises:
        MocapError: the disk is full.
    """
    _shown.info("%s", line)
    if sys.stdout is None:
        return
    encoding = sys.stdout.encoding or "utf-8"
    # names of files may hold what a terminal has no letter for
    shown = line.encode(encoding, "backslashreplace").decode(encoding)
    try:
        sys.stdout.write(shown + "\n")
        sys.stdout.flush()
    except BrokenPipeError:
        # whoever read the output has enough of it
        discard(sys.stdout)
    except OSError as error:
        discard(sys.stdout)
        raise unwritable("standard output", error) from error


def discard(stream: TextIO) -> None:
    """Lets ``stream``, which cannot be written, lead nowhere, so that later flushes succeed."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


def let_go() -> None:
    """Writes out what the standard streams hold; Python would end with 120 where that fails."""
    for stream in (sys.stdout, sys.stderr):
        if stream is None:
            continue
        try:
            stream.flush()
        except (OSError, ValueError):
            discard(stream)


@dataclass
class Task:
    """How far a task is.

    Attributes:
        name: what is done.
        total: frames, or other steps, it has.
        started: when it began, by `time.monotonic`.
        done: frames that are finished.
    """

    name: str
    total: int
    started: float
    done: int = 0

    @property
    def elapsed(self) -> float:
        """Seconds since it began."""
        return time.monotonic() - self.started

    @property
    def remaining(self) -> float:
        """Seconds that the rest takes at the mean pace so far; NaN before the first frame."""
        return self.elapsed / self.done * (self.total - self.done) if self.done else float("nan")


class Console:
    """What a command does and finds, kept in the log.

    Args:
        stream: where its kinds show it; by default what is standard error then.
    """

    def __init__(self, stream: TextIO | None = None):
        self._stream = stream
        self.task = Task("", 0, 0.0)

    @property
    def stream(self) -> TextIO:
        """Where all but results go."""
        # closed streams are None
        return self._stream or sys.stderr or io.StringIO()

    def start(self, command: str | None) -> None:
        """The command that was asked for; None where the words name none."""
        _log.info("command %s", command)

    def note(self, text: str) -> None:
        """Something the user should know, one sentence."""
        _shown.info("note: %s", text)

    def warn(self, text: str) -> None:
        """A note on what is done otherwise than asked for."""
        _shown.warning("%s", text)

    def begin(self, task: str, total: int) -> None:
        """``total`` frames, or other steps, of ``task`` are about to be worked on."""
        self.task = Task(task, total, time.monotonic())
        _log.info("%s: %d to do", task, total)

    def advance(self, frame: int | None, figures: FrameFigures | None = None) -> None:
        """One frame is done."""
        task = self.task
        task.done += 1
        if task.done == task.total:
            _log.info("%s: %d done in %.3f s", task.name, task.total, task.elapsed)

    def wrote(self, path: Path) -> None:
        """A file of the result is there, whole."""
        say(f"wrote {path}")

    def lost(self, frames: Sequence[int]) -> None:
        """The poses of ``frames``, at least one, are not to be trusted."""
        _shown.warning("frames lost: %s", ", ".join(map(str, frames)))

    def fault(self, error: MocapError, exit_code: int) -> None:
        """What went wrong; the command ends with ``exit_code``."""
        _shown.error("%s", error)

    def verbose(self, record: logging.LogRecord) -> None:
        """A line that ``--verbose`` asks for."""

    def end(self, exit_code: int) -> None:
        """The command is over."""
        _log.info("exit code %d", exit_code)

    def write(self, text: str) -> None:
        """Shows ``text``; work goes on where nobody reads it any more or the disk is full."""
        with suppress(OSError, ValueError):
            self.stream.write(text)
            self.stream.flush()


class PlainConsole(Console):
    """Shows what went wrong, line by line, and no progress."""

    def warn(self, text: str) -> None:
        """The note in one line."""
        super().warn(text)
        self.line(f"{PROGRAM}: {' '.join(text.split())}")

    def lost(self, frames: Sequence[int]) -> None:
        """The frames in one line."""
        super().lost(frames)
        self.line(f"{PROGRAM}: frames lost: {', '.join(map(str, frames))}")

    def fault(self, error: MocapError, exit_code: int) -> None:
        """The fault in one line."""
        super().fault(error, exit_code)
        self.line(f"{PROGRAM}: {' '.join(str(error).split())}")

    def verbose(self, record: logging.LogRecord) -> None:
        """The message after the seconds since the program began."""
        self.line(f"{record.relativeCreated / 1000:9.3f} s  {record.getMessage()}")

    def line(self, text: str) -> None:
        """One line; a bar makes room for it."""
        if sys.stdout is not None:
            with suppress(OSError, ValueError):
                sys.stdout.flush()
        self.write(text + "\n")
