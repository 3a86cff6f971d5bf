"""Brings a still onto the footage of the same camera, when it was scaled, cropped or shifted.

SIFT features matched with Lowe's ratio test, a similarity (scale, rotation, shift) by RANSAC. The
performer stands elsewhere in the two pictures and is outvoted by the room.
"""

from pathlib import Path

import cv2
import numpy as np

from ..errors import MocapError

_FEATURES = 4000
_RATIO = 0.75
_REACH_PX = 1.5
_FEWEST = 30
_ALIGNED_PX = 0.3


def registered(still: np.ndarray, reference: np.ndarray, file: Path) -> np.ndarray:
    """``still`` in the pixels of ``reference``; where it does not reach, its edge repeats.

    Args:
        still: (H', W', 3) uint8 BGR.
        reference: (H, W, 3) uint8 BGR of the same scene by the same camera.
        file: the still's file, for the message.

    Raises:
        MocapError: the two pictures do not show the same scene.
    """
    transform = _similarity(still, reference)
    if transform is None:
        raise MocapError(
            "does not show the same scene as the footage",
            "give a still of the same camera, or none",
            file=file,
        )
    height, width = reference.shape[:2]
    corners = np.array([[0, 0, 1], [width, 0, 1], [0, height, 1], [width, height, 1]], float)
    shifts = np.linalg.norm(corners @ transform.T - corners[:, :2], axis=1)
    if still.shape == reference.shape and shifts.max() < _ALIGNED_PX:
        return still
    return cv2.warpAffine(
        still, transform, (width, height), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )


def _similarity(still: np.ndarray, reference: np.ndarray) -> np.ndarray | None:
    sift = cv2.SIFT.create(_FEATURES)
    (spots, words), (targets, target_words) = (
        sift.detectAndCompute(
            cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), np.full(picture.shape[:2], 255, np.uint8)
        )
        for picture in (still, reference)
    )
    if words is None or target_words is None or min(len(words), len(target_words)) < _FEWEST:
        return None
    pairs = cv2.BFMatcher().knnMatch(words, target_words, k=2)
    good = [first for first, second in pairs if first.distance < _RATIO * second.distance]
    if len(good) < _FEWEST:
        return None
    transform, inside = cv2.estimateAffinePartial2D(
        np.array([spots[match.queryIdx].pt for match in good]),
        np.array([targets[match.trainIdx].pt for match in good]),
        ransacReprojThreshold=_REACH_PX,
    )
    return transform if transform is not None and inside.sum() >= _FEWEST else None
