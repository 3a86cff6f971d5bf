"""Every fault of the input, as damage done to a copy of the small take, and the line that tells it.

The tests check the lines, and `.ci/faults.py` makes core/cli/FAULTS.md of them.
"""

import contextlib
import io
import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import IO
from unittest.mock import patch

from silhouette_mocap.core.cli import main
from small_take import known_start

Words = Sequence[str | Path]


@dataclass(frozen=True)
class Fault:
    """One fault.

    Attributes:
        title: what is wrong, in the words of the table.
        damage: damages the take in a folder; may return the words of a command that meets it
            instead of ``fit``.
        says: what the line must contain.
        within: in which circumstances, given the folder, the command runs.
        early: whether ``info`` meets it too.
        unless: why it cannot be shown here; empty where it can.
    """

    title: str
    damage: Callable[[Path], Words | None]
    says: tuple[str, ...]
    within: Callable[[Path], AbstractContextManager] = nullcontext
    early: bool = True
    unless: str = ""


class Chapter:
    """The faults of one part of the input, in the order they are added."""

    def __init__(self, title: str):
        self.title = title
        self.faults: list[Fault] = []

    def add(self, title: str, *says: str, **circumstances):
        """Adds the decorated damage."""

        def added(damage):
            self.faults.append(Fault(title, damage, says, **circumstances))
            return damage

        return added

    def text(self, title: str, file: str, old: str, new: str, *says: str) -> None:
        """Adds a fault that is one text in place of another in a file of the take."""
        self.add(title, *says)(lambda folder: replace_text(folder / file, old, new))


def replace_text(path: Path, old: str, new: str) -> None:
    """Puts ``new`` in the place of ``old``, which must be there."""
    text = path.read_text("utf-8")
    assert old in text, f"{old!r} is not in {path.name}"
    path.write_text(text.replace(old, new), "utf-8")


def fit_words(folder: Path, *more: str | Path) -> Words:
    """The words that fit the take in ``folder``."""
    return (
        "fit",
        folder / "take.toml",
        "--out",
        folder.parent / "out",
        "--progress",
        "none",
        *more,
    )


def met(fault: Fault, small_take: Path, session: Path) -> tuple["Told", "Told | None"]:
    """What the command says of the fault in a copy of the small take, and what ``info`` says."""
    folder = shutil.copytree(small_take.parent, session / "small")
    words = fault.damage(folder) or fit_words(folder)
    with fault.within(folder):
        told = told_by(words)
        return told, told_by(("info", words[1])) if fault.early else None


@dataclass(frozen=True)
class Told:
    """What came of a command: its exit code and what it wrote to standard error."""

    code: int
    error: str

    def shown(self, session: Path) -> str:
        """The line for the table: without the program's name, folders and who runs it."""
        line = self.error.strip().removeprefix("silhouette-mocap: ").replace("|", "\\|")
        line = line.replace(f"{session}/", "").replace(str(session), "SESSION")
        line = line.replace(str(session.parent), "…")
        line = re.sub(r"(\w+?)\1{19,}", r"\1\1…", line)
        return re.sub(r"process \d+ on \S+ since [\d:]+", "process 1 on HOST since 12:00:00", line)


def table_row(fault: Fault, line: str) -> str:
    """The fault's row in FAULTS.md."""
    return f"| {fault.title} | {'yes' if fault.early else 'no'} | {line} |\n"


def told_by(words: Words) -> Told:
    """Runs a command in this process; fits start at once from the pose they would find.

    Codecs write past Python, so the file descriptor is watched and not ``sys.stderr`` alone.
    """
    with tempfile.TemporaryFile("w+", encoding="utf-8") as file:
        with (
            _descriptor_led_to(file),
            contextlib.redirect_stderr(file),
            contextlib.redirect_stdout(io.StringIO()),
            patch("silhouette_mocap.core.beginning.initialised", known_start),
        ):
            code = main([str(word) for word in words])
        file.seek(0)
        return Told(code, file.read())


@contextlib.contextmanager
def _descriptor_led_to(file: IO[str]) -> Iterator[None]:
    before = os.dup(2)
    os.dup2(file.fileno(), 2)
    try:
        yield
    finally:
        file.flush()
        os.dup2(before, 2)
        os.close(before)
