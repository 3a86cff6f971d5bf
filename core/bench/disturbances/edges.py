"""Silhouettes that are a little wrong everywhere: at their boundary, with holes, with specks."""

from dataclasses import dataclass

import cv2
import numpy as np

from .sights import PictureDisturbance, Sight

_SMOOTH_PX = 2.0
"""Over which a jittering boundary stays the same."""
_SPECK_RADII_M = (0.03, 0.08)


@dataclass(frozen=True)
class BoundaryJitter(PictureDisturbance):
    """The boundary wavers, anew in every picture.

    Attributes:
        px: standard deviation of its distance from where it was.
    """

    px: float

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the wavering silhouette."""
        distances = sight.silhouette.distances
        noise = cv2.GaussianBlur(rng.normal(size=distances.shape), (0, 0), _SMOOTH_PX)
        return distances < self.px / noise.std() * noise


@dataclass(frozen=True)
class Swelling(PictureDisturbance):
    """The boundary lies further out everywhere: dilation, or erosion where negative.

    Parts of a pixel are met on average, by chance pixel for pixel.

    Attributes:
        px: by so much.
    """

    px: float

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the larger or smaller silhouette."""
        distances = sight.silhouette.distances
        return distances + rng.uniform(-0.5, 0.5, distances.shape) < self.px


@dataclass(frozen=True)
class Holes(PictureDisturbance):
    """Round holes anywhere in the silhouette, elsewhere in every picture.

    Attributes:
        count: how many.
        radius_m: of each.
    """

    count: int
    radius_m: float = 0.06

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the silhouette with holes."""
        inside = np.argwhere(sight.silhouette.foreground)[:, ::-1]
        if not len(inside):
            return sight.silhouette.foreground
        radii = np.full(self.count, self.radius_m)
        centres = inside[rng.integers(0, len(inside), self.count)]
        return sight.silhouette.foreground & ~_discs(sight, centres, radii)


@dataclass(frozen=True)
class Speckle(PictureDisturbance):
    """Round specks anywhere in the picture, elsewhere in every one.

    Attributes:
        count: how many.
    """

    count: int

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the silhouette with specks."""
        centres = rng.integers(0, sight.camera.size, (self.count, 2))
        radii = rng.uniform(*_SPECK_RADII_M, self.count)
        return sight.silhouette.foreground | _discs(sight, centres, radii)


def _discs(sight: Sight, centres: np.ndarray, radii_m: np.ndarray) -> np.ndarray:
    """(H, W) bool, True within discs about px (n, 2), as large as at the performer."""
    picture = np.zeros(sight.camera.size[::-1], np.uint8)
    for centre, radius in zip(centres.tolist(), radii_m * sight.px_per_metre, strict=True):
        if np.isfinite(radius):
            cv2.circle(picture, centre, max(1, round(radius)), (1,), -1)
    return picture.view(bool)
