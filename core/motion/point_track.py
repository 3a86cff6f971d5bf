"""Points over time as read from files, for comparing one motion with another."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..errors import MocapError
from ..geometry.archive import read_archive
from ..geometry.arrays import frozen_array
from .formats.trc import read_trc


@dataclass(frozen=True, eq=False)
class PointTrack:
    """Named points in world space over time.

    Attributes:
        names: P unique names.
        frames: (T,) int, rising frame numbers.
        points: (T, P, 3) metres; NaN where a point is missing.
        rotations: (T, P, 3, 3) axes, in columns, of the bone that carries each point; None where
            nobody knows.
        fps: frames per second; None where the file does not say.
    """

    names: tuple[str, ...]
    frames: np.ndarray
    points: np.ndarray
    rotations: np.ndarray | None = None
    fps: float | None = None

    def __post_init__(self):
        set_ = object.__setattr__
        set_(self, "frames", frozen_array(self.frames, (None,), "frames", int))
        points = np.array(self.points, float)
        shape = (len(self.frames), len(self.names), 3)
        if points.shape != shape:
            raise ValueError(f"expected points of shape {shape}, got {points.shape}")
        set_(self, "points", points)
        if self.rotations is not None:
            set_(self, "rotations", frozen_array(self.rotations, (*shape, 3), "rotations"))

    def between(self, first: int, last: int) -> "PointTrack":
        """The frames ``first`` to ``last``, inclusive."""
        kept = (self.frames >= first) & (self.frames <= last)
        rotations = None if self.rotations is None else self.rotations[kept]
        return replace(
            self, frames=self.frames[kept], points=self.points[kept], rotations=rotations
        )


def read_point_track(path: Path) -> PointTrack:
    """The points of a motion.npz, a truth.npz or a TRC file.

    An ``.npz`` holds ``points`` and ``point_names`` (or ``joints`` and ``joint_names``), metres,
    Z up, and may hold ``frames``, ``fps`` and ``point_rotations``.

    Raises:
        MocapError: no such file, another kind of file, or one without points.
    """
    readers = {".npz": _read_npz, ".trc": _read_trc}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise MocapError("cannot be scored", "give a .npz or .trc file", file=path)
    try:
        return reader(path)
    except (ValueError, KeyError, IndexError) as error:
        raise MocapError(f"holds no points that can be read ({error})", file=path) from error


def _read_npz(path: Path) -> PointTrack:
    data = read_archive(path, "motion.npz or truth.npz", "write it again")
    prefix = "point" if "points" in data else "joint"
    points = data[f"{prefix}s"]
    fps = np.ravel(data["fps"]).astype(float) if "fps" in data else None
    return PointTrack(
        names=tuple(str(name) for name in data[f"{prefix}_names"]),
        frames=data["frames"] if "frames" in data else np.arange(len(points)),
        points=points,
        rotations=data.get("point_rotations"),
        fps=None if fps is None else float(fps[0] / fps[1] if len(fps) == 2 else fps[0]),
    )


def _read_trc(path: Path) -> PointTrack:
    track = read_trc(path)
    return PointTrack(track.names, track.frames, track.points, fps=track.fps)
