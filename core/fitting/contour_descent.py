"""Gauss-Newton steps that draw a pose's outline towards the observed contours.

Distances are in metres, so that resolution changes nothing; how far they reach narrows from step
to step. The rest prior holds what silhouettes cannot tell, a pull towards the expected pose keeps
steps short where they tell nothing. Limits hold at every step: what they stop stays at the limit,
and the other DOFs are solved for again.
"""

from dataclasses import dataclass

import numpy as np

from ..body.body import Body, DofKind
from ..body.kinematics import clamped
from ..energy.evaluator import Evaluator
from .contour_targets import ContourTargets
from .twists import Twists

_ROUNDS = 6
"""Most times that a step is solved for again with more DOFs at their limits."""


@dataclass(frozen=True)
class DescentSettings:
    """How a descent goes.

    Attributes:
        spacing_m: between points of outlines and of contours.
        deviation_m: standard deviation of a point's distance.
        turn_m: how far apart normals that differ by a radian count.
        rest: weight of the rest prior per thousand points.
        pull_m: standard deviation of a translation from the expected pose.
        pull_rad: of an angle.
        damping: share added to the normal equations' diagonal.
        longest_m: change of a translation in one step.
        longest_rad: change of an angle in one step.
        still: rad or m; a smaller step is the last one.
    """

    spacing_m: float = 0.03
    deviation_m: float = 0.015
    turn_m: float = 0.09
    rest: float = 6.0
    pull_m: float = 0.1
    pull_rad: float = 0.5
    damping: float = 1e-3
    longest_m: float = 0.15
    longest_rad: float = 0.4
    still: float = 2e-4


class Descent:
    """Descents of one body in fixed cameras.

    Args:
        body: whose pose is sought.
        evaluator: draws its outlines.
        settings: how.
    """

    def __init__(self, body: Body, evaluator: Evaluator, settings: DescentSettings):
        self.body, self.evaluator, self.settings = body, evaluator, settings
        self._twists = Twists(body)
        shifts = body.dofs.kinds == DofKind.TRANSLATION
        self._longest = np.where(shifts, settings.longest_m, settings.longest_rad)
        self._pull = 1.0 / np.where(shifts, settings.pull_m, settings.pull_rad) ** 2
        self._rest = settings.rest / 1000 / body.dofs.rest_spread**2

    def run(
        self,
        targets: ContourTargets,
        spacing_px: float,
        start: np.ndarray,
        expected: np.ndarray,
        reaches_m: np.ndarray,
    ) -> np.ndarray:
        """(D,) the pose after at most one step per reach, from ``start`` (D,), within the limits.

        Outlines are sampled every ``spacing_px``; the pull goes to ``expected`` (D,).
        """
        pose = clamped(self.body, start[None])[0]
        for reach in reaches_m.tolist():
            matrix, slope = self._equations(targets, spacing_px, pose, expected, reach)
            moved = self._moved(pose, matrix, slope)
            change, pose = np.abs(moved - pose).max(), moved
            if change < self.settings.still:
                break
        return pose

    def _equations(
        self, targets, spacing_px, pose, expected, reach
    ) -> tuple[np.ndarray, np.ndarray]:
        transforms, twists = self._twists.at(pose)
        outlines = self.evaluator.outline(pose, None, spacing_px)
        terms = targets.terms(outlines, transforms, reach, self.settings.turn_m)
        matrix, slope = (part / self.settings.deviation_m**2 for part in terms.gathered(twists))
        stiffness, force = self.priors(pose, expected, int(terms.count.sum()))
        matrix[np.diag_indices(len(pose))] += stiffness
        return matrix, slope + force

    def priors(
        self, pose: np.ndarray, expected: np.ndarray, count: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """(D,) diagonal and (D,) slope of rest prior and pull, beside ``count`` distances."""
        rest = self._rest * count
        return rest + self._pull, rest * pose + self._pull * (pose - expected)

    def _moved(self, pose: np.ndarray, matrix: np.ndarray, slope: np.ndarray) -> np.ndarray:
        """(D,) the pose after a damped step."""
        damped = matrix + np.diag(self.settings.damping * np.diag(matrix))
        step, held = np.zeros(len(pose)), np.zeros(len(pose), bool)
        moved = pose
        for _ in range(_ROUNDS):
            free = np.flatnonzero(~held)
            rest = slope[free] + damped[np.ix_(free, held)] @ step[held]
            step[free] = -np.linalg.solve(damped[np.ix_(free, free)], rest)
            step /= max(1.0, (np.abs(step) / self._longest).max())
            moved = clamped(self.body, (pose + step)[None])[0]
            stopped = ~held & (np.abs(moved - pose - step) > 1e-9)
            if not stopped.any():
                break
            held |= stopped
            step[held] = moved[held] - pose[held]
        return moved
