"""How far each view of a frame is trusted: a view that disagrees while the others agree is not.

Where the model fits most silhouettes, one that it does not fit was segmented badly, or shows
another moment or place. Where it fits none, the pose is wrong, and no view is to blame.
"""

import numpy as np

_USUAL = 1.3
"""Times the views' median."""
_SLACK = 0.06
_HALVED = 0.1
"""Disagreement beyond the usual that halves a view's trust twice."""


def view_weights(differing_px: np.ndarray, shown_px: np.ndarray) -> np.ndarray:
    """(V,) trust from 0 to 1.

    A view's disagreement is its ``differing_px`` (V,) as a share of ``shown_px`` (V,), the area of
    its silhouette and of the model's together: 0 where they cover each other, 1 where they lie
    apart. It is compared with the median over the views that show anything; what goes beyond
    counts as in the robust function of Geman and McClure.
    """
    shown = shown_px > 0
    if not shown.any():
        return np.ones(len(shown_px))
    apart = np.where(shown, differing_px / np.maximum(shown_px, 1), 0.0)
    beyond = np.maximum(0.0, apart - _USUAL * np.median(apart[shown]) - _SLACK)
    return 1.0 / (1.0 + (beyond / _HALVED) ** 2) ** 2
