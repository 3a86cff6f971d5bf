"""Removes specks and fills pinholes, and nothing else.

Only what is too small to be part of a person goes: a hand at the end of a thin, broken arm stays,
and so does the hole between an arm on the hip and the trunk, which tells where the elbow is.
Sizes are measured against the largest connected foreground, taken as the performer, so that the
same settings serve every resolution and distance.
"""

from dataclasses import dataclass

import cv2
import numpy as np


@dataclass(frozen=True)
class Cleaning:
    """What counts as small.

    Attributes:
        speck: foreground patches under this share of the performer's area go.
        hole: background holes under this share of the performer's area are filled; a loop of an
            arm on the hip covers 1 % or more.
    """

    speck: float = 0.01
    hole: float = 0.002

    def __post_init__(self):
        for name in ("speck", "hole"):
            if not 0 <= getattr(self, name) < 1:
                raise ValueError(f"expected {name} between 0 and 1, got {getattr(self, name)}")


@dataclass(frozen=True, eq=False)
class Cleaned:
    """A cleaned mask and what it took.

    Attributes:
        mask: (H, W) bool.
        specks: patches removed.
        holes: holes filled.
    """

    mask: np.ndarray
    specks: int
    holes: int


def cleaned(mask: np.ndarray, cleaning: Cleaning) -> Cleaned:
    """``mask`` (H, W) bool without small specks and holes.

    Specks are joined over corners, holes over edges only, as complements must be.
    """
    labels, areas = _components(mask, connectivity=8)
    largest = areas.max(initial=0)
    small = areas < cleaning.speck * largest
    kept = mask & ~np.concatenate([[False], small])[labels] if small.any() else mask.copy()
    labels, areas = _components(~kept, connectivity=4)
    filled = areas < cleaning.hole * largest
    if filled.any():
        kept |= np.concatenate([[False], filled])[labels]
    return Cleaned(kept, int(small.sum()), int(filled.sum()))


def _components(mask: np.ndarray, connectivity: int) -> tuple[np.ndarray, np.ndarray]:
    _, labels, stats, _ = cv2.connectedComponentsWithStats(
        mask.astype(np.uint8), connectivity=connectivity
    )
    return labels, stats[1:, cv2.CC_STAT_AREA]
