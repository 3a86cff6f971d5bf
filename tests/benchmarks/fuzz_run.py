"""One command run in this process, and what it takes: time, memory and words."""

import contextlib
import io
import os
import resource
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from silhouette_mocap.core.cli import main

# native code writes to the file descriptor, not to Python's stream
_ERRORS = tempfile.TemporaryFile()  # noqa: SIM115
_STDERR = os.dup(2)


class Answer(NamedTuple):
    """What a command answers (see ``fuzz.Case``)."""

    code: int
    seconds: float
    peak_mb: float
    line: str


def limit_memory(megabytes: int) -> None:
    """Allocations that would take this process further fail."""
    resource.setrlimit(resource.RLIMIT_AS, (megabytes * 2**20,) * 2)


def answer(take: Path, out: Path) -> Answer:
    """Reads all of ``take`` by writing its masks to ``out``."""
    words = ["masks", str(take), "--out", str(out), "--progress", "none"]
    _forget_peak()
    with _captured() as errors, contextlib.redirect_stdout(io.StringIO()):
        begin = time.perf_counter()
        code = main(words)
        seconds = time.perf_counter() - begin
    return Answer(code, seconds, _peak_mb(), _with_traceback(errors.getvalue(), code))


@contextlib.contextmanager
def _captured():
    text = io.StringIO()
    _ERRORS.seek(0)
    _ERRORS.truncate()
    sys.stderr.flush()
    os.dup2(_ERRORS.fileno(), 2)
    try:
        yield text
    finally:
        sys.stderr.flush()
        os.dup2(_STDERR, 2)
        _ERRORS.seek(0)
        text.write(_ERRORS.read().decode("utf-8", "replace"))


def _with_traceback(line: str, code: int) -> str:
    if code != 1:
        return line
    named = next((word for word in line.split() if "silhouette_mocap_error_" in word), None)
    if named is None:
        return line
    text = Path(named).read_text("utf-8")
    Path(named).unlink()
    return f"{line}{text[-600:]}"


def _forget_peak() -> None:
    """Has Linux measure the peak of this process anew."""
    Path("/proc/self/clear_refs").write_text("5")


def _peak_mb() -> float:
    status = Path("/proc/self/status").read_text()
    line = next(line for line in status.splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) / 1024
