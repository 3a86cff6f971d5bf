"""Extraction by colour statistics of the empty scene, without shadows (T, section 3).

A pixel speaks for the performer when its colour lies too many standard deviations from the plate's
mean. Against him speaks a shadow: a pixel that is darker than the background, yet of nearly the
same hue. Hues are angles around the grey axis; where one of the two colours is nearly grey, and
its hue mostly noise, the angle between the RGB vectors is compared instead (our resolution).
Shadows only dim: below a share of the background's brightness a pixel is the performer again, else
black clothes would be shadow everywhere.

Both tests read the picture's difference to the plate after a bilateral filter, which takes the
camera's noise out of flat regions and leaves contours where they are; neighbours of like colour
then decide together (``coherence``). Where the scene is as dark as the shorts before it, no
difference proves nothing: what has the performer's own colours counts little against him, and gaps
of such colours that he all but surrounds are his (``own_colours``).
"""

from dataclasses import dataclass

import cv2
import numpy as np

from ..footage.pictures import colour_picture
from .coherence import Coherence, coherent, neighbour_pulls
from .drift import plate_in
from .own_colours import bridged, own_colours
from .plate import Plate

_SMOOTHING_PX = 1.0
_SMOOTHING_DEVIATIONS = 12.0
_LEAST_NOISE = 0.5
_SURE = 4.0
_NOISE_DEVIATIONS = 2.0
_OWN = 0.1
_MARGIN_PX = 8


@dataclass(frozen=True)
class StatisticsSettings:
    """Settings of ``statistics``.

    Attributes:
        deviations: distance from the mean, in standard deviations over all channels after
            smoothing, beyond which a pixel speaks for the performer.
        hue_deg: largest difference in hue of a shadow.
        angle_deg: largest angle between the RGB vectors of a shadow where colours are nearly grey.
        saturation: share of the strongest channel below which a colour is nearly grey.
        darkest: share of the background's brightness below which nothing is shadow.
        coherence: pull of neighbours of like colour; 0 lets every pixel decide alone.
        drift: whether exposure drift against the plate is compensated.
    """

    deviations: float = 8.0
    hue_deg: float = 8.0
    angle_deg: float = 1.5
    saturation: float = 0.25
    darkest: float = 0.65
    coherence: float = 2.0
    drift: bool = True


@dataclass(frozen=True, eq=False)
class Statistics:
    """Foreground is what differs from the empty scene and is not its shadow."""

    plate: Plate
    settings: StatisticsSettings = StatisticsSettings()

    def foreground(self, picture: np.ndarray) -> np.ndarray:
        """(H, W) bool, True where the performer is."""
        colours = colour_picture(picture).astype(np.float32)
        mean, spread = plate_in(self.plate, colours, self.settings.drift)
        colours, spread = _smoothed(colours, mean, spread)
        deviations = (colours - mean) / spread
        distance = np.sqrt(_dot(deviations, deviations))
        mask = np.zeros(distance.shape, bool)
        area = _around(distance > self.settings.deviations)
        if area is not None:
            mask[area] = self._labels(distance[area], colours[area], mean[area], spread[area])
        return mask

    def _labels(self, distance, colours, background, spread) -> np.ndarray:
        settings = self.settings
        change = distance - settings.deviations
        evidence = np.minimum(change, against_shadow(colours, background, spread, settings))
        evidence = np.clip(evidence, -_SURE, _SURE).astype(np.float32)
        pulls = neighbour_pulls(colours, background, Coherence(settings.coherence))
        labels = coherent(evidence, pulls)
        own = own_colours(colours, labels)
        evidence[own & (evidence < 0)] *= _OWN
        return bridged(coherent(evidence, pulls), own)


def _smoothed(
    colours: np.ndarray, mean: np.ndarray, spread: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The picture and the spread (H, W, 3), both with the noise of flat regions smoothed away."""
    noise = float(spread.mean())
    rest = colours - mean
    smooth = cv2.bilateralFilter(rest, 0, _SMOOTHING_DEVIATIONS * noise, _SMOOTHING_PX)
    step = max(1, min(rest.shape[:2]) // 100)
    before = np.median(np.abs(rest[::step, ::step]), axis=(0, 1))
    after = np.median(np.abs(smooth[::step, ::step]), axis=(0, 1))
    gain = np.where(before > 0, after / np.maximum(before, 1e-6), 1)
    return mean + smooth, np.maximum(spread * gain.astype(np.float32), _LEAST_NOISE)


def _around(mask: np.ndarray) -> tuple[slice, slice] | None:
    """The rows and columns that ``mask`` covers, with a margin; None when it is empty.

    Noise of single pixels does not count: it would make this the whole picture.
    """
    mask = cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8))
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not len(rows):
        return None
    return _with_margin(rows), _with_margin(columns)


def _with_margin(covered: np.ndarray) -> slice:
    return slice(max(covered[0] - _MARGIN_PX, 0), covered[-1] + _MARGIN_PX + 1)


def against_shadow(
    colours: np.ndarray, background: np.ndarray, spread: np.ndarray, settings: StatisticsSettings
) -> np.ndarray:
    """(…) evidence that ``colours`` are not the shadowed ``background``, all (…, 3) BGR.

    Negative inside the limits of a shadow, 0 at a limit, infinite for what is not darker at all.
    An angle of twice the limit, or a brightness of 0.1 below it, is ``_SURE``. The limits of the
    angles are widened by the angle that ``_NOISE_DEVIATIONS`` of noise make.
    """
    brightness = _total(colours) / np.maximum(_total(background), 1)
    too_dark = (settings.darkest - brightness) * 10 * _SURE
    saturation = np.minimum(saturations(colours), saturations(background))
    length = np.maximum(np.sqrt(_dot(colours, colours)), 1)
    noise = _NOISE_DEVIATIONS * _total(spread) / 3 / length
    turned = np.where(
        saturation < settings.saturation,
        vector_angles(colours, background) / (np.radians(settings.angle_deg) + noise),
        hue_angles(colours, background)
        / (np.radians(settings.hue_deg) + noise / np.maximum(saturation, 0.05)),
    )
    against = np.maximum(too_dark, (turned - 1) * _SURE)
    return np.where(brightness < 1, against, np.inf)


def saturations(colours: np.ndarray) -> np.ndarray:
    """(…) (strongest - weakest) / strongest channel of (…, 3) colours; 0 for black."""
    a, b, c = np.moveaxis(colours, -1, 0)
    strongest = np.maximum(np.maximum(a, b), c)
    return (strongest - np.minimum(np.minimum(a, b), c)) / np.maximum(strongest, 1)


def vector_angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(…) rad between the colours (…, 3) as vectors from black."""
    lengths = np.sqrt(_dot(a, a) * _dot(b, b))
    return np.arccos(np.clip(_dot(a, b) / np.maximum(lengths, 1), -1, 1))


def hue_angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(…) rad between the hues of the colours (…, 3) BGR, 0 to pi."""
    turned = np.abs(_hues(a) - _hues(b))
    return np.minimum(turned, 2 * np.pi - turned)


def _hues(colours: np.ndarray) -> np.ndarray:
    blue, green, red = np.moveaxis(colours, -1, 0)
    return np.arctan2(np.sqrt(3) / 2 * (green - blue), red - (green + blue) / 2)


# sums over a last axis of three are several times faster this way than by numpy's reductions
def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...k,...k->...", a, b)


def _total(colours: np.ndarray) -> np.ndarray:
    return colours[..., 0] + colours[..., 1] + colours[..., 2]
