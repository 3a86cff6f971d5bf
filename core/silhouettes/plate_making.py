"""A plate without an empty scene: from the footage itself and further stills.

Per pixel the background is what stays: the densest third of the colours seen over time, ordered by
brightness (the half-sample mode's idea, which bears the performer for up to two thirds of the time
where a median bears him for half). Two helps where he stays longer than that:

* inside ``box``, a still of the same view with him elsewhere says what the background looks like:
  it is brought onto the footage (``registration``) and its exposure is matched (``drift``). Frames
  that agree with it give the plate, as they have the footage's own sharpness; where none agrees,
  the still itself does; where the still shows him, inside ``still_boxes``, it is not asked;
* inside a patch, only the frames are looked at in which he has left it.

The spread is the deviation of the frames that agree. Where the still was taken over, half a pixel
of its gradient is added, for the registration and the difference in sharpness.
"""

import cv2
import numpy as np

from ..footage.footage import Footage
from ..footage.pictures import colour_picture, read_picture
from .drift import drift_between
from .plate import Plate
from .plate_recipe import Box, Patch, PlateRecipe
from .registration import registered

_BAND = 64
_DENSEST = 1 / 3
_AGREE = 12.0
_FEWEST = 2
_SAMPLES = 33


def plate_from(footage: Footage, frames: tuple[int, int], recipe: PlateRecipe) -> Plate:
    """The plate of footage with a performer in it.

    About 33 pictures, spread evenly over ``frames``, are held at a time.

    Args:
        footage: one camera's pictures.
        frames: first and last frame to look at, inclusive.
        recipe: where stills and chosen frames help.

    Raises:
        MocapError: a frame or a still cannot be read, or the still shows another scene.
    """
    pictures = _sampled(footage, frames)
    plate = _lasting(pictures)
    if recipe.still is not None:
        still = colour_picture(read_picture(recipe.still, footage.camera))
        reference = np.clip(np.round(plate.mean), 0, 255).astype(np.uint8)
        still = registered(still, reference, recipe.still).astype(np.float32)
        plate = _with_still(
            plate, pictures, still, _trusted(recipe, (still.shape[0], still.shape[1]))
        )
    for patch in recipe.patches:
        plate = _with_patch(plate, footage, patch)
    return plate


def _sampled(footage: Footage, frames: tuple[int, int], box: Box | None = None) -> np.ndarray:
    """(T, H, W, 3) uint8 pictures, or boxes of them, spread evenly over ``frames``."""
    first, last = frames
    count = min(_SAMPLES, last - first + 1)
    chosen = np.unique(np.linspace(first, last, count).round().astype(int))
    left, top, right, bottom = box or (0, 0, *footage.size)
    return np.stack(
        [colour_picture(footage.picture(int(frame)))[top:bottom, left:right] for frame in chosen]
    )


def _with_patch(plate: Plate, footage: Footage, patch: Patch) -> Plate:
    left, top, right, bottom = patch.box
    inner = _lasting(_sampled(footage, patch.frames, patch.box))
    mean, spread = plate.mean.copy(), plate.spread.copy()
    mean[top:bottom, left:right] = inner.mean
    spread[top:bottom, left:right] = inner.spread
    return Plate(mean, spread)


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
    brightness = band[..., 0] + band[..., 1] + band[..., 2]
    order = np.argsort(brightness, axis=0)
    ordered = np.take_along_axis(brightness, order, axis=0)
    start = np.argmin(ordered[size - 1 :] - ordered[: count - size + 1], axis=0)
    chosen = np.take_along_axis(order, start + np.arange(size)[:, None, None], axis=0)
    return np.take_along_axis(band, chosen[..., None], axis=0).mean(axis=0)


def _agreeing(band: np.ndarray, guess: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean and spread (H, W, 3) of the frames that agree with ``guess``, and how many do."""
    agrees = (np.abs(band - guess) < _AGREE).all(axis=3, keepdims=True)
    count = agrees.sum(axis=0)
    divisor = np.maximum(count, 1)
    mean = np.where(count > 0, (band * agrees).sum(axis=0) / divisor, guess)
    variance = (np.square(band - mean) * agrees).sum(axis=0) / divisor
    return mean, np.sqrt(variance), count[..., 0]


def _with_still(
    plate: Plate, pictures: np.ndarray, still: np.ndarray, trusted: np.ndarray
) -> Plate:
    drift = drift_between(still[::4, ::4], plate.mean[::4, ::4])
    still = drift.applied(still)
    mean, spread = plate.mean.copy(), plate.spread.copy()
    blurred = _half_pixel_gradient(still) + drift.noise.astype(np.float32)
    for top in range(0, len(mean), _BAND):
        rows = slice(top, top + _BAND)
        seen, deviation, count = _agreeing(pictures[:, rows].astype(np.float32), still[rows])
        enough = (count >= _FEWEST)[..., None]
        use = trusted[rows, :, None]
        mean[rows] = np.where(use, np.where(enough, seen, still[rows]), mean[rows])
        spread[rows] = np.where(use, np.where(enough, deviation, blurred[rows]), spread[rows])
    return Plate(mean, spread)


def _trusted(recipe: PlateRecipe, shape: tuple[int, int]) -> np.ndarray:
    """(H, W) bool, True where the still is needed and shows the empty scene."""
    trusted = np.zeros(shape, bool)
    left, top, right, bottom = recipe.box or (0, 0, *shape[::-1])
    trusted[top:bottom, left:right] = True
    for left, top, right, bottom in recipe.still_boxes:
        trusted[top:bottom, left:right] = False
    return trusted


def _half_pixel_gradient(picture: np.ndarray) -> np.ndarray:
    along = cv2.Sobel(picture, cv2.CV_32F, 1, 0, scale=1 / 8)
    down = cv2.Sobel(picture, cv2.CV_32F, 0, 1, scale=1 / 8)
    return np.hypot(along, down) / 2
