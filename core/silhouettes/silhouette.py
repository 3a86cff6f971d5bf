"""What one view shows of the performer."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from ..geometry.boxes import box_round
from .observed_contour import ObservedContour


@dataclass(frozen=True, eq=False)
class Silhouette:
    """The observed silhouette of one view.

    Attributes:
        foreground: (H, W) bool, True where the performer was seen.
        observed: (H, W) bool, False where the picture says nothing: under an ignore mask, or
            without a source pixel after undistortion.
    """

    foreground: np.ndarray
    observed: np.ndarray

    @cached_property
    def distances(self) -> np.ndarray:
        """(H, W) float32 px from each pixel's centre to the foreground's boundary, negative inside.

        The boundary runs between pixels, so no centre is nearer than half a pixel.
        """
        inside = self.foreground.view(np.uint8)
        distances = _depths(1 - inside)
        distances -= 0.5
        # with a rim of one pixel, where the nearest ones outside lie
        part = box_round(self.foreground, margin_px=1)
        depths = _depths(inside[part])
        np.subtract(0.5, depths, out=distances[part], where=self.foreground[part])
        return distances

    @cached_property
    def contour(self) -> ObservedContour:
        """Where the foreground ends."""
        return ObservedContour.of(self.foreground, self.observed, self.distances)


def _depths(mask: np.ndarray) -> np.ndarray:
    """(H, W) float32 px from each pixel of a mask (H, W) uint8 to the nearest that is 0.

    The last bit of OpenCV's roots depends on where in memory they lie; their squares are whole.
    """
    depths = cv2.distanceTransform(mask, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    depths *= depths
    np.rint(depths, out=depths)
    return np.sqrt(depths, out=depths)
