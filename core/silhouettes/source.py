"""From footage to silhouettes, one view at a time."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..errors import MocapError
from ..footage.footage import Footage
from .cleaning import Cleaned, Cleaning, cleaned
from .masks import ReadyMasks
from .silhouette import Silhouette


class Extractor(Protocol):
    """Tells the performer from the rest of a picture."""

    def foreground(self, picture: np.ndarray) -> np.ndarray:
        """(H, W) bool, True where the performer is, of a picture as footage gives it."""
        ...


class Rectifier(Protocol):
    """Carries footage pixels to the pixels of the pinhole camera that the fit uses."""

    @property
    def observed(self) -> np.ndarray:
        """(H', W') bool, False where no footage pixel lands."""
        ...

    def undistorted(self, picture: np.ndarray) -> np.ndarray:
        """(H', W') uint8 picture of a (H, W) uint8 one."""
        ...


@dataclass(frozen=True, eq=False)
class SilhouetteSource:
    """The silhouettes of one camera, made frame by frame; nothing is kept between frames.

    Attributes:
        footage: the pictures.
        extractor: ready masks or one of the extraction methods.
        cleaning: sizes of the specks and holes to remove; None leaves masks as they are.
        ignore: (H, W) bool in footage pixels, True where the picture is not to be trusted.
        rectifier: lens and ``adjust``; None when the footage is the pinhole camera's.
    """

    footage: Footage
    extractor: Extractor
    cleaning: Cleaning | None = None
    ignore: np.ndarray | None = None
    rectifier: Rectifier | None = None

    def __post_init__(self):
        width, height = self.footage.size
        if self.ignore is not None and self.ignore.shape != (height, width):
            raise MocapError(
                f"the ignore mask is {self.ignore.shape[1]} x {self.ignore.shape[0]} px, "
                f"the footage {width} x {height} px",
                "paint it over a frame of the footage",
                camera=self.footage.camera,
            )

    def read(self, frame: int) -> Silhouette:
        """The silhouette of one frame.

        Raises:
            MocapError: the frame is missing or damaged.
        """
        return self._silhouette(self.mask(frame).mask)

    def silhouettes(self, first: int, last: int) -> Iterator[tuple[int, Silhouette]]:
        """Frame number and silhouette of the frames ``first`` to ``last``, inclusive."""
        for frame in range(first, last + 1):
            yield frame, self.read(frame)

    def mask(self, frame: int) -> Cleaned:
        """The cleaned mask of one frame in footage pixels, before lens and ignore mask.

        Raises:
            MocapError: the frame is missing or damaged, or a ready mask is white all over.
        """
        mask = self.extractor.foreground(self.footage.picture(frame))
        if isinstance(self.extractor, ReadyMasks) and mask.all():
            raise MocapError(
                "is white all over, which no performer is",
                "make the mask again, or paint it black if nobody is in the picture",
                file=self.footage.file(frame), camera=self.footage.camera, frame=frame,
            )  # fmt: skip
        if self.cleaning is None:
            return Cleaned(mask, 0, 0)
        return cleaned(mask, self.cleaning)

    def _silhouette(self, mask: np.ndarray) -> Silhouette:
        observed = np.ones(mask.shape, bool) if self.ignore is None else ~self.ignore
        if self.rectifier is None:
            return Silhouette(mask & observed, observed)
        # an ignored neighbour that enters the interpolation at all spoils a pixel
        trusted = _rectified(self.rectifier, observed) == 255
        observed = trusted & self.rectifier.observed
        return Silhouette((_rectified(self.rectifier, mask) >= 128) & observed, observed)


def _rectified(rectifier: Rectifier, mask: np.ndarray) -> np.ndarray:
    return rectifier.undistorted(np.where(mask, np.uint8(255), np.uint8(0)))
