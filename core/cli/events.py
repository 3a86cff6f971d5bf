"""Progress for programs: one JSON object per line on standard error (see PROGRESS.md)."""

import json
import logging
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from ..errors import MocapError
from ..plain import plain
from ..progress import FrameFigures
from .console import Console

VERSION = 1


class JsonConsole(Console):
    """Every event as a JSON object; nothing else is written to standard error."""

    def __init__(self, stream: TextIO | None = None):
        super().__init__(stream)
        self.started = time.monotonic()

    def start(self, command: str | None) -> None:
        """``start``."""
        super().start(command)
        self._tell("start", command=command)

    def note(self, text: str) -> None:
        """``note``."""
        super().note(text)
        self._tell("note", text=text)

    def warn(self, text: str) -> None:
        """``note``."""
        super().warn(text)
        self._tell("note", text=text)

    def begin(self, task: str, total: int) -> None:
        """``begin``."""
        super().begin(task, total)
        self._tell("begin", task=task, total=total)

    def advance(self, frame: int | None, figures: FrameFigures | None = None) -> None:
        """``frame``."""
        super().advance(frame, figures)
        task = self.task
        self._tell(
            "frame",
            task=task.name,
            frame=frame,
            done=task.done,
            total=task.total,
            elapsed_seconds=task.elapsed,
            remaining_seconds=task.remaining,
            fit=None if figures is None else _fit(figures),
        )

    def wrote(self, path: Path) -> None:
        """``file``."""
        super().wrote(path)
        self._tell("file", file=str(path), bytes=path.stat().st_size)

    def lost(self, frames: Sequence[int]) -> None:
        """``lost``."""
        super().lost(frames)
        self._tell("lost", frames=list(frames))

    def fault(self, error: MocapError, exit_code: int) -> None:
        """``fault``."""
        super().fault(error, exit_code)
        self._tell(
            "fault",
            exit_code=exit_code,
            problem=error.problem,
            remedy=error.remedy,
            file=None if error.file is None else str(error.file),
            camera=error.camera,
            frame=error.frame,
            line=" ".join(str(error).split()),
        )

    def verbose(self, record: logging.LogRecord) -> None:
        """``log``."""
        self._tell("log", level=record.levelname.lower(), text=record.getMessage())

    def end(self, exit_code: int) -> None:
        """``end``."""
        super().end(exit_code)
        self._tell("end", exit_code=exit_code, seconds=time.monotonic() - self.started)

    def _tell(self, event: str, **values) -> None:
        record = {"version": VERSION, "event": event, **values}
        self.write(json.dumps(plain(record), allow_nan=False) + "\n")


def _fit(figures: FrameFigures) -> dict:
    return {
        "seconds": figures.seconds,
        "evaluations": figures.evaluations,
        "iou": figures.iou,
        "mean_iou": figures.mean_iou,
        "xor_px": figures.xor_px,
        "lost": figures.lost,
    }
