"""Exposure drift between two pictures of the same scene.

Automatic exposure and white balance change a camera's picture between the plate and the take. Per
colour channel ``picture = gain * plate + offset`` is fitted by trimmed least squares: the
performer, who follows no such line, is left out by the trimming.
"""

from dataclasses import dataclass

import numpy as np

from .plate import Plate

_ROUNDS = 6
_TRIM = 3.0
_FLOOR = 1.0
_CONTRAST = 8.0
_GRID = 100


@dataclass(frozen=True, eq=False)
class Drift:
    """``picture = gain * plate + offset``, per colour channel.

    Attributes:
        gain: (3,)
        offset: (3,) grey levels.
        noise: (3,) robust standard deviation in grey levels of what remains, at least 1.
    """

    gain: np.ndarray
    offset: np.ndarray
    noise: np.ndarray

    def applied(self, plate: np.ndarray) -> np.ndarray:
        """The plate's colours (…, 3) float32 as they look in the picture."""
        return plate * self.gain.astype(np.float32) + self.offset.astype(np.float32)


def drift_between(plate: np.ndarray, picture: np.ndarray) -> Drift:
    """The drift that turns ``plate`` into ``picture``, both (…, 3) grey levels.

    Args:
        plate: colours of the empty scene; more than half of the pixels must show it in both.
        picture: colours of the same pixels.
    """
    x = np.asarray(plate, float).reshape(-1, 3)
    y = np.asarray(picture, float).reshape(-1, 3)
    fits = np.array([_line(x[:, channel], y[:, channel]) for channel in range(3)])
    return Drift(*fits.T)


def _line(x: np.ndarray, y: np.ndarray) -> tuple[float, float, float]:
    clipped = (y <= 2) | (y >= 253) | (x <= 2) | (x >= 253)
    if (~clipped).sum() >= 100:
        x, y = x[~clipped], y[~clipped]
    gain, offset, spread = 1.0, float(np.median(y - x)), _FLOOR
    for _ in range(_ROUNDS):
        residual = y - gain * x - offset
        spread = max(1.4826 * float(np.median(np.abs(residual))), _FLOOR)
        inside = np.abs(residual) < _TRIM * spread
        mean_x, mean_y = x[inside].mean(), y[inside].mean()
        # a scene without contrast says nothing about the gain: it is then drawn to 1
        prior = _CONTRAST**2
        centred = x[inside] - mean_x
        gain = float(
            (centred @ (y[inside] - mean_y) / inside.sum() + prior) / (centred.var() + prior)
        )
        offset = float(mean_y - gain * mean_x)
    return gain, offset, spread


def plate_in(plate: Plate, colours: np.ndarray, drift: bool) -> tuple[np.ndarray, np.ndarray]:
    """Mean and spread (H, W, 3) of ``plate`` with the exposure and noise of one picture.

    The spread is at least the picture's own noise.

    Args:
        plate: the empty scene.
        colours: (H, W, 3) float32 picture of the same scene, with the performer.
        drift: whether gain and offset per channel are compensated.
    """
    # about 10,000 pixels of a regular grid are enough for two numbers per channel
    step = max(1, min(colours.shape[:2]) // _GRID)
    found = drift_between(plate.mean[::step, ::step], colours[::step, ::step])
    spread = np.maximum(plate.spread, found.noise.astype(np.float32))
    return found.applied(plate.mean) if drift else plate.mean, spread
