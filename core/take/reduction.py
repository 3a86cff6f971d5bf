"""Pictures reduced by whole factors, so that tracking works at the scale it needs.

Silhouettes carry no more information about a pose once the performer is some 400 px tall, but the
work grows with their area.
"""

from dataclasses import dataclass

import cv2
import numpy as np

from ..cameras.camera import Camera
from ..silhouettes.silhouette import Silhouette

WORKING_HEIGHT_PX = 400


@dataclass(frozen=True)
class Reduction:
    """Pictures with ``factor`` x ``factor`` px made one; what does not fill a px is cut off.

    Attributes:
        factor: 1 leaves everything as it is.
    """

    factor: int = 1

    def camera(self, camera: Camera) -> Camera:
        """The camera of the reduced pictures."""
        if self.factor == 1:
            return camera
        width, height = (side // self.factor for side in camera.size)
        return camera.scaled(1 / self.factor, (width, height))

    def picture(self, picture: np.ndarray) -> np.ndarray:
        """The area means (h, w, …) of a picture (H, W, …)."""
        if self.factor == 1:
            return picture
        height, width = (side // self.factor for side in picture.shape[:2])
        whole = picture[: height * self.factor, : width * self.factor]
        return cv2.resize(whole, (width, height), interpolation=cv2.INTER_AREA)

    def silhouette(self, silhouette: Silhouette) -> Silhouette:
        """The silhouette of what covers half a reduced px or more; px are observed as a whole."""
        if self.factor == 1:
            return silhouette
        foreground = self.picture(silhouette.foreground.astype(np.uint8) * 255) >= 128
        observed = self.picture(silhouette.observed.astype(np.uint8) * 255) == 255
        return Silhouette(foreground & observed, observed)


def fitting_reduction(silhouettes: tuple[Silhouette, ...]) -> Reduction:
    """The reduction that brings one camera's performer near `WORKING_HEIGHT_PX`, never far below.

    Args:
        silhouettes: some of the camera's silhouettes; empty ones say nothing.
    """
    heights = [_performer_height(s.foreground) for s in silhouettes if s.foreground.any()]
    if not heights:
        return Reduction()
    return Reduction(max(1, round(float(np.median(heights)) / WORKING_HEIGHT_PX)))


def _performer_height(foreground: np.ndarray) -> int:
    """Rows that the largest patch covers; others may be anything."""
    _, _, stats, _ = cv2.connectedComponentsWithStats(foreground.astype(np.uint8), connectivity=8)
    largest = 1 + int(np.argmax(stats[1:, cv2.CC_STAT_AREA]))
    return int(stats[largest, cv2.CC_STAT_HEIGHT])
