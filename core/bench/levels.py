"""What the coarse mesh changes, judged in three ways.

Signed energies cancel and would hide a mask that is shifted, so the masks themselves are compared,
too; and in the end the pose counts that a fit finds. Silhouettes are drawn with the full mesh, so
that its best pose is known: the true one, where nothing differs. How far a search with the coarse
mesh goes away from there is what the mesh changes. From a perturbed start, fits with either mesh
end apart for a reason of their own, too: a search through counted pixels sticks. A second fit with
the full mesh from a start that differs by nothing to be seen tells how much of it that is.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..body.body import Body
from ..body.kinematics import clamped, points
from ..cameras.camera import Camera
from ..energy.weight_maps import xor_weight_maps
from ..fitting.hierarchical import FAITHFUL, HierarchicalTracker
from ..rendering.native import NativeEvaluator
from .rows import coarse_level, full_level
from .sequences import sequence
from .stage import WHOLE_SPREAD, filmed

FIT = replace(FAITHFUL, grid_steps=1, grid_half_width=0.0, fine_torso=True)
"""Downhill from near by; a grid's jumps would say nothing of the mesh."""
_START_SPREAD = 0.03
_SAME_SPREAD = 1e-4
_CANDIDATES = 16
_EVERY = 5
_MM = 1000.0


@dataclass(frozen=True, eq=False)
class LevelCheck:
    """Coarse against full mesh, P poses in V views, F fits.

    Attributes:
        mask_xor: (P, V) px that differ, as a share of the full mesh's.
        energy_difference: (P, candidates) differences of energies summed over views, as a share
            of the px of the observed silhouettes.
        best_pose_shift: (F, 14) mm that a fit with the coarse mesh goes away from the full mesh's
            best pose.
        pose_change: (F, 14) mm between the points that fits with either mesh find from the same
            perturbed start.
        own_change: (G, 14) mm between the points that two fits with the full mesh find whose
            starts differ by nothing that can be seen.
    """

    mask_xor: np.ndarray
    energy_difference: np.ndarray
    best_pose_shift: np.ndarray
    pose_change: np.ndarray
    own_change: np.ndarray

    def as_dict(self) -> dict:
        """For JSON."""
        return {
            "poses": len(self.mask_xor),
            "fits": len(self.pose_change),
            "mask_xor": _spread(self.mask_xor),
            "energy_difference": _spread(self.energy_difference),
            "best_pose_shift_mm": _spread(self.best_pose_shift),
            "pose_change_mm": _spread(self.pose_change),
            "pose_change_mm_per_fit": self.pose_change.mean(axis=1).tolist(),
            "full_mesh_from_elsewhere_mm": _spread(self.own_change),
        }


def level_check(
    body: Body, cameras: tuple[Camera, ...], count: int, advance: Callable[[], None]
) -> LevelCheck:
    """Over ``count`` poses of both sequences; ``advance`` is called after each."""
    rng = np.random.default_rng(7)
    poses = np.concatenate([sequence(body, name, 90)[15::3] for name in "AB"])
    poses = poses[np.linspace(0, len(poses) - 1, count).round().astype(int)]
    trackers = [_tracker(body, cameras, level) for level in (coarse_level, full_level)]
    masks, energies, shifts, changes, own = [], [], [], [], []
    for number, pose in enumerate(poses):
        masks.append(_mask_xor(trackers, pose))
        energies.append(_energy_difference(trackers, pose, rng))
        ends = _fits(trackers, pose, rng, again=number % _EVERY == 0)
        shifts.append(_distances(ends[0], points(body, pose[None])[0]))
        changes.append(_distances(ends[1], ends[2]))
        own += [_distances(ends[2], other) for other in ends[3:]]
        advance()
    return LevelCheck(*map(np.array, (masks, energies, shifts, changes, own)))


def _tracker(
    body: Body, cameras: tuple[Camera, ...], level: Callable[[Body], int]
) -> HierarchicalTracker:
    return HierarchicalTracker(body, cameras, lambda b, c: NativeEvaluator(b, c, level(b)), FIT)


def _mask_xor(trackers: list[HierarchicalTracker], pose: np.ndarray) -> list[float]:
    coarse, full = (tracker.evaluator.silhouettes(pose) for tracker in trackers)
    return [
        np.count_nonzero(c ^ f) / max(np.count_nonzero(f), 1)
        for c, f in zip(coarse, full, strict=True)
    ]


def _energy_difference(
    trackers: list[HierarchicalTracker], pose: np.ndarray, rng: np.random.Generator
) -> np.ndarray:
    maps = xor_weight_maps(filmed(trackers[1].evaluator, pose))
    poses = pose + rng.normal(0, WHOLE_SPREAD, (_CANDIDATES, len(pose)))
    coarse, full = (
        t.evaluator.energies(t.evaluator.prepared(maps), poses).sum(axis=1) for t in trackers
    )
    return np.abs(coarse - full) / maps.constants.sum()


def _fits(
    trackers: list[HierarchicalTracker], pose: np.ndarray, rng: np.random.Generator, again: bool
) -> np.ndarray:
    """(3 or 4, 14, 3) points found by the coarse mesh from the true pose, by the coarse and the
    full mesh from a perturbed one, and ``again`` by the full mesh from just beside that.
    """
    coarse, full = trackers
    body = coarse.body
    silhouettes = filmed(full.evaluator, pose)
    start = pose + rng.normal(0, _START_SPREAD, len(pose))
    beside = start + rng.normal(0, _SAME_SPREAD, len(pose))
    starts = clamped(body, np.stack([pose, start, start, beside]))
    found = [
        tracker.fit(silhouettes, start, start).pose
        for tracker, start in zip((coarse, coarse, full, full)[: 3 + again], starts, strict=False)
    ]
    return points(body, np.stack(found))


def _distances(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return _MM * np.linalg.norm(one - other, axis=1)


def _spread(values: np.ndarray) -> dict[str, float]:
    return {"mean": float(values.mean()), "max": float(values.max())}
