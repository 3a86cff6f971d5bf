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
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..body.body import Body, Part
from ..body.kinematics import clamped
from ..body.limits import Limits
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from ..energy.weight_maps import halved, xor_weight_maps
from ..optimisers.downhill import downhill
from ..optimisers.grid import grid_points, lowest
from ..silhouettes.silhouette import Silhouette
from .part_search import FORBIDDEN, PartEnergy, first_steps, leaves_window, part_windows
from .torso_volume import TorsoVolume

EvaluatorFactory = Callable[[Body, tuple[Camera, ...]], Evaluator]

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
        sweeps: most passes of a downhill search over its directions.
        prior_share: energy of one standard deviation from the rest pose, as a share of the
            silhouettes' area.
    """

    grid_steps: int = 5
    grid_half_width: float = np.radians(20)
    search_prediction: bool = True
    fine_torso: bool = True
    rounds: int = 5
    sweeps: int = 3
    prior_share: float = 1e-3


ROBUST = HierarchicalSettings()
ROBUST_FAST = HierarchicalSettings(grid_steps=7, grid_half_width=np.radians(45))
FAITHFUL = HierarchicalSettings(
    3, np.radians(12), search_prediction=False, fine_torso=False, prior_share=0.0
)
FAITHFUL_FAST = replace(FAITHFUL, grid_steps=4, grid_half_width=np.radians(35))
SETTINGS = {"robust": (ROBUST, ROBUST_FAST), "faithful": (FAITHFUL, FAITHFUL_FAST)}
"""Name -> settings for ordinary and for fast motion; the faithful ones suit the paper's Table 2."""


@dataclass(frozen=True, eq=False)
class PoseFit:
    """The pose found for one frame.

    Attributes:
        pose: (D,).
        energy: px that differ, summed over views.
        evaluations: candidates evaluated.
        windows_left: how often a part was left outside their window in some view.
    """

    pose: np.ndarray
    energy: float
    evaluations: int
    windows_left: int


class HierarchicalTracker:
    """Fits one frame after another; keeps no state between frames."""

    def __init__(
        self,
        body: Body,
        cameras: tuple[Camera, ...],
        make_evaluator: EvaluatorFactory,
        settings: HierarchicalSettings = ROBUST,
    ):
        half = tuple(c.scaled(0.5, ((c.size[0] + 1) // 2, (c.size[1] + 1) // 2)) for c in cameras)
        self.body = body
        self.cameras = cameras
        self.settings = settings
        self.evaluator = make_evaluator(body, cameras)
        self.half_evaluator = make_evaluator(body, half)
        self.torso_volume = TorsoVolume.of(body)
        self.limits = {part.name: Limits.of(body, part.dofs) for part in body.parts}

    def fit(
        self, silhouettes: tuple[Silhouette, ...], last: np.ndarray, predicted: np.ndarray
    ) -> PoseFit:
        """The pose that explains the V silhouettes best, searched from two poses (D,)."""
        return _FrameSearch(self, silhouettes, last, predicted).run()


class _FrameSearch:
    """The search of one frame: its weights, the pose so far, and the counts."""

    def __init__(self, tracker: HierarchicalTracker, silhouettes, last, predicted):
        self.tracker = tracker
        maps = xor_weight_maps(silhouettes)
        self.weights = tracker.evaluator.prepared(maps)
        self.half_weights = tracker.half_evaluator.prepared(halved(maps))
        self.prior_px = tracker.settings.prior_share * float(maps.constants.sum())
        self.last, self.predicted = clamped(tracker.body, np.stack([last, predicted]))
        self.evaluations = 0
        self.windows_left = 0
        energies = self._whole_energies(np.stack([self.last, self.predicted]))
        self.pose = (self.last, self.predicted)[int(np.argmin(energies))].copy()
        self.energy = float(energies.min())

    def run(self) -> PoseFit:
        for number in range(self.tracker.settings.rounds):
            before, energy_before = self.pose.copy(), self.energy
            for part in self.tracker.body.parts:
                self._search(part, number)
            self.energy = float(self._whole_energies(self.pose[None])[0])
            if self.energy > energy_before:
                self.pose, self.energy = before, energy_before
            if self._converged(before, energy_before):
                break
        return PoseFit(self.pose, self.energy, self.evaluations, self.windows_left)

    def _search(self, part: Part, number: int) -> None:
        settings = self.tracker.settings
        windows = self._windows(part)
        coarse = part.role == "torso" and not (settings.fine_torso and number > 0)
        energy = self._part_energy(part, windows, coarse)
        dofs = list(part.dofs)
        if number == 0 and part.grid:
            self._search_grid(part, energy)
        steps = first_steps(energy.evaluator, self.pose, part, tip_px=2.0)
        found = downhill(energy, self.pose[dofs], steps, settings.sweeps, tolerance=2e-3)
        self.evaluations += found.evaluations
        if found.energy < FORBIDDEN:
            self.pose[dofs] = found.point
        if windows is not None:
            bounds = self.tracker.evaluator.bounds(self.pose[None], part.segments)[0]
            self.windows_left += leaves_window(bounds, windows)

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
        found = lowest(energy, np.concatenate(points))
        self.evaluations += found.evaluations
        self.pose[dofs] = found.point

    def _windows(self, part: Part) -> np.ndarray | None:
        if part.role not in _WINDOW_SIDES:
            return None
        side = _WINDOW_SIDES[part.role]
        return part_windows(self.tracker.evaluator, self.pose, part, side)

    def _part_energy(self, part: Part, windows: np.ndarray | None, coarse: bool) -> PartEnergy:
        tracker = self.tracker
        if coarse:
            evaluator, weights = tracker.half_evaluator, self.half_weights
        else:
            evaluator = tracker.evaluator
            weights = evaluator.masked(self.weights, self.pose, part.segments, windows)
        torso = tracker.torso_volume if part.role == "limb" else None
        limits = tracker.limits[part.name]
        return PartEnergy(evaluator, weights, self.pose.copy(), part, limits, torso, self.prior_px)

    def _whole_energies(self, poses: np.ndarray) -> np.ndarray:
        self.evaluations += len(poses)
        return self.tracker.evaluator.energies(self.weights, poses).sum(axis=1)

    def _converged(self, before: np.ndarray, energy_before: float) -> bool:
        kinds = self.tracker.body.dofs.kinds
        change = np.abs(self.pose - before)
        still = change[kinds == 0].max() < 5e-4 and change[kinds != 0].max() < np.radians(0.1)
        return still or energy_before - self.energy < 0.002 * energy_before
