"""Front or back, told by the feet: toes reach further from the ankles than heels do."""

from collections.abc import Sequence

import numpy as np

from .seen_view import SeenView

_REACHES = (0.07, 0.085, 0.1)
"""From the ankles, in heights of the performer: beyond the heels, within the toes."""
_HEIGHTS = (0.01, 0.02, 0.03)
"""Above the floor, likewise."""
_LEAST_ASIDE = 0.4
_LEAST_MARGIN = 0.05


def facing_sign(
    views: Sequence[SeenView], ankles: np.ndarray, front: np.ndarray, floor: float
) -> int:
    """1 where the toes point along ``front``, -1 where against it, 0 where no view tells.

    Args:
        views: of one frame.
        ankles: (2, 3) world metres; their height does not matter.
        front: (3,) horizontal direction, as long as the performer is tall.
        floor: its height in the world.
    """
    feet = ankles * [1.0, 1.0, 0.0] + [0.0, 0.0, floor]
    ahead, behind = [], []
    for view in views:
        if abs(view.right @ front) < _LEAST_ASIDE * np.linalg.norm(front):
            continue
        ahead.append(_shown(view, feet, front))
        behind.append(_shown(view, feet, -front))
    if not ahead:
        return 0
    margin = float(np.mean(ahead) - np.mean(behind))
    return int(np.sign(margin)) if abs(margin) >= _LEAST_MARGIN else 0


def _shown(view: SeenView, feet: np.ndarray, way: np.ndarray) -> float:
    """Share of the places where feet (2, 3) along ``way`` would be that the view has filled."""
    up = np.array([0.0, 0.0, np.linalg.norm(way)])
    shifts = np.array([reach * way + height * up for reach in _REACHES for height in _HEIGHTS])
    px = view.camera.project((feet[:, None] + shifts).reshape(-1, 3))
    columns, rows = np.nan_to_num(px, nan=-1.0).round().astype(int).T
    height, width = view.silhouette.foreground.shape
    within = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    shown = view.silhouette.foreground[np.where(within, rows, 0), np.where(within, columns, 0)]
    return float((shown & within).mean())
