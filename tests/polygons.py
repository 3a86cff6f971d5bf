"""Closed contours made of corners."""

import numpy as np


def polygon(*corners: tuple[float, float]) -> np.ndarray:
    """The closed contour through corners, its points 1/500 apart."""
    pieces = []
    for begin, end in zip(corners, corners[1:] + corners[:1], strict=True):
        begin, end = np.array(begin), np.array(end)
        count = max(2, round(np.linalg.norm(end - begin) * 500))
        pieces.append(begin + np.linspace(0, 1, count, endpoint=False)[:, None] * (end - begin))
    return np.concatenate(pieces)
