"""What a user is told of a programmer's mistake: one line, and where its traceback lies."""

import tempfile
import traceback
from pathlib import Path

from ..errors import MocapError

_LONGEST_MESSAGE = 200


def internal_fault(error: BaseException) -> MocapError:
    """The fault to show; the traceback is written to a file that it names, if any can be."""
    message = " ".join(str(error).split())[:_LONGEST_MESSAGE]
    problem = f"internal error ({type(error).__name__}: {message})"
    try:
        path = _written_traceback(error)
    except OSError as refusal:
        last = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{Path(last.filename).name}, line {last.lineno}"
        return MocapError(
            f"{problem} in {place}, whose traceback cannot be written ({refusal.strerror})",
            "free space in the temporary folder and try again",
        )
    return MocapError(problem, f"please send {path} to the makers")


def _written_traceback(error: BaseException) -> Path:
    with tempfile.NamedTemporaryFile(
        "w", encoding="utf-8", errors="backslashreplace",
        prefix="silhouette_mocap_error_", suffix=".txt", delete=False,
    ) as stream:  # fmt: skip
        stream.writelines(traceback.format_exception(error))
    return Path(stream.name)
