"""The empty scene of one camera, as a mean and a spread per pixel and colour channel.

Colours are BGR in grey levels 0 to 255, as stored (not linear light).
"""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import MocapError
from ..footage.footage import open_footage
from ..footage.patterns import for_camera, has_frame
from ..footage.pictures import PICTURE_SUFFIXES, colour_picture, read_picture, write_picture
from ..geometry.arrays import frozen_array

_SPREAD_UNIT = 1 / 256
_MAX_FRAMES = 200


@dataclass(frozen=True, eq=False)
class Plate:
    """The empty scene.

    Attributes:
        mean: (H, W, 3) float32 colours.
        spread: (H, W, 3) float32 standard deviations over time; 0 where unknown.
    """

    mean: np.ndarray
    spread: np.ndarray

    def __post_init__(self):
        set_ = object.__setattr__
        set_(self, "mean", frozen_array(self.mean, (None, None, 3), "mean", np.float32))
        set_(self, "spread", frozen_array(self.spread, self.mean.shape, "spread", np.float32))

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in px."""
        return self.mean.shape[1], self.mean.shape[0]


def plate_from_empty(pictures: Iterable[np.ndarray]) -> Plate:
    """The plate of pictures of the empty scene; the spread is 0 when there is only one.

    Args:
        pictures: as footage gives them, all of one size, one by one.

    Raises:
        ValueError: no picture.
    """
    count, mean, squares = 0, np.zeros(()), np.zeros(())
    for picture in pictures:
        colours = colour_picture(picture).astype(np.float32)
        count += 1
        step = colours - mean
        mean = mean + step / count
        squares = squares + step * (colours - mean)
    if count == 0:
        raise ValueError("expected at least one picture of the empty scene")
    return Plate(mean, np.sqrt(squares / max(count - 1, 1)))


def read_plate(pattern: str | Path, camera: str) -> Plate:
    """The plate of one camera from a picture, a video or a picture sequence of the empty scene.

    A picture ``plate.png`` gets its spread from ``plate.spread.png`` beside it, if there is one.

    Args:
        pattern: path with ``{camera}`` (and ``{frame:06d}``).
        camera: the camera's name.

    Raises:
        MocapError: nothing there, or not readable.
    """
    path = Path(for_camera(pattern, camera))
    if path.suffix.lower() not in PICTURE_SUFFIXES or has_frame(str(path)):
        footage = open_footage(pattern, camera)
        frames = footage.frames[:_MAX_FRAMES]
        return plate_from_empty(footage.picture(frame) for frame in frames)
    mean = colour_picture(
        read_picture(path, camera, remedy="film the empty scene, or make a plate from the footage")
    )
    if not _spread_path(path).exists():
        return Plate(mean, np.zeros(mean.shape))
    spread = read_picture(_spread_path(path), camera)
    if spread.shape != mean.shape or spread.dtype != np.uint16:
        raise MocapError(
            "does not belong to the plate beside it",
            "make both again with the plate command",
            file=_spread_path(path),
            camera=camera,
        )
    return Plate(mean, spread * _SPREAD_UNIT)


def write_plate(path: Path, plate: Plate) -> None:
    """Writes the mean to ``path`` (.png) and the spread beside it, as ``read_plate`` finds them."""
    write_picture(path, np.clip(np.round(plate.mean), 0, 255).astype(np.uint8))
    spread = np.clip(np.round(plate.spread / _SPREAD_UNIT), 0, 65535)
    write_picture(_spread_path(path), spread.astype(np.uint16))


def _spread_path(path: Path) -> Path:
    return path.with_suffix(".spread.png")
