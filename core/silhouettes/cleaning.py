"""Removes specks and fills pinholes, and nothing else.

Only what is too small to be part of a person goes: a hand at the end of a thin, broken arm stays,
and so does the hole between an arm on the hip and the trunk, which tells where the elbow is.
Sizes are measured against the largest connected foreground, taken as the performer, so that the
same settings serve every resolution and distance.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np

from ..geometry.boxes import box_round


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

    Specks are joined over corners, holes over edges only, as complements must be. Background that
    goes on beyond the box round all foreground is no hole.
    """
    whole, box = mask.copy(), box_round(mask, margin_px=1)
    part = whole[box]
    labels, areas = _components(part, connectivity=8)
    largest = areas[1:].max(initial=0)
    small = areas < cleaning.speck * largest
    small[0] = False
    if small.any():
        part &= ~small[labels]
    labels, areas = _components(~part, connectivity=4)
    filled = areas < cleaning.hole * largest
    filled[[0, *_going_on(labels, box, mask.shape)]] = False
    if filled.any():
        part |= filled[labels]
    return Cleaned(whole, int(small.sum()), int(filled.sum()))


def _components(mask: np.ndarray, connectivity: int) -> tuple[np.ndarray, np.ndarray]:
    """Labels (H, W), 0 outside the mask, and (n,) px of each."""
    _, labels, stats, _ = cv2.connectedComponentsWithStats(
        mask.view(np.uint8), connectivity=connectivity
    )
    return labels, stats[:, cv2.CC_STAT_AREA]


def _going_on(
    labels: np.ndarray, box: tuple[slice, slice], shape: tuple[int, ...]
) -> Iterator[int]:
    """Labels of what goes on beyond a box, whose rim is one label where the picture goes on."""
    (rows, columns), (height, width) = box, shape
    if rows.start > 0 or columns.start > 0:
        yield labels[0, 0]
    if rows.stop < height or columns.stop < width:
        yield labels[-1, -1]
