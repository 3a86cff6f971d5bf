"""How good the masks of one camera are, told from the masks and pictures alone."""

from dataclasses import dataclass

import cv2
import numpy as np

from ..footage.pictures import colour_picture
from .cleaning import Cleaned

_RING_PX = 3


@dataclass(frozen=True)
class MaskQuality:
    """Figures over all frames of one camera.

    Attributes:
        frames: frames looked at.
        empty: frames without any foreground.
        coverage: share of the picture that is foreground, mean; a person filmed whole covers 1 to
            15 %, and 0 or 50 % mean that the extraction failed.
        specks: patches removed per frame, mean; tens of them mean a noisy or drifting background.
        contrast: difference in colour just inside and just outside of the contour, in grey levels,
            mean; under 15 the contour is a guess. NaN when the footage is ready masks.
        flicker: share of the foreground that comes or goes for one frame only, mean; above 3 % the
            masks are unsteady.
    """

    frames: int
    empty: int
    coverage: float
    specks: float
    contrast: float
    flicker: float


class MaskMeter:
    """Takes masks in frame order, keeping the last two, and sums up their quality."""

    def __init__(self):
        self._figures: list[tuple[float, int]] = []
        self._contrasts: list[float] = []
        self._flickers: list[float] = []
        self._last: list[np.ndarray] = []

    def add(self, result: Cleaned, picture: np.ndarray | None = None) -> None:
        """Counts one frame.

        Args:
            result: its cleaned mask.
            picture: the picture it was extracted from; None for ready masks.
        """
        mask = result.mask
        self._figures.append((float(mask.mean()), result.specks))
        if picture is not None and mask.any():
            self._contrasts.append(contour_contrast(picture, mask))
        self._last = [*self._last[-2:], mask]
        if len(self._last) == 3 and self._last[1].any():
            before, now, after = self._last
            blink = (before == after) & (now != before)
            self._flickers.append(np.count_nonzero(blink) / np.count_nonzero(now))

    def quality(self) -> MaskQuality:
        """The figures so far.

        Raises:
            ValueError: no frame was added.
        """
        if not self._figures:
            raise ValueError("expected at least one mask")
        coverage, specks = np.array(self._figures).T
        return MaskQuality(
            frames=len(coverage),
            empty=int(np.count_nonzero(coverage == 0)),
            coverage=float(coverage.mean()),
            specks=float(specks.mean()),
            contrast=float(np.mean(self._contrasts)) if self._contrasts else float("nan"),
            flicker=float(np.mean(self._flickers)) if self._flickers else 0.0,
        )


def contour_contrast(picture: np.ndarray, mask: np.ndarray) -> float:
    """Mean difference in grey levels between local colours inside and outside of the contour.

    Colours are averaged over 7 x 7 px windows of each side, at the pixels on the contour.

    Args:
        picture: (H, W[, 3]) picture.
        mask: (H, W) bool, not empty.
    """
    colours = colour_picture(picture).astype(np.float32)
    inside = mask.astype(np.float32)
    rim = mask & (cv2.erode(inside, np.ones((3, 3))) == 0)
    side = 2 * _RING_PX + 1
    means = []
    for weight in (inside, 1 - inside):
        total = cv2.boxFilter(colours * weight[..., None], -1, (side, side), normalize=False)
        count = cv2.boxFilter(weight, -1, (side, side), normalize=False)
        means.append(total[rim] / np.maximum(count[rim], 1)[:, None])
    return float(np.linalg.norm(means[0] - means[1], axis=1).mean())
