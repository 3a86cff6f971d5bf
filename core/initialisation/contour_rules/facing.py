"""Front or back, told by the feet: toes reach further from the shanks than heels do.

In any view but a frontal one, the feet stick out further on the side that the performer looks to,
the more so the more it is a view from the side.
"""

from collections.abc import Sequence

import numpy as np

from .seen_view import SeenView

_FEET, _SHANKS = (0.0, 0.1), (0.16, 0.26)
"""Heights of feet and shanks above the lowest point, seen from so little above as allowed."""
_STEEPEST = 0.6
"""Sine of the elevation up to which they are apart in a picture."""
_LEAST_ASIDE = 0.3
"""Sine of the angle to the frontal direction, from which on a view tells."""
_LEAST = 0.015
"""By which toes have to reach further than heels, as a share of the height, to tell."""


def facing_sign(views: Sequence[SeenView], centre: np.ndarray, front: np.ndarray) -> int:
    """1 where the toes point along ``front``, -1 where against it, 0 where no view tells.

    Args:
        views: of one frame.
        centre: (3,) the middle of the performer, world metres.
        front: (3,) horizontal unit direction.
    """
    reaches, weights = [], []
    for view in views:
        way = view.camera.centre - centre
        sideways = float(view.right @ front)
        level = abs(way[2]) <= _STEEPEST * np.linalg.norm(way)
        if view.whole and level and abs(sideways) >= _LEAST_ASIDE:
            reaches.append(np.sign(sideways) * _reach_to_the_right(view))
            weights.append(abs(sideways))
    if not weights:
        return 0
    reach = float(np.average(reaches, weights=weights))
    return int(np.sign(reach)) if abs(reach) >= _LEAST else 0


def _reach_to_the_right(view: SeenView) -> float:
    """How much further the feet reach beyond the shanks on the right than on the left, heights."""
    assert view.outline is not None
    across, heights = view.outline.points.T
    feet, shanks = (across[(heights >= a) & (heights <= b)] for a, b in (_FEET, _SHANKS))
    return float((feet.max() - shanks.max()) - (shanks.min() - feet.min()))
