"""How likely each point is where it was found.

A logistic model of what a fit can know without the truth: how well the silhouettes fix the point,
how far its limb's outline lies from the contours, and what of the footage and the limb is left
unexplained. Its weights were found by maximum likelihood on takes with known motion, undisturbed
and disturbed: points beyond 50 mm against the rest, those beyond 150 mm counted 400 times, as a
point that is lost and not told costs more than one that is doubted in vain.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .limbs import POINT_LIMBS

WEIGHTS = np.array([2.954, -3.494, -0.501, -14.47, -15.696])
"""Of 1, ln(spread / 10 mm), ln(residual / 10 mm), share unexplained, and the root of the lumps, m^2
per view, beyond the usual ones. More of any but the first is never likelier."""
_USUAL = 1.4
"""Times the usual lumps that are usual, too."""
_LEAST_M = 0.002
_UNSEEN_M = 0.3
"""Residual of a limb that no view shows."""


@dataclass(frozen=True, eq=False)
class LimbSigns:
    """Signs of error of each of L limbs.

    Attributes:
        residual: (L,) m, mean distance of its outline to the contours; NaN where no view shows it.
        lumps: (L,) m^2 per view of `Lumps` that it may explain.
        unexplained: (L,) share of what it covers that is background.
        usual: (L,) lumps that the frames before had usually; infinite where there were none.
    """

    residual: np.ndarray
    lumps: np.ndarray
    unexplained: np.ndarray
    usual: np.ndarray


def features(
    point_spreads: np.ndarray, signs: LimbSigns, point_limbs: Sequence[int] = POINT_LIMBS
) -> np.ndarray:
    """(P, 5) what `WEIGHTS` weigh.

    Args:
        point_spreads: (P,) m, those of `Observability`.
        signs: of the limbs.
        point_limbs: (P,) the limb that moves each point; a person's by default.
    """
    limbs = list(point_limbs)
    residual = np.maximum(np.nan_to_num(signs.residual, nan=_UNSEEN_M), _LEAST_M)
    spread = np.log(np.maximum(point_spreads, _LEAST_M) / 0.01)
    columns = (
        np.ones(len(limbs)),
        spread,
        np.log(residual / 0.01)[limbs],
        signs.unexplained[limbs],
        np.sqrt(np.maximum(signs.lumps - _USUAL * signs.usual, 0.0))[limbs],
    )
    return np.stack(columns, axis=1)


def point_confidence(
    point_spreads: np.ndarray, signs: LimbSigns, point_limbs: Sequence[int] = POINT_LIMBS
) -> np.ndarray:
    """(P,) probability that each point is off by less than 50 mm, from `features`."""
    return 1.0 / (1.0 + np.exp(-features(point_spreads, signs, point_limbs) @ WEIGHTS))
