"""Tracker ``hierarchical``: the torso first, then limbs, then head, hands and feet.

Theobalt et al. 2003, sections 3 to 4.3. One frame is fitted from the pose of the frame before:

1. the torso's six DOFs go downhill on pictures of half resolution (bodies with a bending spine
   follow with the spine's DOFs at full resolution);
2. each limb: a grid search, then downhill;
3. head, hands and feet: downhill;
4. again from 1 until the energy falls by less than 0.2 % or the pose stays within 0.1 degrees and
   half a millimetre, five rounds at most.

While a part is searched, the others are rendered once and masked out (4.3), in a window about the
part (4.2).

Shared out (section 5), the limbs are searched beside each other after the torso, each followed by
its hand or foot, all from the pose that the torso's search left; the head's search goes on
meanwhile. That schedule gives the same result whether one thread or many work through it.
"""

from collections.abc import Sequence
from concurrent.futures import Executor
from copy import copy
from dataclasses import dataclass, field, replace

import numpy as np

from ..body.body import Body, Part
from ..body.kinematics import clamped
from ..body.limits import Limits
from ..cameras.camera import Camera
from ..energy.evaluator import Weights
from ..energy.weight_maps import halved, halved_camera, xor_weight_maps
from ..optimisers.downhill import Effort, downhill
from ..optimisers.grid import grid_points, lowest
from ..silhouettes.silhouette import Silhouette
from .part_search import FORBIDDEN, PartEnergy, first_steps, part_windows, rest_prior
from .shares import shares_of
from .torso_volume import TorsoVolume
from .tracker import EvaluatorFactory, Past, PoseFit, Tally, shows_nobody

_WINDOW_SIDES = {"limb": 128, "end": 64}


@dataclass(frozen=True)
class HierarchicalSettings:
    """How hard to search.

    Attributes:
        grid_steps: points per DOF of the limbs' grid.
        grid_half_width: rad to either side of the centre.
        search_prediction: whether the grid is laid around the predicted pose too.
        fine_torso: whether the torso goes on at full resolution from the second round.
        rounds: most repetitions of steps 1 to 3.
        effort: of each downhill search.
        prior_share: energy of one standard deviation from the rest pose, as a share of the
            silhouettes' area.
        prerendered: whether the parts that stand still are rendered once (4.3); else every
            candidate draws the whole body, which finds the same pose.
        shared_out: whether the limbs are searched beside each other (section 5).
    """

    grid_steps: int = 5
    grid_half_width: float = np.radians(20)
    search_prediction: bool = True
    fine_torso: bool = True
    rounds: int = 5
    effort: Effort = field(default_factory=Effort)
    prior_share: float = 1e-3
    prerendered: bool = True
    shared_out: bool = False


ROBUST = HierarchicalSettings()
ROBUST_FAST = HierarchicalSettings(grid_steps=7, grid_half_width=np.radians(45))
FAITHFUL = HierarchicalSettings(
    grid_steps=3,
    grid_half_width=np.radians(12),
    search_prediction=False,
    fine_torso=False,
    effort=Effort(whole_lines=False),
    prior_share=0.0,
)
FAITHFUL_FAST = replace(FAITHFUL, grid_steps=4, grid_half_width=np.radians(35))
SETTINGS = {"robust": (ROBUST, ROBUST_FAST), "faithful": (FAITHFUL, FAITHFUL_FAST)}
"""Name -> settings for ordinary and for fast motion; the faithful ones suit the paper's Table 2."""


class HierarchicalTracker:
    """Fits one frame after another; keeps no state between frames.

    Args:
        body: whose pose is searched.
        cameras: V pinhole cameras.
        make_evaluator: of the body in cameras; called for whole and for half resolution.
        settings: how hard to search.
        executor: runs the limbs that are shared out, in threads; None for one after another.
    """

    def __init__(
        self,
        body: Body,
        cameras: tuple[Camera, ...],
        make_evaluator: EvaluatorFactory,
        settings: HierarchicalSettings = ROBUST,
        executor: Executor | None = None,
    ):
        half = tuple(halved_camera(camera) for camera in cameras)
        self.body = body
        self.cameras = cameras
        self.settings = settings
        self.executor = executor
        self.evaluator = make_evaluator(body, cameras)
        self.half_evaluator = make_evaluator(body, half)
        self.torso_volume = TorsoVolume.of(body)
        self.limits = {part.name: Limits.of(body, part.dofs) for part in body.parts}

    def with_settings(self, settings: HierarchicalSettings) -> "HierarchicalTracker":
        """A tracker of the same body and cameras that searches otherwise."""
        other = copy(self)
        other.settings = settings
        return other

    def fit(self, silhouettes: tuple[Silhouette, ...], past: Past) -> PoseFit:
        """The pose that explains the V silhouettes best, searched from two poses (D,)."""
        return _FrameSearch(self, silhouettes, past).run()


class _FrameSearch:
    """The search of one frame: its weights, the pose so far, and the counts."""

    def __init__(self, tracker: HierarchicalTracker, silhouettes, past: Past):
        self.tracker = tracker
        self.everything = tuple(range(len(tracker.body.segment_names)))
        maps = xor_weight_maps(silhouettes)
        self.observed_px = int(maps.constants.sum())
        self.weights = tracker.evaluator.prepared(maps)
        self.half_weights = tracker.half_evaluator.prepared(halved(maps))
        self.prior_px = tracker.settings.prior_share * self.observed_px
        self.tally = Tally()
        poses = clamped(tracker.body, np.stack([past.last, past.predicted]))
        self.last, self.predicted = poses
        costs = self._costs(poses if tracker.settings.search_prediction else poses[:1])
        self.pose, self.cost = poses[int(np.argmin(costs))].copy(), float(costs.min())
        self.windows = {
            part.name: part_windows(tracker.evaluator, self.last, part, _WINDOW_SIDES[part.role])
            for part in tracker.body.parts
            if part.role in _WINDOW_SIDES
        }

    def run(self) -> PoseFit:
        rounds = self.tracker.settings.rounds
        pictures = self.tracker.evaluator.silhouettes(self.last)
        if shows_nobody(self.observed_px, sum(map(np.count_nonzero, pictures))):
            rounds, self.pose = 0, self.last.copy()
            self.cost = float(self._costs(self.pose[None])[0])
        for number in range(rounds):
            before, cost_before = self.pose.copy(), self.cost
            if self.tracker.settings.shared_out:
                self._search_shared_out(number)
            else:
                self._search_all(self.tracker.body.parts, number)
            self.cost = float(self._costs(self.pose[None])[0])
            if self.cost > cost_before:
                self.pose, self.cost = before, cost_before
            if self._converged(before, cost_before):
                break
        prior = self.prior_px * rest_prior(self.tracker.body, self.pose[None])[0]
        return PoseFit(self.pose, round(self.cost - prior), self.tally)

    def _search_all(self, parts: Sequence[Part], number: int) -> None:
        for part in parts:
            self._search(part, number)

    def _search_shared_out(self, number: int) -> None:
        """The torso, then the limbs with their ends, all of them from the torso's pose."""
        shares = shares_of(self.tracker.body)
        self._search_all(shares.trunk, number)
        run = self.tracker.executor.map if self.tracker.executor else map
        branches = [self._branch() for _ in shares.limbs]
        found = run(_FrameSearch._search_all, branches, shares.limbs, [number] * len(branches))
        self._search_all(shares.rest, number)
        list(found)
        for branch, parts in zip(branches, shares.limbs, strict=True):
            dofs = sorted({dof for part in parts for dof in part.dofs})
            self.pose[dofs] = branch.pose[dofs]
            self.tally.add(branch.tally)

    def _branch(self) -> "_FrameSearch":
        """A search that goes on from the same pose by itself."""
        other = copy(self)
        other.pose, other.tally = self.pose.copy(), Tally()
        return other

    def _search(self, part: Part, number: int) -> None:
        settings = self.tracker.settings
        coarse = part.role == "torso" and not (settings.fine_torso and number > 0)
        energy = self._part_energy(part, coarse)
        dofs = list(part.dofs)
        if number == 0 and part.grid:
            self._search_grid(part, energy)
        steps = first_steps(energy.evaluator, self.pose, part, tip_px=2.0)
        found = downhill(energy, self.pose[dofs], steps, settings.effort)
        if found.energy < FORBIDDEN:
            self.pose[dofs] = found.point

    def _search_grid(self, part: Part, energy: PartEnergy) -> None:
        settings = self.tracker.settings
        dofs = list(part.dofs)
        axes = np.array([dofs.index(dof) for dof in part.grid])
        moves = settings.search_prediction and not np.array_equal(self.last, self.predicted)
        centres = [self.last, self.predicted] if moves else [self.last]
        points = [self.pose[dofs][None]] + [
            grid_points(centre[dofs], settings.grid_half_width, settings.grid_steps, axes)
            for centre in centres
        ]
        self.pose[dofs] = lowest(energy, np.concatenate(points)).point

    def _part_energy(self, part: Part, coarse: bool) -> PartEnergy:
        tracker, windows = self.tracker, self.windows.get(part.name)
        segments, offset = part.segments, 0
        if coarse:
            evaluator, weights = tracker.half_evaluator, self.half_weights
        else:
            evaluator = tracker.evaluator
            segments = part.segments if tracker.settings.prerendered else self.everything
            weights = evaluator.masked(self.weights, self.pose, segments, windows)
            if len(segments) > len(part.segments):
                offset = self._outside_px(part, weights)
        return PartEnergy(
            evaluator,
            weights,
            self.pose.copy(),
            part,
            tracker.limits[part.name],
            tracker.torso_volume if part.role in _WINDOW_SIDES else None,
            windows,
            self.prior_px,
            self.tally,
            segments,
            offset,
        )

    def _outside_px(self, part: Part, weights: Weights) -> int:
        """Energy that the still parts have outside of the window of ``weights``."""
        still = [s for s in self.everything if s not in part.segments]
        energies = self.tracker.evaluator.energies
        whole, inside = (energies(w, self.pose[None], still) for w in (self.weights, weights))
        return int((whole - inside).sum())

    def _costs(self, poses: np.ndarray) -> np.ndarray:
        """(N,) energies of whole poses with the rest prior."""
        self.tally.evaluated += len(poses)
        pixels = self.tracker.evaluator.energies(self.weights, poses).sum(axis=1)
        return np.round(pixels + self.prior_px * rest_prior(self.tracker.body, poses), 6)

    def _converged(self, before: np.ndarray, cost_before: float) -> bool:
        kinds = self.tracker.body.dofs.kinds
        change = np.abs(self.pose - before)
        still = change[kinds == 0].max() < 5e-4 and change[kinds != 0].max() < np.radians(0.1)
        return still or cost_before - self.cost < 0.002 * cost_before
