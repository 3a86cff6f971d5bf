"""An armature of the user's as the body; whoever knows Blender reads it for core."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .body import Body


@dataclass(frozen=True)
class RigFile:
    """Where an armature is.

    Attributes:
        path: a .blend file.
        armature: the name of the armature object in it.
    """

    path: Path
    armature: str

    def __str__(self) -> str:
        return f"{self.path}#{self.armature}"


RigReader = Callable[[RigFile], Body]
"""Reads the body, or raises MocapError: no such file, or no such armature in it."""
