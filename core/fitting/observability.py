"""How well the silhouettes of a frame fix its pose.

The normal equations of the outlines' distances at the pose found tell how far each DOF may turn
before the silhouettes notice: an arm before the chest in all views, the twist of a straight limb
and the turn of a round head hardly change any outline, so that only the priors hold them. A limb
that lies off every contour is fixed by nothing either, as distances beyond the reach count for
next to nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..body.body import Body, DofKind
from ..body.kinematics import carried_points
from ..energy.evaluator import Evaluator
from ..silhouettes.silhouette import Silhouette
from .contour_targets import ContourTargets
from .twists import Twists

UNOBSERVED = 0.2
"""Spread, rad or m, of a DOF that the silhouettes do not tell: the priors hold it."""
_SPACING_M = 0.03
_DEVIATION_M = 0.03
"""Standard deviation of a distance; its points are as good as independent of each other."""
_REACH_M, _TURN_M = 0.06, 0.09
_FREE_M, _FREE_RAD = 0.3, 1.0
"""Standard deviations of a DOF that neither silhouettes nor the rest prior fix."""


@dataclass(frozen=True, eq=False)
class Observability:
    """What silhouettes tell about one pose.

    Attributes:
        dof_spreads: (D,) standard deviation of each DOF, rad or m.
        point_spreads: (P,) of the place of each of the body's points, m.
    """

    dof_spreads: np.ndarray
    point_spreads: np.ndarray

    @classmethod
    def of(
        cls,
        evaluator: Evaluator,
        pose: np.ndarray,
        silhouettes: Sequence[Silhouette],
        view_weights: np.ndarray,
        metres: np.ndarray,
    ) -> "Observability":
        """Of a pose (D,) against V silhouettes.

        Args:
            evaluator: draws the body.
            pose: that was found.
            silhouettes: what the views show.
            view_weights: (V,) how far each view is trusted.
            metres: (V,) m that a pixel is wide where the performer stands.
        """
        body = evaluator.body
        targets = ContourTargets.of(evaluator, silhouettes, metres, _SPACING_M)
        targets.shares = view_weights
        transforms, twists = _twists(body).at(pose)
        outlines = evaluator.outline(pose, None, float((_SPACING_M / metres).max()))
        matrix, _ = targets.terms(outlines, transforms, _REACH_M, _TURN_M).gathered(twists)
        free = np.where(body.dofs.kinds == DofKind.TRANSLATION, _FREE_M, _FREE_RAD)
        priors = 1.0 / np.minimum(free, body.dofs.rest_spread) ** 2
        covariance = np.linalg.inv(matrix / _DEVIATION_M**2 + np.diag(priors))
        moves = _point_moves(body, transforms, twists)
        variances = (moves @ covariance * moves).sum(axis=(1, 2))
        return cls(np.sqrt(np.diag(covariance)), np.sqrt(variances))


@lru_cache(maxsize=16)
def _twists(body: Body) -> Twists:
    return Twists(body)


def _point_moves(body: Body, transforms: np.ndarray, twists: np.ndarray) -> np.ndarray:
    """(P, 3, D) change of the points' places, m, with each DOF; of `Twists.at`."""
    places = carried_points(body, transforms[None])[0]
    carried = twists[body.point_joints]
    return np.moveaxis(carried[..., :3] + np.cross(carried[..., 3:], places[:, None]), 1, 2)
