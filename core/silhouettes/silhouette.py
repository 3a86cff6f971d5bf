"""What one view shows of the performer."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np


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
        inside = self.foreground.astype(np.uint8)
        depth = cv2.distanceTransform(inside, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        height = cv2.distanceTransform(1 - inside, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        return np.where(self.foreground, 0.5 - depth, height - 0.5)
