"""What the coarse mesh changes, judged in three ways.

Signed energies cancel and would hide a mask that is shifted, so the masks themselves are compared,
too; and in the end the pose counts that a fit finds.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..body.body import Body
from ..body.kinematics import clamped, points
from ..cameras.camera import Camera
from ..energy.weight_maps import xor_weight_maps
from ..fitting.hierarchical import FAITHFUL, HierarchicalSettings, HierarchicalTracker
from ..optimisers.downhill import Effort
from ..rendering.native import NativeEvaluator
from .rows import coarse_level, full_level
from .sequences import sequence
from .stage import WHOLE_SPREAD, filmed

FIT = replace(FAITHFUL, fine_torso=True, effort=Effort(whole_lines=True))
"""Downhill from near by; grids would hide what the mesh changes behind what they change."""
_START_SPREAD = 0.03
_SAME_SPREAD = 1e-4
_CANDIDATES = 16
_MM = 1000.0


@dataclass(frozen=True, eq=False)
class LevelCheck:
    """Coarse against full mesh, P poses in V views, F fits.

    Attributes:
        mask_xor: (P, V) px that differ, as a share of the full mesh's.
        energy_difference: (P, candidates) differences of energies summed over views, as a share
            of the px of the observed silhouettes.
        pose_change: (F, 14) mm between the points that fits with either mesh find.
        own_change: (F, 14) mm between the points that two fits with the full mesh find whose
            starts differ by nothing that can be seen: how far the search itself scatters.
    """

    mask_xor: np.ndarray
    energy_difference: np.ndarray
    pose_change: np.ndarray
    own_change: np.ndarray

    def as_dict(self) -> dict:
        """For JSON."""
        return {
            "poses": len(self.mask_xor),
            "fits": len(self.pose_change),
            "mask_xor": _spread(self.mask_xor),
            "energy_difference": _spread(self.energy_difference),
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
    masks, energies, changes, own = [], [], [], []
    for pose in poses:
        masks.append(_mask_xor(trackers, pose))
        energies.append(_energy_difference(trackers, pose, rng))
        change, scatter = _changes(trackers, pose, rng)
        changes.append(change)
        own.append(scatter)
        advance()
    return LevelCheck(*map(np.array, (masks, energies, changes, own)))


def _tracker(
    body: Body, cameras: tuple[Camera, ...], level: Callable, settings: HierarchicalSettings = FIT
) -> HierarchicalTracker:
    return HierarchicalTracker(
        body, cameras, lambda b, c: NativeEvaluator(b, c, level(b)), settings
    )


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


def _changes(
    trackers: list[HierarchicalTracker], pose: np.ndarray, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """(14,) mm between coarse and full mesh, and between two fits with the full mesh."""
    coarse, full = trackers
    body = coarse.body
    silhouettes = filmed(full.evaluator, pose)
    starts = pose + rng.normal(0, _START_SPREAD, len(pose))
    starts = clamped(body, starts + np.array([[0.0], [_SAME_SPREAD]]) * rng.normal(size=len(pose)))

    def found() -> Iterator[np.ndarray]:
        for tracker, start in ((full, starts[0]), (coarse, starts[0]), (full, starts[1])):
            yield tracker.fit(silhouettes, start, start).pose

    ends = points(body, np.stack(list(found())))
    return tuple(_MM * np.linalg.norm(ends[1:] - ends[0], axis=2))


def _spread(values: np.ndarray) -> dict[str, float]:
    return {"mean": float(values.mean()), "max": float(values.max())}
