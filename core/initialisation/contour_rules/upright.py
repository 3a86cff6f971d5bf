"""Pictures turned upright: x to the right, y up, the performer one unit tall."""

from dataclasses import dataclass

import numpy as np

from ...cameras.camera import Camera
from ...geometry.arrays import frozen_array
from ...silhouettes.silhouette import Silhouette

_NEAR_M = 0.1


@dataclass(frozen=True, eq=False)
class Upright:
    """Where in a picture the performer stands, which way is up, and how tall a unit is.

    Attributes:
        origin: (2,) px of the lowest middle of the performer.
        up: (2,) unit vector in the picture, the world's vertical at the performer.
        height_px: the performer's extent along it.
    """

    origin: np.ndarray
    up: np.ndarray
    height_px: float

    def __post_init__(self):
        set_ = object.__setattr__
        set_(self, "origin", frozen_array(self.origin, (2,), "origin"))
        up = frozen_array(self.up, (2,), "up")
        set_(self, "up", frozen_array(up / np.linalg.norm(up), (2,), "up"))
        if not self.height_px > 0:
            raise ValueError(f"expected a height above 0 px, got {self.height_px}")

    @classmethod
    def of(cls, silhouette: Silhouette, up: np.ndarray) -> "Upright":
        """The frame of a silhouette that is not empty."""
        px = np.argwhere(silhouette.foreground)[:, ::-1].astype(float)
        up = np.asarray(up, float) / np.linalg.norm(up)
        across, along = px @ [-up[1], up[0]], px @ up
        middle, low = float(np.median(across)), float(along.min()) - 0.5
        origin = middle * np.array([-up[1], up[0]]) + low * up
        return cls(origin, up, float(np.ptp(along)) + 1.0)

    @property
    def _axes(self) -> np.ndarray:
        """(2, 2) rows: right and up in px, one height long."""
        return np.array([[-self.up[1], self.up[0]], self.up]) * self.height_px

    def from_px(self, px: np.ndarray) -> np.ndarray:
        """(…, 2) heights of px (…, 2)."""
        return (px - self.origin) @ self._axes.T / self.height_px**2

    def to_px(self, points: np.ndarray) -> np.ndarray:
        """(…, 2) px of points (…, 2) in heights."""
        return points @ self._axes + self.origin


def image_up(camera: Camera, centre: np.ndarray) -> np.ndarray:
    """(2,) direction in the picture in which the vertical at ``centre`` (3,) rises."""
    low, high = camera.project(centre + np.outer([-_NEAR_M, _NEAR_M], [0.0, 0.0, 1.0]))
    return high - low
