"""Extraction by thresholded difference to a plate (M, section 3)."""

from dataclasses import dataclass

import numpy as np

from ..footage.pictures import colour_picture
from .drift import plate_in
from .plate import Plate


@dataclass(frozen=True)
class DifferenceSettings:
    """Settings of ``difference``.

    Attributes:
        threshold: grey levels by which the strongest channel must differ.
        drift: whether exposure drift against the plate is compensated.
    """

    threshold: float = 20.0
    drift: bool = True


@dataclass(frozen=True, eq=False)
class Difference:
    """Foreground is what differs from the plate by more than a threshold in any channel."""

    plate: Plate
    settings: DifferenceSettings = DifferenceSettings()

    def foreground(self, picture: np.ndarray) -> np.ndarray:
        """(H, W) bool, True where ``picture`` differs from the plate."""
        colours = colour_picture(picture).astype(np.float32)
        mean, _ = plate_in(self.plate, colours, self.settings.drift)
        return np.abs(colours - mean).max(axis=2) > self.settings.threshold
