"""Gaps where performer and scene have the same colour."""

import cv2
import numpy as np

_BIN = 16
_BINS = 256 // _BIN
_SHARE = 0.01
_SURROUNDED = 0.6


def own_colours(colours: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """(H, W) bool, True where a colour is common in the foreground.

    Args:
        colours: (H, W, 3) picture, grey levels 0 to 255.
        mask: (H, W) bool foreground; common is what makes up at least 1 % of it.
    """
    bins = np.clip(colours / _BIN, 0, _BINS - 1).astype(np.int32)
    index = (bins[..., 0] * _BINS + bins[..., 1]) * _BINS + bins[..., 2]
    counts = np.bincount(index[mask], minlength=_BINS**3)
    return (counts > _SHARE * max(np.count_nonzero(mask), 1))[index]


def bridged(mask: np.ndarray, own: np.ndarray) -> np.ndarray:
    """``mask`` with the gaps of the performer's own colours that it surrounds to at least 60 %.

    The loop of an arm on the hip shows the scene in other colours and stays.

    Args:
        mask: (H, W) bool foreground.
        own: (H, W) bool as from ``own_colours``.
    """
    count, labels = cv2.connectedComponents((own & ~mask).astype(np.uint8), connectivity=4)
    rim, touching = np.zeros(count), np.zeros(count)
    for here, there in _sides():
        leaves = labels[here] != labels[there]
        gaps = labels[here][leaves]
        rim += np.bincount(gaps, minlength=count)
        touching += np.bincount(gaps, weights=mask[there][leaves], minlength=count)
    filled = touching >= _SURROUNDED * np.maximum(rim, 1)
    filled[0] = False
    return mask | filled[labels]


def _sides():
    front, back, everything = slice(None, -1), slice(1, None), slice(None)
    for first, second in (((front, everything), (back, everything)),
                          ((everything, front), (everything, back))):  # fmt: skip
        yield first, second
        yield second, first
