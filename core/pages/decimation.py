"""Long series drawn with few points: every pixel column keeps its lowest and highest value.

A line drawn through the two extremes of each column covers the same pixels as one through all
values, so that no single bad frame disappears from a plot of 10,000.
"""

import numpy as np


def runs(frames: np.ndarray, values: np.ndarray) -> list[slice]:
    """The stretches of consecutive ``frames`` (T,) with finite ``values`` (T,), in order."""
    good = np.flatnonzero(np.isfinite(values))
    if not len(good):
        return []
    breaks = np.flatnonzero((np.diff(good) > 1) | (np.diff(frames[good]) > 1)) + 1
    return [slice(int(part[0]), int(part[-1]) + 1) for part in np.split(good, breaks)]


def decimated(columns: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Rising indices of the lowest and the highest finite value of every column.

    Args:
        columns: (n,) int, rising, the pixel column of each value.
        values: (n,) finite.
    """
    starts = np.flatnonzero(np.r_[True, np.diff(columns) != 0])
    if 2 * len(starts) >= len(values):
        return np.arange(len(values))
    order = np.lexsort((values, columns))
    last = np.r_[starts[1:], len(values)] - 1
    # sorted by column, then value: a column's lowest comes first and its highest last
    return np.unique(np.concatenate([order[starts], order[last]]))
