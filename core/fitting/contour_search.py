"""The search of one frame for tracker ``contour``: what it knows, and the moves it can make.

Descents draw the outlines near (`contour_descent`), views that disagree count less (`view_trust`),
a limb is looked for while the rest is masked out (`limb_search`); of all poses tried the one with
the lowest energy, priors and all, is gone on with. `contour` decides which move comes when.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..body.body import Part
from ..body.kinematics import clamped
from ..energy.evaluator import Weights
from ..energy.weight_maps import drawing_weight_maps, xor_weight_maps
from ..rendering.arguments import fixed_segments
from ..silhouettes.silhouette import Silhouette
from .contour_descent import Descent, DescentSettings
from .contour_targets import ContourTargets
from .limb_search import LimbCost, LimbSettings, better_limbs, limbs_elsewhere
from .limbs import limb_names, limb_segments
from .lumps import Lumps
from .part_search import rest_prior
from .scores import metres_at
from .tracker import Past, PoseFit, Tally, shows_nobody
from .view_trust import view_weights


@dataclass(frozen=True)
class ContourSettings:
    """How a frame is searched.

    Attributes:
        descent: how a descent goes.
        reaches_m: of a descent's first and last step.
        steps: most steps of a descent.
        limbs: how limbs are sought; None for not at all.
        again: share of the reach and of the steps that these descents have.
        prior_share: energy of one standard deviation from the rest pose, as a share of the
            silhouettes' area, when ends are compared.
        drawn_from_m: where limbs in doubt are drawn from to foreground left uncovered.
        pull_rad: standard deviation of a limb's angle from what is expected, likewise.
        views_weighed: whether views that disagree with the others count less.
    """

    descent: DescentSettings = field(default_factory=DescentSettings)
    reaches_m: tuple[float, float] = (0.22, 0.06)
    steps: int = 7
    limbs: LimbSettings | None = field(default_factory=LimbSettings)
    again: float = 0.5
    prior_share: float = 1e-3
    drawn_from_m: float = 0.15
    pull_rad: float = 0.5
    views_weighed: bool = True


_RIVAL = 1.05
"""Times the cost of the best pose that a rival's may be."""


class ContourSearch:
    """The search of one frame: its targets, its weights, and the best pose so far.

    Args:
        descent: of the body in its V cameras.
        settings: how to search.
        silhouettes: V of the frame.
        past: what it is searched from.

    Attributes:
        shown: whether the silhouettes show anybody.
        pose: (D,) the best so far.
        apart_px: (V,) px that differ there.
        trust: (V,) how far the views are trusted.
        last: (D,) as in `Past`, within the limits; so are predicted and trusted.
        sought: each limb, and the head, with the index in `limb_names` that its lumps go by.
    """

    def __init__(
        self,
        descent: Descent,
        settings: ContourSettings,
        silhouettes: Sequence[Silhouette],
        past: Past,
    ):
        self.body, self.evaluator = descent.body, descent.evaluator
        self._descent, self.settings, self.past = descent, settings, past
        self.last, self.predicted, self.trusted = clamped(
            self.body, np.stack([past.last, past.predicted, past.trusted])
        )
        self.sought = [
            (limb_names(self.body).index(part.name) if part.role == "limb" else 0, part)
            for part in self.body.parts
            if part.role == "limb" or part.name == "head"
        ]
        self._limb_dofs = [dof for _, part in self.sought for dof in part.dofs]
        self._tally, self.metres = Tally(), metres_at(self.evaluator, self.last)
        self._tried: list[tuple[float, np.ndarray]] = []
        self.trust = np.ones(len(silhouettes))
        self.look_at(silhouettes)
        covered = [np.count_nonzero(picture) for picture in self.evaluator.silhouettes(self.last)]
        self.shown_px = self._weights.constants + covered
        observed_px = int(self._weights.constants.sum())
        self.shown = not shows_nobody(observed_px, sum(covered))
        self._prior_px = settings.prior_share * observed_px

    @property
    def fit(self) -> PoseFit:
        """The best pose, what it took, and what comes near."""
        most = _RIVAL * min((cost for cost, _ in self._tried), default=0.0)
        rivals = tuple(pose for cost, pose in self._tried if cost < most)
        return PoseFit(self.pose, int(self.apart_px.sum()), self._tally, rivals)

    def look_at(self, silhouettes: Sequence[Silhouette]) -> None:
        """Searches for what explains these V from now on."""
        spacing_m = self.settings.descent.spacing_m
        self.silhouettes = silhouettes
        self._weights = self.evaluator.prepared(xor_weight_maps(silhouettes))
        self._targets = ContourTargets.of(self.evaluator, silhouettes, self.metres, spacing_m)
        self._targets.shares = self.trust
        self._spacing_px = float((spacing_m / self.metres).max())

    def trust_views(self, trust: np.ndarray | None = None) -> float:
        """Trusts each view as far as the pose explains it, or as told; returns the most changed."""
        if trust is None:
            weighed = self.settings.views_weighed
            trust = view_weights(self.apart_px, self.shown_px) if weighed else self.trust
        changed = float(np.abs(trust - self.trust).max())
        self.trust = self._targets.shares = trust
        return changed

    def expect(self, pose: np.ndarray) -> None:
        """Takes a pose (D,) for the last, the predicted and the trusted one."""
        self.last = self.predicted = self.trusted = pose

    def take(self, poses: np.ndarray) -> None:
        """Goes on with whichever of the poses (N, D) has the lowest energy, priors and all."""
        pixels = self._energies(poses)
        away = (poses - self.trusted)[:, self._limb_dofs] / self.settings.pull_rad
        prior = rest_prior(self.body, poses) + (away**2).sum(axis=1)
        costs = np.round(pixels @ self.trust + self._prior_px * prior, 6)
        self._tried += zip(costs.tolist(), poses, strict=True)
        best = int(np.argmin(costs))
        self.pose, self.apart_px = poses[best], pixels[best]

    def costs(self, poses: np.ndarray) -> np.ndarray:
        """(N,) energies of poses (N, D) with the rest prior, px, whatever is expected."""
        return self._energies(poses) @ self.trust + self._prior_px * rest_prior(self.body, poses)

    def descended(self, start: np.ndarray, expected: np.ndarray, share: float) -> np.ndarray:
        """(D,) the pose that a descent from a start (D,) ends at, pulled to what is expected (D,).

        ``share`` is that of the settings' reach and steps.
        """
        first, last = self.settings.reaches_m
        reaches = np.geomspace(max(first * share, last), last, round(self.settings.steps * share))
        return self._descent.run(self._targets, self._spacing_px, start, expected, reaches)

    def go_on_from(self, starts: Sequence[np.ndarray]) -> None:
        """Descends once more, from each start (D,), and keeps the best."""
        ends = [self.descended(start, self.pose, self.settings.again) for start in starts]
        self.take(np.stack([self.pose, *ends]))

    def seek(self, part: Part, everywhere: bool) -> None:
        """Looks for a limb elsewhere, and descends from the better places found."""
        settings = self.settings.limbs
        assert settings is not None
        cost = self._limb_cost(part, self._weights)
        starts = np.stack([self.last, self.predicted, self.trusted])
        if everywhere and settings.everywhere:
            others = fixed_segments(self.body, part.segments)
            covered = self.evaluator.silhouettes(self.pose, others)
            reaches_px = (self.settings.drawn_from_m / self.metres).tolist()
            maps = drawing_weight_maps(self.silhouettes, covered, reaches_px)
            rough = self._limb_cost(part, self.evaluator.prepared(maps))
            found = limbs_elsewhere(rough, cost, starts, settings)
        else:
            found = better_limbs(cost, starts, settings)
        self.go_on_from(list(found))

    def lumps(self, pose: np.ndarray) -> np.ndarray:
        """(2, L) `Lumps.of_limbs` of `limb_names` in a pose (D,)."""
        lumps = Lumps.of(self.evaluator.silhouettes(pose), self.silhouettes, self.metres)
        return lumps.of_limbs(self.evaluator, pose, limb_segments(self.body), self.trust)

    def _energies(self, poses: np.ndarray) -> np.ndarray:
        self._tally.evaluated += len(poses)
        return self.evaluator.energies(self._weights, poses)

    def _limb_cost(self, part: Part, weights: Weights) -> LimbCost:
        masked = self.evaluator.masked(weights, self.pose, part.segments)

        def pixels(poses: np.ndarray) -> np.ndarray:
            return self.evaluator.energies(masked, poses, part.segments) @ self.trust

        priors = (self._prior_px, self.settings.pull_rad, self._tally)
        return LimbCost(self.body, part, self.pose, self.trusted, pixels, *priors)
