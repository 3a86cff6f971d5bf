"""Faults that a user can mend."""

from pathlib import Path

_LONGEST_END = 300


class MocapError(Exception):
    """A fault in the input, shown verbatim to the user as one line.

    The line names, as far as they apply, the file, camera and frame at fault, says what is wrong
    and ends with what to do about it.

    Args:
        problem: what is wrong, without a final full stop.
        remedy: what the user can do, without a final full stop.
        file: the file or folder at fault.
        camera: the camera's name.
        frame: the frame number, as counted in the take.
    """

    def __init__(
        self,
        problem: str,
        remedy: str | None = None,
        *,
        file: str | Path | None = None,
        camera: str | None = None,
        frame: int | None = None,
    ):
        self.problem = _readable(problem)
        self.remedy = remedy
        self.file = None if file is None else Path(file)
        self.camera = None if camera is None else _readable(camera)
        self.frame = frame
        super().__init__(self._line())

    def about(self, file: str | Path) -> "MocapError":
        """The same fault, of ``file`` where it names none."""
        place = {"camera": self.camera, "frame": self.frame}
        return MocapError(self.problem, self.remedy, file=self.file or file, **place)

    def _line(self) -> str:
        place = [
            str(self.file) if self.file is not None else "",
            f"camera {self.camera}" if self.camera is not None else "",
            f"frame {self.frame}" if self.frame is not None else "",
        ]
        prefix = ", ".join(part for part in place if part)
        line = f"{prefix}: {self.problem}" if prefix else self.problem
        return f"{line}; {self.remedy}" if self.remedy else line


def _readable(text: str) -> str:
    """``text`` without its middle, where damage has made it too long for a line."""
    if len(text) <= 2 * _LONGEST_END:
        return text
    return f"{text[:_LONGEST_END]} … {text[-_LONGEST_END:]}"
