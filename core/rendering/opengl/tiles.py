"""Where the views lie in one large picture: every view's window is a tile of it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Tiles:
    """Tiles of some views, side by side in a block that can be repeated.

    Attributes:
        views: (k,) indices of the views.
        windows: (k, 4) px x0, y0, x1, y1 of each view's picture, not empty.
        places: (k, 2) px, the corner of each tile in the block.
        size: (width, height) of the block in px.
    """

    views: np.ndarray
    windows: np.ndarray
    places: np.ndarray
    size: tuple[int, int]

    @property
    def sizes(self) -> np.ndarray:
        """(k, 2) px, width and height of each tile."""
        return self.windows[:, 2:] - self.windows[:, :2]

    @property
    def areas(self) -> np.ndarray:
        """(k, 4) px x0, y0, x1, y1 of each tile in the block."""
        return np.concatenate([self.places, self.places + self.sizes], axis=1)


def clipped_windows(sizes: np.ndarray, windows: np.ndarray | None) -> np.ndarray:
    """(V, 4) px: what of each window (V, 4) lies in the picture, whose sizes are (V, 2)."""
    whole = np.concatenate([np.zeros_like(sizes), sizes], axis=1)
    if windows is None:
        return whole
    windows = np.asarray(windows, np.int64)
    if windows.shape != whole.shape:
        raise ValueError(f"expected windows of shape (V, 4), got {windows.shape}")
    low = np.clip(windows[:, :2], 0, sizes)
    return np.concatenate([low, np.clip(windows[:, 2:], low, sizes)], axis=1)


def packed(windows: np.ndarray, side: int, area: int) -> tuple[Tiles, ...]:
    """Blocks that hold all windows (V, 4), but for empty ones.

    Args:
        windows: px of each view.
        side: the most px that a block may be wide or high.
        area: the most px that a block may have, unless it is a single tile.

    Raises:
        ValueError: a window wider or higher than ``side``.
    """
    sizes = windows[:, 2:] - windows[:, :2]
    if (sizes > side).any():
        raise ValueError(f"expected windows of at most {side} px, got {sizes.max()}")
    views = [v for v in np.argsort(-sizes[:, 1], kind="stable") if sizes[v].all()]
    blocks: list[Tiles] = []
    while views:
        taken = _fitting(sizes[views], side, area)
        blocks.append(_in_rows(views[:taken], windows, side))
        views = views[taken:]
    return tuple(blocks)


def _fitting(sizes: np.ndarray, side: int, area: int) -> int:
    """How many of the tiles, at least one, fit into one block."""
    for count in range(len(sizes), 1, -1):
        width, height = _row_places(sizes[:count], side)[1]
        if height <= side and width * height <= area:
            return count
    return 1


def _in_rows(views: Sequence[int], windows: np.ndarray, side: int) -> Tiles:
    chosen = windows[list(views)]
    places, size = _row_places(chosen[:, 2:] - chosen[:, :2], side)
    return Tiles(np.array(views), chosen, places, size)


def _row_places(sizes: np.ndarray, side: int) -> tuple[np.ndarray, tuple[int, int]]:
    """Corners of tiles (k, 2), highest first, set in rows about as wide as all are high."""
    widest = min(side, max(int(np.sqrt(sizes.prod(axis=1).sum())), int(sizes[:, 0].max())))
    places, x, y, row = [], 0, 0, 0
    for width, height in sizes.tolist():
        if x + width > widest:
            x, y, row = 0, y + row, 0
        places.append((x, y))
        x, row = x + width, max(row, height)
    corners = np.array(places)
    return corners, (int((corners[:, 0] + sizes[:, 0]).max()), y + row)
