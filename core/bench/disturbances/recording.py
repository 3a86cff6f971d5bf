"""A take as its cameras filmed it, and what changes that.

A disturbance makes another recording of a recording: with other pictures, other cameras or other
frames. Disturbances can therefore follow one another, and whatever tracks a recording need not
know of them. Every random choice is drawn from seed, frame and camera alone, so that pictures are
the same in whatever order they are asked for.
"""

import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Protocol

import numpy as np

from ...body.body import POINT_NAMES
from ...cameras.arrangement import millimetres_per_pixel
from ...cameras.camera import Camera
from ...motion.point_track import PointTrack
from ...silhouettes.silhouette import Silhouette

Look = Callable[[int, int], Silhouette]
"""What the camera of an index saw in a frame."""


@dataclass(frozen=True, eq=False)
class Recording:
    """What V cameras saw of a performer whose motion is known.

    Attributes:
        cameras: V pinhole cameras, as they are thought to be.
        frames: numbers of the frames, rising.
        look: gives the silhouettes, made anew each time.
        truth: the points as they were.
        fps: frames per second of the footage, whether all of its frames are used or not.
        floor: height of the floor, world metres.
    """

    cameras: tuple[Camera, ...]
    frames: tuple[int, ...]
    look: Look
    truth: PointTrack
    fps: Fraction
    floor: float

    def silhouettes(self, frame: int) -> tuple[Silhouette, ...]:
        """What all cameras saw in ``frame``."""
        return tuple(self.look(frame, view) for view in range(len(self.cameras)))

    def points(self, frame: int) -> np.ndarray:
        """(14, 3) world metres of `POINT_NAMES` in ``frame``; NaN where nobody knows."""
        found = np.full((len(POINT_NAMES), 3), np.nan)
        for row in np.flatnonzero(self.truth.frames == frame):
            for name, point in zip(self.truth.names, self.truth.points[row], strict=True):
                if name in POINT_NAMES:
                    found[POINT_NAMES.index(name)] = point
        return found

    @property
    def mm_per_px(self) -> float:
        """Mean of what a pixel spans at the middle of the motion."""
        centre = np.nanmean(self.truth.points, axis=(0, 1))
        return float(np.mean([millimetres_per_pixel(camera, centre) for camera in self.cameras]))


class Disturbance(Protocol):
    """Makes another recording of a recording; the same one for the same seed."""

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The disturbed recording."""
        ...


def disturbed(recording: Recording, seed: int, *disturbances: Disturbance) -> Recording:
    """The recording after one disturbance after the other."""
    for disturbance in disturbances:
        recording = disturbance(recording, seed)
    return recording


def drawn_from(seed: int, who: object, *place: int) -> np.random.Generator:
    """The random numbers of a disturbance for a frame or camera, told apart from all others'."""
    return np.random.default_rng([seed, zlib.crc32(type(who).__name__.encode()), *place])


@dataclass(frozen=True)
class Only:
    """A disturbance of the pictures that is limited to some frames and cameras.

    Attributes:
        disturbance: what happens there.
        frames: first and last, inclusive; None for all.
        views: indices of cameras; None for all.
    """

    disturbance: Disturbance
    frames: tuple[int, int] | None = None
    views: tuple[int, ...] | None = None

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording, disturbed there."""
        other = self.disturbance(recording, seed)

        def look(frame: int, view: int) -> Silhouette:
            within = self.frames is None or self.frames[0] <= frame <= self.frames[1]
            chosen = within and (self.views is None or view in self.views)
            return (other if chosen else recording).look(frame, view)

        return replace(recording, look=look)
