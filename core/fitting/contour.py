"""Tracker ``contour``: outlines drawn to the observed contours, judged by the exact energy.

Each frame descends from the predicted pose (`contour_descent`); views that disagree while the
others agree count less (`view_trust`). Then each limb, and the head, is compared with others near
by while the rest is masked out. What the pose leaves unexplained (`lumps`) tells whether something
is amiss: then the last pose is a second start, and limbs are sought over all their range, drawn to
foreground that nothing covers (`limb_search`). Where views have dropped a limb they are taken to
show nothing, and a body that lies beside them begins anew (`recovery`). The exact energy of the
whole body has the last word.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..body.body import Body, Part
from ..body.kinematics import clamped
from ..cameras.camera import Camera
from ..energy.evaluator import Weights
from ..energy.weight_maps import drawing_weight_maps, xor_weight_maps
from ..rendering.arguments import fixed_segments
from ..silhouettes.silhouette import Silhouette
from .contour_descent import Descent, DescentSettings
from .contour_targets import ContourTargets
from .limb_search import LimbCost, LimbSettings, better_limbs, limbs_elsewhere
from .limbs import LIMB_NAMES, limb_segments
from .lumps import Lumps, dropped
from .part_search import rest_prior
from .recovery import restarts
from .scores import metres_at
from .tracker import LEAST_AREA, EvaluatorFactory, Past, PoseFit, Tally
from .view_trust import view_weights

_TRUST_CHANGED = 0.3
"""Of a view, so that the pose is worth another descent."""
_USUAL = 1.4
"""Times what lumps there usually are, that are nothing to worry about."""
_LITTLE_M2 = 0.006
"""Lumps in all views together that raise no doubt about a limb."""
_BESIDE = 0.45
"""Px that differ, as a share of silhouettes and model together, where the body is lost."""
_RESTARTS = 4
"""Descents from the visual hull."""
_LEAP_M = 0.2
"""From what is expected, by which a joint of a limb has hardly moved."""
_ELSEWHERE = 0.4
"""Foreground that is unexplained where a limb has been dropped, as a share of what is gone."""


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
        self.limb_dofs = [dof for _, part in self.sought for dof in part.dofs]

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
        starts = np.stack([past.last, past.predicted, past.trusted])
        self.last, self.predicted, self.trusted = clamped(tracker.body, starts)
        maps = xor_weight_maps(silhouettes)
        self.weights = self.evaluator.prepared(maps)
        covered = [np.count_nonzero(picture) for picture in self.evaluator.silhouettes(self.last)]
        self.shown_px = maps.constants + covered
        observed_px = int(maps.constants.sum())
        self.shown = observed_px >= LEAST_AREA * sum(covered)
        self.prior_px = self.settings.prior_share * observed_px
        self.tally, self.usual, self.patient = Tally(), past.usual, past.patient
        self.metres = metres_at(self.evaluator, self.last)
        self.trust = np.ones(len(silhouettes))

    def run(self) -> PoseFit:
        if not self.shown:
            self._keep_best(self.last[None])
            return PoseFit(self.pose, int(self.apart_px.sum()), self.tally)
        self._aim()
        self._keep_best(np.stack([self.predicted, self.last]))
        self._trust_views()
        self._keep_best(self._descended(self.predicted, self.trusted, 1.0)[None])
        if self._trust_views() > _TRUST_CHANGED:
            self._go_on_from([self.pose])
        if self.settings.limbs is not None:
            self._recover_body()
            self._recover()
        return PoseFit(self.pose, int(self.apart_px.sum()), self.tally)

    def _aim(self) -> None:
        """Makes the targets of the descents."""
        spacing_m = self.settings.descent.spacing_m
        seen = (self.silhouettes, self.metres, spacing_m)
        self.targets = ContourTargets.of(self.evaluator, *seen)
        self.targets.shares = self.trust
        self.spacing_px = float((spacing_m / self.metres).max())

    def _trust_views(self) -> float:
        """Trusts each view as far as the pose explains it; returns the largest change of trust."""
        if not self.settings.views_weighed:
            return 0.0
        before, self.trust = self.trust, view_weights(self.apart_px, self.shown_px)
        self.targets.shares = self.trust
        return float(np.abs(self.trust - before).max())

    def _recover_body(self) -> None:
        """Begins anew from the visual hull where the body lies beside most silhouettes."""
        apart = float(self.apart_px @ self.trust) / max(float(self.shown_px @ self.trust), 1.0)
        if apart < _BESIDE:
            return
        starts = clamped(
            self.body, restarts(self.body, self.tracker.cameras, self.silhouettes, self.pose)
        )
        if not len(starts):
            return
        self.trust = np.ones(len(self.silhouettes))
        self.targets.shares = self.trust
        costs = self.evaluator.energies(self.weights, starts).sum(axis=1)
        chosen = starts[np.argsort(costs, kind="stable")[:_RESTARTS]]
        ends = [self._descended(start, start, 2.0) for start in chosen]
        ends = [self._descended(end, end, 1.0) for end in ends]
        self._keep_best(np.stack([self.pose, *ends]))
        self._trust_views()
        self.trusted = self.predicted = self.last = self.pose

    def _recover(self) -> None:
        """The other start where lumps tell that something is amiss, then each limb by itself."""
        doubts = self._doubts()
        if self._disregard(doubts):
            self._keep_best(self._descended(self.trusted, self.trusted, 1.0)[None])
            doubts = self._doubts()
        if doubts.any():
            self._keep_best(np.stack([self.pose, self._descended(self.last, self.trusted, 1.0)]))
            doubts = self._doubts()
        for limb, part in self.tracker.sought:
            self._seek(part, bool(doubts[limb]))

    def _lumps(self, pose: np.ndarray) -> np.ndarray:
        """(2, 5) `Lumps.of_limbs` of `LIMB_NAMES` in a pose (D,)."""
        lumps = Lumps.of(self.evaluator.silhouettes(pose), self.silhouettes, self.metres)
        return lumps.of_limbs(self.evaluator, pose, limb_segments(self.body), self.trust)

    def _doubts(self) -> np.ndarray:
        """(5,) bool, whether there is more than usual that each of `LIMB_NAMES` may explain."""
        return self._lumps(self.pose).sum(axis=0) > _USUAL * self.usual + _LITTLE_M2

    def _disregard(self, doubts: np.ndarray) -> bool:
        """Takes as unobserved where views have dropped a limb; returns whether any has.

        It is gone from where it is expected, and nothing is there that it could have become. Hidden
        before the body it would explain such silhouettes best, and be lost.
        """
        places = self.evaluator.transforms(np.stack([self.pose, self.trusted]))[..., 3]
        leaps = np.linalg.norm(places[0] - places[1], axis=1)
        odd = [
            (limb, part)
            for limb, part in self.tracker.sought
            if part.role == "limb" and self.patient[limb] and np.isfinite(self.usual[limb])
            if doubts[limb] or leaps[self.body.segment_joints[list(part.segments)]].max() > _LEAP_M
        ]
        if not odd:
            return False
        pose = self.pose.copy()
        for _, part in odd:
            pose[list(part.dofs)] = self.trusted[list(part.dofs)]
        missing, surplus = self._lumps(pose)
        silhouettes = list(self.silhouettes)
        for limb, part in odd:
            if missing[limb] < _ELSEWHERE * surplus[limb]:
                where = (part.segments, self.silhouettes, self.metres)
                for view, picture in enumerate(dropped(self.evaluator, pose, *where)):
                    if picture is not None:
                        seen = silhouettes[view]
                        silhouettes[view] = replace(seen, observed=seen.observed & ~picture)
        changed = any(a is not b for a, b in zip(silhouettes, self.silhouettes, strict=True))
        if changed:
            self.silhouettes = silhouettes
            self.weights = self.evaluator.prepared(xor_weight_maps(silhouettes))
            self._aim()
        return changed

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
        settings = self.settings.limbs
        assert settings is not None
        cost = self._limb_cost(part, self.weights)
        starts = np.stack([self.last, self.predicted, self.trusted])
        if doubted and settings.everywhere:
            others = fixed_segments(self.body, part.segments)
            covered = self.evaluator.silhouettes(self.pose, others)
            reaches_px = (self.settings.drawn_from_m / self.metres).tolist()
            maps = drawing_weight_maps(self.silhouettes, covered, reaches_px)
            rough = self._limb_cost(part, self.evaluator.prepared(maps))
            found = limbs_elsewhere(rough, cost, starts, settings)
        else:
            found = better_limbs(cost, starts, settings)
        self._go_on_from(list(found))

    def _limb_cost(self, part: Part, weights: Weights) -> LimbCost:
        masked = self.evaluator.masked(weights, self.pose, part.segments)

        def pixels(poses: np.ndarray) -> np.ndarray:
            return self.evaluator.energies(masked, poses, part.segments) @ self.trust

        priors = (self.prior_px, self.settings.pull_rad, self.tally)
        return LimbCost(self.body, part, self.pose, self.trusted, pixels, *priors)

    def _keep_best(self, poses: np.ndarray) -> None:
        """Goes on with whichever of the poses (N, D) has the lowest energy, priors and all."""
        pixels = self.evaluator.energies(self.weights, poses)
        self.tally.evaluated += len(poses)
        away = (poses - self.trusted)[:, self.tracker.limb_dofs] / self.settings.pull_rad
        prior = rest_prior(self.body, poses) + (away**2).sum(axis=1)
        best = int(np.argmin(np.round(pixels @ self.trust + self.prior_px * prior, 6)))
        self.pose, self.apart_px = poses[best], pixels[best]
