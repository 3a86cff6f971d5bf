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
from ..energy.evaluator import Weights
from ..energy.weight_maps import xor_weight_maps
from ..silhouettes.observed_contour import ObservedContour
from ..silhouettes.silhouette import Silhouette
from .contour_descent import Descent, DescentSettings
from .contour_targets import ContourTargets
from .part_search import metres_per_pixel, rest_prior
from .tracker import EvaluatorFactory, PoseFit, Tally, shows_nobody

_SOUGHT = ("left_arm", "right_arm", "left_leg", "right_leg", "head")
_APART_RAD = 0.25
"""Of candidates that differ by less in every DOF, one is enough."""
_ELITE = 9
"""Poses that the next generation lies about."""


@dataclass(frozen=True)
class ContourSettings:
    """How a frame is searched.

    Attributes:
        descent: how a descent goes.
        reaches_m: of a descent's first and last step.
        steps: most steps of a descent.
        candidates: poses of each limb in a generation; 0 for none.
        spreads_rad: standard deviations of the generations.
        descents: of so many candidates at most that are better.
        again: share of the reach and of the steps that these descents have.
        prior_share: energy of one standard deviation from the rest pose, as a share of the
            silhouettes' area, when ends are compared.
    """

    descent: DescentSettings = field(default_factory=DescentSettings)
    reaches_m: tuple[float, float] = (0.22, 0.06)
    steps: int = 10
    candidates: int = 200
    spreads_rad: tuple[float, ...] = (1.2, 0.4, 0.15)
    descents: int = 2
    again: float = 0.5
    prior_share: float = 1e-3


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
        self.sought = tuple(part for part in body.parts if part.name in _SOUGHT)

    def fit(
        self, silhouettes: tuple[Silhouette, ...], last: np.ndarray, predicted: np.ndarray
    ) -> PoseFit:
        """The pose that explains the V silhouettes best, searched from two poses (D,).

        Where the views show nobody, it is the last one.
        """
        return _FrameSearch(self, silhouettes, last, predicted).run()


class _FrameSearch:
    """The search of one frame: its targets, its weights, and the pose so far."""

    def __init__(self, tracker: ContourTracker, silhouettes: Sequence[Silhouette], last, predicted):
        self.tracker, self.settings, self.body = tracker, tracker.settings, tracker.body
        self.last, self.predicted = clamped(tracker.body, np.stack([last, predicted]))
        maps = xor_weight_maps(silhouettes)
        self.weights = tracker.evaluator.prepared(maps)
        observed_px = int(maps.constants.sum())
        self.shown = not shows_nobody(tracker.evaluator, self.last, observed_px)
        self.prior_px = self.settings.prior_share * observed_px
        self.tally = Tally()
        root = tracker.evaluator.transforms(self.last[None])[0, 0, :, 3]
        metres = np.array([metres_per_pixel((camera,), root) for camera in tracker.cameras])
        spacings_px = self.settings.descent.spacing_m / metres
        contours = [
            ObservedContour.of(silhouette, spacing)
            for silhouette, spacing in zip(silhouettes, spacings_px.tolist(), strict=True)
        ]
        self.targets = ContourTargets(tracker.body, tracker.cameras, contours, metres)
        self.spacing_px = float(spacings_px.max())

    def run(self) -> PoseFit:
        starts = [self.predicted, self.last] if self.shown else []
        ends = [self._descended(start, self.predicted, 1.0) for start in starts]
        self._keep_best(np.stack(ends or [self.last]))
        rng = np.random.default_rng(0)
        for part in self.tracker.sought if self.shown and self.settings.candidates else ():
            self._seek(part, rng)
        return PoseFit(self.pose, self.energy, self.tally)

    def _descended(self, start: np.ndarray, expected: np.ndarray, share: float) -> np.ndarray:
        first, last = self.settings.reaches_m
        reaches = np.geomspace(max(first * share, last), last, round(self.settings.steps * share))
        descent = self.tracker.descent
        return descent.run(self.targets, self.spacing_px, start, expected, reaches)

    def _seek(self, part: Part, rng: np.random.Generator) -> None:
        """Looks for a limb elsewhere, in generations that narrow about the best, while it pays."""
        masked = self.tracker.evaluator.masked(self.weights, self.pose, part.segments)
        poses = np.stack([self.pose, self.last, self.predicted])
        costs = self._limb_costs(part, masked, poses)
        for spread in self.settings.spreads_rad:
            found = self._scattered(part, poses, spread, rng)
            poses = np.concatenate([poses, found])
            costs = np.concatenate([costs, self._limb_costs(part, masked, found)])
            order = np.argsort(costs, kind="stable")
            if order[0] == 0:
                return
            # the pose as it is stays first, so that others are compared with it
            kept = [0, *(k for k in order.tolist() if 0 < costs[k] < costs[0])][:_ELITE]
            poses, costs = poses[kept], costs[kept]
        chosen = self._apart(part, poses)
        ends = [self._descended(p, self.pose, self.settings.again) for p in poses[chosen]]
        self._keep_best(np.stack([self.pose, *ends]))

    def _limb_costs(self, part: Part, masked: Weights, poses: np.ndarray) -> np.ndarray:
        """(N,) energies of poses (N, D) with the limb as in them, the rest as it is."""
        dofs = list(part.dofs)
        self.tally.evaluated += len(poses)
        moved = np.repeat(self.pose[None], len(poses), axis=0)
        moved[:, dofs] = poses[:, dofs]
        pixels = self.tracker.evaluator.energies(masked, moved, part.segments).sum(axis=1)
        return np.round(pixels + self.prior_px * rest_prior(self.body, moved), 6)

    def _scattered(
        self, part: Part, poses: np.ndarray, spread: float, rng: np.random.Generator
    ) -> np.ndarray:
        """(N, D) the pose as it is with the limb about where it is in ``poses``."""
        dofs, count = list(part.dofs), self.settings.candidates
        scattered = np.repeat(self.pose[None], count, axis=0)
        away = spread * rng.choice([0.3, 1.0], (count, 1)) * rng.normal(size=(count, len(dofs)))
        scattered[:, dofs] = poses[rng.integers(0, len(poses), count)][:, dofs] + away
        return clamped(self.body, scattered)

    def _apart(self, part: Part, poses: np.ndarray) -> list[int]:
        """Indices of the first few poses (N, D) apart from each other and from the first."""
        dofs, chosen = list(part.dofs), [0]
        for index in range(1, len(poses)):
            others = poses[np.ix_(chosen, dofs)]
            if np.abs(others - poses[index, dofs]).max(axis=1).min() > _APART_RAD:
                chosen.append(index)
        return chosen[1 : 1 + self.settings.descents]

    def _keep_best(self, poses: np.ndarray) -> None:
        """Goes on with whichever of the poses (N, D) has the lowest energy, rest prior and all."""
        pixels = self.tracker.evaluator.energies(self.weights, poses).sum(axis=1)
        self.tally.evaluated += len(poses)
        costs = np.round(pixels + self.prior_px * rest_prior(self.body, poses), 6)
        best = int(np.argmin(costs))
        self.pose, self.energy = poses[best], int(pixels[best])
