"""How likely each point is where it was found.

A logistic model of what a fit can know without the truth: how well the silhouettes fix the point,
how far its limb's outline lies from the contours, and what of the footage and the limb is left
unexplained. Its weights were found by maximum likelihood on takes with known motion, undisturbed
and disturbed, points beyond 50 mm against the rest.
"""

import numpy as np

from ..body.body import POINT_NAMES
from .limbs import limb_of

WEIGHTS = np.array([-1.2, -1.1, -1.0, -6.0])
"""Of 1, ln(spread / 10 mm), ln(residual / 10 mm) and the lumps in m^2 per view."""
_LEAST_M = 0.002
_UNSEEN_M = 0.3
"""Residual of a limb that no view shows."""


def features(point_spreads: np.ndarray, limb_residual: np.ndarray, lumps: np.ndarray) -> np.ndarray:
    """(14, 4) what `WEIGHTS` weigh.

    Args:
        point_spreads: (14,) m, `Observability.point_spreads`.
        limb_residual: (5,) m, mean distance of each limb's outline; NaN where no view shows it.
        lumps: (5,) m^2 per view that each limb may explain.
    """
    limbs = [limb_of(name) for name in POINT_NAMES]
    residual = np.maximum(np.nan_to_num(limb_residual, nan=_UNSEEN_M), _LEAST_M)[limbs]
    spreads = np.maximum(point_spreads, _LEAST_M)
    return np.stack(
        [np.ones(len(limbs)), np.log(spreads / 0.01), np.log(residual / 0.01), lumps[limbs]], axis=1
    )


def point_confidence(
    point_spreads: np.ndarray, limb_residual: np.ndarray, lumps: np.ndarray
) -> np.ndarray:
    """(14,) probability that each point is off by less than 50 mm, from `features`."""
    return 1.0 / (1.0 + np.exp(-features(point_spreads, limb_residual, lumps) @ WEIGHTS))
