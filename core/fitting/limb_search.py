"""Looking for one limb elsewhere while the rest of the body stands still.

Poses of the limb are compared in generations, by the exact energy with everything else masked out:
first about where the limb is expected, or everywhere that it can be, then nearer and nearer about
the best. The rest prior and a pull towards the expected pose keep what silhouettes cannot tell.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..body.body import Body, Part
from ..body.kinematics import clamped
from .part_search import rest_prior
from .tracker import Tally

_ELITE = 9
"""Poses that the next generation lies about."""
_APART_RAD = 0.25
"""Of poses that differ by less in every DOF, one is enough."""


@dataclass(frozen=True)
class LimbSettings:
    """How hard a limb is sought.

    Attributes:
        near: poses about the expected ones, in each generation.
        everywhere: poses over the whole range of a limb that is doubted; half as many in each
            generation after.
        spreads_rad: standard deviations of the generations.
        best: of so many poses at most that are better.
    """

    near: int = 32
    everywhere: int = 400
    spreads_rad: tuple[float, ...] = (0.4, 0.15)
    best: int = 2


@dataclass(frozen=True, eq=False)
class LimbCost:
    """Costs of poses whose limb alone differs from ``pose``.

    Attributes:
        body: whose limb.
        part: the limb.
        pose: (D,) the whole body's pose.
        expected: (D,) the pose that the limb is pulled to.
        pixels: (N,) energies of poses (N, D), px.
        prior_px: energy of a squared standard deviation.
        pull_rad: standard deviation from ``expected``.
        tally: counts what is evaluated.
    """

    body: Body
    part: Part
    pose: np.ndarray
    expected: np.ndarray
    pixels: Callable[[np.ndarray], np.ndarray]
    prior_px: float
    pull_rad: float
    tally: Tally

    def __call__(self, poses: np.ndarray) -> np.ndarray:
        """(N,) energies of poses (N, D) in px, priors and all."""
        self.tally.evaluated += len(poses)
        dofs = list(self.part.dofs)
        pull = (((poses - self.expected)[:, dofs] / self.pull_rad) ** 2).sum(axis=1)
        prior = rest_prior(self.body, poses[:, dofs], dofs) + pull
        return np.round(self.pixels(poses) + self.prior_px * prior, 6)

    def moved(self, limbs: np.ndarray) -> np.ndarray:
        """Poses (N, D) as it is with limbs as in (N, D), within the limits."""
        dofs = list(self.part.dofs)
        poses = np.repeat(self.pose[None], len(limbs), axis=0)
        poses[:, dofs] = limbs[:, dofs]
        return clamped(self.body, poses)


def better_limbs(cost: LimbCost, starts: np.ndarray, settings: LimbSettings) -> np.ndarray:
    """(n, D) poses with the limb about where ``starts`` (N, D) have it, and a lower cost.

    The best come first, apart from each other.
    """
    own = cost.pose[None]
    poses = cost.moved(np.concatenate([own, starts]))
    costs, rng = cost(poses), np.random.default_rng(0)
    limit = costs[0]
    for spread in settings.spreads_rad:
        poses, costs = _next_generation(cost, poses, costs, (spread, settings.near), rng)
        if costs[0] >= limit:
            return own[:0]
    return _apart(cost.part, np.concatenate([own, poses[costs < limit]]), settings.best)


def limbs_elsewhere(
    rough: LimbCost, cost: LimbCost, starts: np.ndarray, settings: LimbSettings
) -> np.ndarray:
    """(n, D) poses of a limb that is in doubt, sought over all its range, the best first.

    Args:
        rough: cost that tells from afar where the limb may be.
        cost: the one that counts in the end.
        starts: (N, D) poses that tell where the limb may be.
        settings: how hard to look.
    """
    rng, count = np.random.default_rng(0), settings.everywhere // 2
    poses = np.concatenate([cost.moved(starts), _everywhere(cost, settings.everywhere, rng)])
    costs = rough(poses)
    for spread in settings.spreads_rad:
        poses, costs = _next_generation(rough, poses, costs, (spread, count), rng)
    costs = cost(poses)
    poses, costs = _next_generation(cost, poses, costs, (settings.spreads_rad[-1], count), rng)
    return _apart(cost.part, np.concatenate([cost.pose[None], poses]), settings.best)


def _next_generation(
    cost: LimbCost,
    poses: np.ndarray,
    costs: np.ndarray,
    spread: tuple[float, int],
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray]:
    """The best poses and costs after so many more were laid about these, the best first."""
    found = cost.moved(_scattered(cost.part, poses[:_ELITE], *spread, rng))
    poses, costs = np.concatenate([poses, found]), np.concatenate([costs, cost(found)])
    order = np.argsort(costs, kind="stable")[:_ELITE]
    return poses[order], costs[order]


def _everywhere(cost: LimbCost, count: int, rng: np.random.Generator) -> np.ndarray:
    """(count, D) poses spread over the range of the limb's grid, or all its DOFs without one.

    A Latin hypercube; scipy.stats has more even ones, and takes longer to load than to use.
    """
    dofs = list(cost.part.grid or cost.part.dofs)
    low, high = cost.body.dofs.limits[dofs].T
    limbs = np.repeat(cost.pose[None], count, axis=0)
    strata = np.repeat((np.arange(count) + 0.5)[:, None] / count, len(dofs), axis=1)
    limbs[:, dofs] = low + rng.permuted(strata, axis=0) * (high - low)
    return cost.moved(limbs)


def _scattered(
    part: Part, poses: np.ndarray, spread: float, count: int, rng: np.random.Generator
) -> np.ndarray:
    """(count, D) poses with the limb about where it is in ``poses`` (N, D)."""
    dofs = list(part.dofs)
    scattered = poses[rng.integers(0, len(poses), count)]
    scale = spread * rng.choice([0.3, 1.0], (count, 1))
    scattered[:, dofs] += scale * rng.normal(size=(count, len(dofs)))
    return scattered


def _apart(part: Part, poses: np.ndarray, most: int) -> np.ndarray:
    """Of poses (N, D) the first few after the first that are apart from all before."""
    dofs, chosen = list(part.dofs), [0]
    for index in range(1, len(poses)):
        others = poses[np.ix_(chosen, dofs)]
        if np.abs(others - poses[index, dofs]).max(axis=1).min() > _APART_RAD:
            chosen.append(index)
    return poses[chosen[1 : 1 + most]]
