"""A plate without an empty scene: from the footage itself and further stills.

Per pixel the background is what stays: the densest third of the colours seen over time, ordered by
brightness (the half-sample mode's idea, which bears the performer for up to two thirds of the time
where a median bears him for half). Where he stays longer than that, inside ``box``, a still of the
same view with him elsewhere says what the background looks like: it is brought onto the footage
(``registration``), its exposure is matched (``drift``), and

* frames that agree with it there give the plate, as they have the footage's own sharpness;
* where none agrees, the still itself does;
* where the still shows him, inside ``still_box``, it is not asked.

The spread is the deviation of the frames that agree. Where the still was taken over, half a pixel
of its gradient is added, for the registration and the difference in sharpness.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from ..footage.footage import Footage
from ..footage.pictures import colour_picture, read_picture
from .drift import drift_between
from .plate import Plate
from .registration import registered

Box = tuple[int, int, int, int]

_BAND = 64
_DENSEST = 1 / 3
_AGREE = 5.0
_LEAST_AGREE = 12.0


@dataclass(frozen=True, eq=False)
class Still:
    """A further picture of the same view.

    Attributes:
        picture: (H', W', 3) uint8 BGR.
        file: where it comes from.
        performer: (left, top, right, bottom) px of the performer in the still, once it lies on
            the footage; None when nobody is in it.
    """

    picture: np.ndarray
    file: Path
    performer: Box | None = None


def read_still(path: Path, camera: str, performer: Box | None = None) -> Still:
    """The still of ``path``.

    Raises:
        MocapError: no such file, or not readable.
    """
    return Still(colour_picture(read_picture(path, camera)), path, performer)


def sampled(footage: Footage, frames: tuple[int, int], count: int = 33) -> np.ndarray:
    """(T, H, W, 3) uint8 pictures, ``count`` or fewer, spread evenly over ``frames``."""
    first, last = frames
    chosen = np.unique(np.linspace(first, last, min(count, last - first + 1)).round().astype(int))
    return np.stack([colour_picture(footage.picture(int(frame))) for frame in chosen])


def plate_from(pictures: np.ndarray, stills: Sequence[Still] = (), box: Box | None = None) -> Plate:
    """The plate of footage with a performer in it.

    Args:
        pictures: (T, H, W, 3) uint8 of one camera, spread over the take.
        stills: further pictures of the same view; only used inside ``box``.
        box: (left, top, right, bottom) px where the performer may stay; None for everywhere.

    Raises:
        MocapError: a still shows another scene.
    """
    plate = _lasting(pictures)
    for still in stills:
        plate = _with_still(plate, pictures, still, box)
    return plate


def _lasting(pictures: np.ndarray) -> Plate:
    mean = np.empty(pictures.shape[1:], np.float32)
    spread = np.empty_like(mean)
    for top in range(0, len(mean), _BAND):
        band = pictures[:, top : top + _BAND].astype(np.float32)
        guess = _densest(band)
        mean[top : top + _BAND], spread[top : top + _BAND], _ = _agreeing(band, guess)
    return Plate(mean, spread)


def _densest(band: np.ndarray) -> np.ndarray:
    """(H, W, 3) mean colour of the third of ``band`` (T, H, W, 3) that is closest in brightness."""
    count = len(band)
    size = max(1, int(np.ceil(count * _DENSEST)))
    brightness = band.sum(axis=3)
    order = np.argsort(brightness, axis=0)
    ordered = np.take_along_axis(brightness, order, axis=0)
    start = np.argmin(ordered[size - 1 :] - ordered[: count - size + 1], axis=0)
    chosen = np.take_along_axis(order, start + np.arange(size)[:, None, None], axis=0)
    return np.take_along_axis(band, chosen[..., None], axis=0).mean(axis=0)


def _agreeing(band: np.ndarray, guess: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean and spread (H, W, 3) of the frames that agree with ``guess``, and their number (H, W)."""
    agrees = (np.abs(band - guess).max(axis=3) < _LEAST_AGREE)[..., None]
    count = agrees.sum(axis=0)
    divisor = np.maximum(count, 1)
    mean = np.where(count > 0, (band * agrees).sum(axis=0) / divisor, guess)
    variance = (np.square(band - mean) * agrees).sum(axis=0) / divisor
    return mean, np.sqrt(variance), count[..., 0]


def _with_still(plate: Plate, pictures: np.ndarray, still: Still, box: Box | None) -> Plate:
    reference = np.round(plate.mean).astype(np.uint8)
    picture = registered(still.picture, reference, still.file).astype(np.float32)
    trusted = _inside(box, reference.shape) if box else np.ones(reference.shape[:2], bool)
    if still.performer:
        trusted &= ~_inside(still.performer, reference.shape)
    drift = drift_between(picture[::4, ::4], plate.mean[::4, ::4])
    picture = drift.applied(picture)
    mean, spread = plate.mean.copy(), plate.spread.copy()
    blurred = _half_pixel_gradient(picture) + drift.noise.astype(np.float32)
    for top in range(0, len(mean), _BAND):
        rows = slice(top, top + _BAND)
        band = pictures[:, rows].astype(np.float32)
        seen, deviation, count = _agreeing(band, picture[rows])
        enough = (count >= 2)[..., None]
        use = trusted[rows][..., None]
        mean[rows] = np.where(use, seen, mean[rows])
        spread[rows] = np.where(use, np.where(enough, deviation, blurred[rows]), spread[rows])
    return Plate(mean, spread)


def _inside(box: Box, shape: tuple[int, ...]) -> np.ndarray:
    left, top, right, bottom = box
    inside = np.zeros(shape[:2], bool)
    inside[max(top, 0) : bottom, max(left, 0) : right] = True
    return inside


def _half_pixel_gradient(picture: np.ndarray) -> np.ndarray:
    along = cv2.Sobel(picture, cv2.CV_32F, 1, 0, scale=1 / 8)
    down = cv2.Sobel(picture, cv2.CV_32F, 0, 1, scale=1 / 8)
    return np.hypot(along, down) / 2
