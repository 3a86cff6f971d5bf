"""How the cameras of a take stand to the floor and to the performer."""

from dataclasses import dataclass

import numpy as np

from ..cameras.arrangement import millimetres_per_pixel
from ..cameras.calibration import Calibration
from ..cameras.camera import Camera
from ..take.views import View

UNITS = {"m": "metres", "cm": "centimetres", "mm": "millimetres"}


@dataclass(frozen=True, eq=False)
class Performer:
    """Where the performer stands in the initial pose.

    Attributes:
        centre: (3,) the middle of the body, world metres.
        height_m: standing height.
    """

    centre: np.ndarray
    height_m: float


@dataclass(frozen=True, eq=False)
class CameraFacts:
    """One camera.

    Attributes:
        camera: as calibrated, for the footage's own pixels.
        working_size: (width, height) in px of the pictures that are tracked with.
        reduced_by: the whole factor that footage is reduced by.
        height_m: of the camera above the floor.
        distance_m: to the performer's middle; NaN where that is unknown.
        mm_per_px: what a footage pixel spans there; NaN where unknown, or behind the camera.
    """

    camera: Camera
    working_size: tuple[int, int]
    reduced_by: int
    height_m: float
    distance_m: float
    mm_per_px: float

    @property
    def lens(self) -> str:
        """In one word."""
        if self.camera.is_pinhole:
            return "pinhole"
        return "fisheye" if self.camera.fisheye else "distorted"

    @property
    def across_deg(self) -> float:
        """Horizontal angle of view, the lens left aside."""
        return float(2 * np.degrees(np.arctan(self.camera.size[0] / 2 / self.camera.matrix[0, 0])))

    @property
    def down_deg(self) -> float:
        """How far the camera looks down, negative for up."""
        return float(-np.degrees(np.arcsin(np.clip(self.camera.rotation[2, 2], -1, 1))))


def camera_facts(view: View, performer: Performer | None, floor: float) -> CameraFacts:
    """The facts about one view's camera; ``floor`` is the floor's height in the world."""
    camera, distance, scale = view.undistortion.source, np.nan, np.nan
    if performer is not None:
        distance = float(np.linalg.norm(camera.centre - performer.centre))
        if camera.depths(performer.centre) > 0:
            scale = millimetres_per_pixel(camera, performer.centre)
    return CameraFacts(
        camera=camera,
        working_size=view.camera.size,
        reduced_by=view.reduction.factor,
        height_m=float(camera.centre[2] - floor),
        distance_m=distance,
        mm_per_px=scale,
    )


def units_in_words(calibration: Calibration, wanted: str | None) -> str:
    """The calibration's unit of length and how it is known; ``wanted`` is what the take asks."""
    unit = UNITS[calibration.units]
    if wanted is not None:
        return f"{unit}, as the take says"
    if not calibration.units_guessed:
        return f"{unit}, as {calibration.format} files have"
    centres = np.array([camera.centre for camera in calibration.cameras])
    apart = np.linalg.norm(centres[:, None] - centres, axis=2).max()
    return f"{unit}, guessed: the cameras are then up to {apart:.1f} m apart"
