"""Cameras that fail: dead, frozen, hidden, or calibrated wrongly."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from ...cameras.camera import Camera
from ...silhouettes.silhouette import Silhouette
from .recording import Recording, drawn_from


@dataclass(frozen=True)
class DeadCamera:
    """Nothing but black pictures."""

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording with empty silhouettes."""

        def look(frame: int, view: int) -> Silhouette:
            seen = recording.look(frame, view)
            return Silhouette(np.zeros_like(seen.foreground), seen.observed)

        return replace(recording, look=look)


@dataclass(frozen=True)
class FrozenCamera:
    """The same picture again and again.

    Attributes:
        frame: which.
    """

    frame: int

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording with that frame's silhouettes."""
        return replace(recording, look=lambda frame, view: recording.look(self.frame, view))


@dataclass(frozen=True)
class Occluder:
    """An opaque pole stands between camera and performer, from top to bottom of the picture.

    It stands in the middle of where the performer goes.

    Attributes:
        width_m: of what it hides at the performer.
        told: whether an ignore mask tells of it; else it is missing foreground.
    """

    width_m: float
    told: bool = False

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording with hidden silhouettes."""
        centre = np.nanmean(recording.truth.points, axis=(0, 1))

        def look(frame: int, view: int) -> Silhouette:
            camera, seen = recording.cameras[view], recording.look(frame, view)
            hidden = np.zeros_like(seen.foreground)
            half = self.width_m / 2 * camera.matrix[0, 0] / float(camera.depths(centre))
            middle = float(camera.project(centre)[0])
            columns = np.arange(hidden.shape[1])
            hidden[:, np.abs(columns - middle) <= half] = True
            observed = seen.observed & ~hidden if self.told else seen.observed
            return Silhouette(seen.foreground & ~hidden, observed)

        return replace(recording, look=look)


@dataclass(frozen=True)
class CalibrationError:
    """Every camera is thought to be a little beside where it is.

    Attributes:
        turn_deg: angle, about a random axis through its centre.
        shift_mm: distance, in a random direction.
    """

    turn_deg: float = 0.0
    shift_mm: float = 0.0

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording with other cameras, of the same pictures."""
        moved = [
            self._moved(camera, drawn_from(seed, self, view))
            for view, camera in enumerate(recording.cameras)
        ]
        return replace(recording, cameras=tuple(moved))

    def _moved(self, camera: Camera, rng: np.random.Generator) -> Camera:
        axis, way = (d / np.linalg.norm(d) for d in rng.normal(size=(2, 3)))
        turn = Rotation.from_rotvec(np.radians(self.turn_deg) * axis).as_matrix()
        rotation = turn @ camera.rotation
        centre = camera.centre + self.shift_mm / 1000 * way
        return replace(camera, camera_from_world=np.column_stack([rotation, -rotation @ centre]))
