"""Boxes round what a picture shows, so that work need not cover the whole picture."""

import cv2
import numpy as np


def box_round(mask: np.ndarray, margin_px: int = 0) -> tuple[slice, slice]:
    """Rows and columns within ``margin_px`` of what is True in a mask (H, W) bool.

    They may reach beyond the picture below and on the right, where numpy cuts them off. Where
    nothing is True, they are as far as the margin from the picture's corner.
    """
    x, y, width, height = cv2.boundingRect(mask.view(np.uint8))
    return (
        slice(max(y - margin_px, 0), y + height + margin_px),
        slice(max(x - margin_px, 0), x + width + margin_px),
    )
