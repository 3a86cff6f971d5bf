"""Extraction by colour statistics of the empty scene, without shadows (T, section 3).

A pixel may be the performer when its colour lies too many standard deviations from the plate's
mean. Of those, shadows are taken away: a pixel that is darker than the background, yet of nearly
the same hue. Hues are angles around the grey axis; where one of the two colours is nearly grey, and
its hue mostly noise, the angle between the RGB vectors is compared instead (our resolution).
Shadows only dim: below a share of the background's brightness a pixel is the performer again, else
black clothes would be shadow everywhere.
"""

from dataclasses import dataclass

import numpy as np

from ..footage.pictures import colour_picture
from .drift import plate_in
from .plate import Plate


@dataclass(frozen=True)
class StatisticsSettings:
    """Settings of ``statistics``.

    Attributes:
        deviations: distance from the mean, in standard deviations over all channels, beyond which
            a pixel may be the performer.
        hue_deg: largest difference in hue of a shadow.
        angle_deg: largest angle between the RGB vectors of a shadow where colours are nearly grey.
        saturation: share of the strongest channel below which a colour is nearly grey.
        darkest: share of the background's brightness below which nothing is shadow.
        drift: whether exposure drift against the plate is compensated.
    """

    deviations: float = 7.0
    hue_deg: float = 15.0
    angle_deg: float = 4.0
    saturation: float = 0.25
    darkest: float = 0.5
    drift: bool = True


@dataclass(frozen=True, eq=False)
class Statistics:
    """Foreground is what differs from the empty scene and is not its shadow."""

    plate: Plate
    settings: StatisticsSettings = StatisticsSettings()

    def foreground(self, picture: np.ndarray) -> np.ndarray:
        """(H, W) bool, True where the performer is."""
        colours = colour_picture(picture).astype(np.float32)
        background = plate_in(self.plate, colours, self.settings.drift)
        deviations = (colours - background.mean) / background.spread
        differs = np.einsum("ijk,ijk->ij", deviations, deviations) > self.settings.deviations**2
        mask = np.zeros(differs.shape, bool)
        mask[differs] = ~is_shadow(colours[differs], background.mean[differs], self.settings)
        return mask


def is_shadow(
    colours: np.ndarray, background: np.ndarray, settings: StatisticsSettings
) -> np.ndarray:
    """(P,) bool, True where ``colours`` are the shadowed ``background``, both (P, 3) BGR."""
    brightness = colours.sum(axis=1) / np.maximum(background.sum(axis=1), 1)
    dimmed = (brightness < 1) & (brightness > settings.darkest)
    nearly_grey = np.minimum(saturations(colours), saturations(background)) < settings.saturation
    same_hue = np.where(
        nearly_grey,
        vector_angles(colours, background) < np.radians(settings.angle_deg),
        hue_angles(colours, background) < np.radians(settings.hue_deg),
    )
    return dimmed & same_hue


def saturations(colours: np.ndarray) -> np.ndarray:
    """(P,) (strongest - weakest) / strongest channel of (P, 3) colours; 0 for black."""
    strongest = colours.max(axis=1)
    return (strongest - colours.min(axis=1)) / np.maximum(strongest, 1)


def vector_angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(P,) rad between the colours (P, 3) as vectors from black."""
    lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    return np.arccos(np.clip((a * b).sum(axis=1) / np.maximum(lengths, 1), -1, 1))


def hue_angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(P,) rad between the hues of the colours (P, 3) BGR, 0 to pi."""
    turned = np.abs(_hues(a) - _hues(b))
    return np.minimum(turned, 2 * np.pi - turned)


def _hues(colours: np.ndarray) -> np.ndarray:
    blue, green, red = colours.T
    return np.arctan2(np.sqrt(3) / 2 * (green - blue), red - (green + blue) / 2)
