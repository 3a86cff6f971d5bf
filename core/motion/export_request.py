"""What an exporter is asked to write; how core hands a result to whoever can write files of it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ..body.body import Body
from ..body.rig_file import RigFile
from ..cameras.camera import Camera
from ..errors import MocapError
from .motion import Motion

FORMATS = ("blend", "fbx", "bvh", "trc")
"""The formats that can be asked for, which are also the suffixes of the files."""


@dataclass(frozen=True, eq=False)
class ExportRequest:
    """One take to be written as ``folder/name.format`` for every format.

    Attributes:
        body: the performer.
        motion: the tracked take; its DOFs are those of ``body``.
        cameras: the cameras of the take, as pinhole cameras of the footage shown.
        name: the take's name, also the name of the action and of the files.
        formats: some of `FORMATS`, in the order of writing.
        folder: an existing folder.
        footage: camera name -> the pictures to show behind the performer: a video, or a pattern
            with one ``{frame}`` field such as ``plates/cam01/{frame:06d}.png``. May lack cameras.
        rig: the armature whose bones are to be keyed, of which ``body`` was read; None where bones
            are to be made after ``body``.

    Raises:
        MocapError: a format that nobody writes.
        ValueError: a motion of another body.
    """

    body: Body
    motion: Motion
    cameras: tuple[Camera, ...]
    name: str
    formats: tuple[str, ...]
    folder: Path
    footage: dict[str, str] = field(default_factory=dict)
    rig: RigFile | None = None

    def __post_init__(self):
        unknown = [name for name in self.formats if name not in FORMATS]
        if unknown:
            raise MocapError(f"cannot export {unknown[0]!r}", f"choose among {', '.join(FORMATS)}")
        if tuple(self.motion.dof_names) != self.body.dofs.names:
            raise ValueError("expected a motion with the DOFs of the body")

    def path(self, suffix: str) -> Path:
        """The file of one format."""
        return self.folder / f"{self.name}.{suffix}"


Exporter = Callable[[ExportRequest], tuple[Path, ...]]
"""Writes what is asked and returns the paths in the order of the request's formats."""
