"""Tracker ``contour``: outlines drawn to the observed contours, judged by the exact energy.

Each frame descends from the predicted pose and from the last one (`contour_descent`); the exact
XOR energy says which end is better. Then each limb, and the head, is judged by itself: a batch of
its poses is compared while the rest is masked out. Where one of them is better than the pose found,
more are laid about the best, narrower and narrower, and the best few that stand apart descend in
turn. The exact energy of the whole body has the last word.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..body.body import Body, Part
from ..body.kinematics import clamped
from ..cameras.camera import Camera
from ..energy.weight_maps import xor_weight_maps
from ..silhouettes.silhouette import Silhouette
from .contour_descent import Descent, DescentSettings
from .contour_targets import ContourTargets
from .limb_search import LimbCost, LimbSettings, better_limbs
from .lumps import Lumps
from .part_search import rest_prior
from .scores import LIMB_NAMES, limb_segments, metres_at
from .tracker import LEAST_AREA, EvaluatorFactory, Past, PoseFit, Tally
from .view_trust import view_weights

_TRUST_CHANGED = 0.3
"""Of a view, so that the pose is worth another descent."""
_USUAL = 1.4
"""Times what lumps there usually are, that are nothing to worry about."""
_LITTLE_M2 = 0.006
"""Lumps in all views together that raise no doubt about a limb."""


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
        views_weighed: whether views that disagree with the others count less.
    """

    descent: DescentSettings = field(default_factory=DescentSettings)
    reaches_m: tuple[float, float] = (0.22, 0.06)
    steps: int = 7
    limbs: LimbSettings | None = field(default_factory=LimbSettings)
    again: float = 0.5
    prior_share: float = 1e-3
    views_weighed: bool = True


class ContourTracker:
    """Fits one frame after another; keeps no state between frames.

    Args:
        body: whose pose is searched.
        cameras: V pinhole cameras.
        make_evaluator: of the body in cameras.
        settings: how to search.
    """

    def __init__(
        self,
        body: Body,
        cameras: tuple[Camera, ...],
        make_evaluator: EvaluatorFactory,
        settings: ContourSettings | None = None,
    ):
        self.body, self.cameras = body, cameras
        self.settings = settings or ContourSettings()
        self.evaluator = make_evaluator(body, cameras)
        self.descent = Descent(body, self.evaluator, self.settings.descent)
        self.sought = [
            (LIMB_NAMES.index(part.name) if part.role == "limb" else 0, part)
            for part in body.parts
            if part.role == "limb" or part.name == "head"
        ]

    def fit(self, silhouettes: tuple[Silhouette, ...], past: Past) -> PoseFit:
        """The pose that explains the V silhouettes best.

        Where the views show nobody, it is the last one.
        """
        return _FrameSearch(self, silhouettes, past).run()


class _FrameSearch:
    """The search of one frame: its targets, its weights, and the pose so far."""

    def __init__(self, tracker: ContourTracker, silhouettes: Sequence[Silhouette], past: Past):
        self.tracker, self.settings, self.body = tracker, tracker.settings, tracker.body
        self.silhouettes, self.evaluator = silhouettes, tracker.evaluator
        self.last, self.predicted = clamped(tracker.body, np.stack([past.last, past.predicted]))
        maps = xor_weight_maps(silhouettes)
        self.weights = self.evaluator.prepared(maps)
        covered = [np.count_nonzero(picture) for picture in self.evaluator.silhouettes(self.last)]
        self.shown_px = maps.constants + covered
        observed_px = int(maps.constants.sum())
        self.shown = observed_px >= LEAST_AREA * sum(covered)
        self.prior_px = self.settings.prior_share * observed_px
        self.tally, self.usual = Tally(), past.usual
        self.metres = metres_at(self.evaluator, self.last)
        self.trust = np.ones(len(silhouettes))

    def run(self) -> PoseFit:
        if not self.shown:
            self._keep_best(self.last[None])
            return PoseFit(self.pose, int(self.apart_px.sum()), self.tally)
        self._aim()
        self._keep_best(np.stack([self.predicted, self.last]))
        self._trust_views()
        self._keep_best(self._descended(self.predicted, self.predicted, 1.0)[None])
        if self._trust_views() > _TRUST_CHANGED:
            self._go_on_from([self.pose])
        if self.settings.limbs is not None:
            self._recover()
        return PoseFit(self.pose, int(self.apart_px.sum()), self.tally)

    def _aim(self) -> None:
        """Makes the targets of the descents."""
        spacings_px = self.settings.descent.spacing_m / self.metres
        contours = [
            silhouette.contour.thinned(spacing)
            for silhouette, spacing in zip(self.silhouettes, spacings_px.tolist(), strict=True)
        ]
        tracker = self.tracker
        self.targets = ContourTargets(tracker.body, tracker.cameras, contours, self.metres)
        self.spacing_px = float(spacings_px.max())

    def _trust_views(self) -> float:
        """Trusts each view as far as the pose explains it; returns the largest change of trust."""
        if not self.settings.views_weighed:
            return 0.0
        before, self.trust = self.trust, view_weights(self.apart_px, self.shown_px)
        self.targets.shares = self.trust
        return float(np.abs(self.trust - before).max())

    def _recover(self) -> None:
        """The other start where lumps tell that something is amiss, then each limb by itself."""
        doubts = self._doubts()
        if doubts.any():
            self._keep_best(np.stack([self.pose, self._descended(self.last, self.predicted, 1.0)]))
            doubts = self._doubts()
        for limb, part in self.tracker.sought:
            self._seek(part, bool(doubts[limb]))

    def _doubts(self) -> np.ndarray:
        """(5,) bool, whether there is more than usual that each of `LIMB_NAMES` may explain."""
        lumps = Lumps.of(self.evaluator.silhouettes(self.pose), self.silhouettes, self.metres)
        chosen = limb_segments(self.body)
        areas = lumps.of_limbs(self.evaluator, self.pose, chosen, self.trust)
        return areas > _USUAL * self.usual + _LITTLE_M2

    def _go_on_from(self, starts: Sequence[np.ndarray]) -> None:
        """Descends once more, from each start (D,), and keeps the best."""
        ends = [self._descended(start, self.pose, self.settings.again) for start in starts]
        self._keep_best(np.stack([self.pose, *ends]))

    def _descended(self, start: np.ndarray, expected: np.ndarray, share: float) -> np.ndarray:
        first, last = self.settings.reaches_m
        reaches = np.geomspace(max(first * share, last), last, round(self.settings.steps * share))
        descent = self.tracker.descent
        return descent.run(self.targets, self.spacing_px, start, expected, reaches)

    def _seek(self, part: Part, doubted: bool) -> None:
        """Looks for a limb elsewhere, and descends from the better places found."""
        masked = self.evaluator.masked(self.weights, self.pose, part.segments)

        def pixels(poses: np.ndarray) -> np.ndarray:
            return self.evaluator.energies(masked, poses, part.segments) @ self.trust

        limbs = self.settings.limbs
        assert limbs is not None
        priors = (self.prior_px, limbs.pull_rad, self.tally)
        cost = LimbCost(self.body, part, self.pose, self.predicted, pixels, *priors)
        starts = np.stack([self.last, self.predicted])
        self._go_on_from(list(better_limbs(cost, starts, limbs, doubted)))

    def _keep_best(self, poses: np.ndarray) -> None:
        """Goes on with whichever of the poses (N, D) has the lowest energy, rest prior and all."""
        pixels = self.evaluator.energies(self.weights, poses)
        self.tally.evaluated += len(poses)
        prior = self.prior_px * rest_prior(self.body, poses)
        best = int(np.argmin(np.round(pixels @ self.trust + prior, 6)))
        self.pose, self.apart_px = poses[best], pixels[best]
