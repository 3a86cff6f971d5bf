"""What the coarse mesh changes, judged in three ways.

Signed energies cancel and would hide a mask that is shifted, so the masks themselves are compared,
too; and in the end the pose counts that a fit finds. Silhouettes are drawn with the full mesh, so
that its best pose is known: the true one, where nothing differs. Fits with either mesh begin at the
same perturbed pose and draw the same candidates. They are evolutions of whole poses, which come as
near to the best pose as the pixels allow; a search along single joints sticks some millimetres
beside it, with any mesh. How much of the change is the search's own is told by a second fit with
the full mesh that draws other candidates.
"""

import os
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..body.body import Body
from ..body.kinematics import clamped, joint_transforms, points
from ..cameras.camera import Camera
from ..energy.evaluator import WeightMaps
from ..energy.weight_maps import xor_weight_maps
from ..optimisers.evolution import Evolution, evolved
from ..rendering.native import NativeEvaluator
from .rows import coarse_level, full_level
from .sequences import sequence
from .stage import WHOLE_SPREAD, filmed

FIT = Evolution(population=80, generations=150, first_step=0.005, last_step=5e-5)
"""Steps are in metres that the joints move; two such fits end less than 1 mm apart on average."""
_START_SPREAD = 0.01
_CANDIDATES = 16
_EVERY = 5
_DERIVATIVE_STEP = 1e-4
_STIFFNESS = 0.02
"""Of turns that move no joint, beside those that do."""
_MM = 1000.0


@dataclass(frozen=True, eq=False)
class LevelCheck:
    """Coarse against full mesh, P poses in V views, F fits.

    Attributes:
        mask_xor: (P, V) px that differ, as a share of the full mesh's.
        energy_difference: (P, candidates) differences of energies summed over views, as a share
            of the px of the observed silhouettes.
        pose_change: (F, 14) mm between the points that fits with either mesh find from the same
            start.
        own_change: (G, 14) mm between the points that two fits with the full mesh find from the
            same start with other candidates.
        best_pose_shift: (F, 14) mm of the points that the coarse mesh's fits find from those of
            the full mesh's best pose.
    """

    mask_xor: np.ndarray
    energy_difference: np.ndarray
    pose_change: np.ndarray
    own_change: np.ndarray
    best_pose_shift: np.ndarray

    def as_dict(self) -> dict:
        """For JSON."""
        return {
            "poses": len(self.mask_xor),
            "fits": len(self.pose_change),
            "mask_xor": _spread(self.mask_xor),
            "energy_difference": _spread(self.energy_difference),
            "pose_change_mm": _spread(self.pose_change),
            "pose_change_mm_per_fit": self.pose_change.mean(axis=1).tolist(),
            "full_mesh_again_mm": _spread(self.own_change),
            "best_pose_shift_mm": _spread(self.best_pose_shift),
        }


def level_check(
    body: Body,
    cameras: tuple[Camera, ...],
    count: int,
    advance: Callable[[], None],
    fit: Evolution = FIT,
) -> LevelCheck:
    """Over ``count`` poses of both sequences; ``advance`` is called after each."""
    rng = np.random.default_rng(7)
    poses = np.concatenate([sequence(body, name, 90)[15::3] for name in "AB"])
    poses = poses[np.linspace(0, len(poses) - 1, count).round().astype(int)]
    threads = os.cpu_count() or 1
    coarse, full = (
        NativeEvaluator(body, cameras, choice(body, cameras), threads)
        for choice in (coarse_level, full_level)
    )
    masks, energies, changes, own, shifts = [], [], [], [], []
    for number, pose in enumerate(poses):
        maps = xor_weight_maps(filmed(full, pose))
        masks.append(_mask_xor(coarse, full, pose))
        energies.append(_energy_difference(coarse, full, maps, pose, rng))
        start = clamped(body, pose[None] + rng.normal(0, _START_SPREAD, (1, len(pose))))[0]
        by_coarse, by_full = (_fitted(e, maps, start, fit, number) for e in (coarse, full))
        changes.append(_distances(by_coarse, by_full))
        shifts.append(_distances(by_coarse, points(body, pose[None])[0]))
        if number % _EVERY == 0:
            own.append(_distances(by_full, _fitted(full, maps, start, fit, count + number)))
        advance()
    return LevelCheck(*map(np.array, (masks, energies, changes, own, shifts)))


def _mask_xor(coarse: NativeEvaluator, full: NativeEvaluator, pose: np.ndarray) -> list[float]:
    pictures = zip(coarse.silhouettes(pose), full.silhouettes(pose), strict=True)
    return [np.count_nonzero(c ^ f) / max(np.count_nonzero(f), 1) for c, f in pictures]


def _energy_difference(
    coarse: NativeEvaluator,
    full: NativeEvaluator,
    maps: WeightMaps,
    pose: np.ndarray,
    rng: np.random.Generator,
) -> np.ndarray:
    poses = pose + rng.normal(0, WHOLE_SPREAD, (_CANDIDATES, len(pose)))
    one, other = (e.energies(e.prepared(maps), poses).sum(axis=1) for e in (coarse, full))
    return np.abs(one - other) / maps.constants.sum()


def _fitted(
    evaluator: NativeEvaluator, maps: WeightMaps, start: np.ndarray, fit: Evolution, seed: int
) -> np.ndarray:
    """(14, 3) points of the pose found."""
    body, weights = evaluator.body, evaluator.prepared(maps)

    def energy(poses: np.ndarray) -> np.ndarray:
        return evaluator.energies(weights, clamped(body, poses)).sum(axis=1)

    found = evolved(energy, start, equal_steps(body, start), fit, np.random.default_rng(seed))
    return points(body, clamped(body, found[None]))[0]


def equal_steps(body: Body, pose: np.ndarray) -> np.ndarray:
    """(D, D) columns of steps from ``pose`` (D,) that move joints and bone ends by 1 m rms.

    To first order, that is; what they do is perpendicular. Steps that move none of the joints are
    stiffened, and so stay finite.
    """
    count, step = len(pose), _DERIVATIVE_STEP * np.eye(len(pose))
    transforms = joint_transforms(body, np.concatenate([pose + step, pose - step]))
    joints = transforms[..., 3]
    tails = (transforms[..., :3] @ body.tails[..., None])[..., 0] + joints
    ends = np.concatenate([joints, tails], axis=1).reshape(2, count, -1)
    slopes = (ends[0] - ends[1]) / (2 * _DERIVATIVE_STEP)
    squares = 3 * slopes @ slopes.T / slopes.shape[1]
    squares += np.diag(np.full(count, _STIFFNESS**2 * np.median(np.diag(squares))))
    values, axes = np.linalg.eigh(squares)
    return axes / np.sqrt(values)


def _distances(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return _MM * np.linalg.norm(one - other, axis=1)


def _spread(values: np.ndarray) -> dict[str, float]:
    return {"mean": float(values.mean()), "max": float(values.max())}
