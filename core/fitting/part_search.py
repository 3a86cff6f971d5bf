"""Searching one part of the body while the rest stands still (Theobalt et al. 2003, section 3)."""

from dataclasses import dataclass

import numpy as np

from ..body.body import Part
from ..body.limits import Limits
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator, Weights
from .torso_volume import TorsoVolume

FORBIDDEN = 1e9
"""Energy of a candidate beyond the limits or inside the torso; it is never rendered."""


@dataclass(frozen=True, eq=False)
class PartEnergy:
    """Energy of poses that differ from ``pose`` in the part's DOFs only.

    Called with (N, n) values of the part's DOFs, returns (N,) energies in px, summed over views;
    candidates beyond limits or with a limb inside the torso are `FORBIDDEN` and never evaluated.

    Attributes:
        evaluator: renders the body.
        weights: the frame's weights, the other parts' silhouettes masked out.
        pose: (D,) the whole body's pose.
        part: what is searched.
        limits: of the part's DOFs.
        torso: volume that limbs must stay out of; None for parts that cannot enter it.
        prior_px: energy in px of one standard deviation away from the rest pose.
    """

    evaluator: Evaluator
    weights: Weights
    pose: np.ndarray
    part: Part
    limits: Limits
    torso: TorsoVolume | None
    prior_px: float

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """(N,) energies of values (N, n)."""
        part = self.part
        poses = np.repeat(self.pose[None], len(values), axis=0)
        poses[:, part.dofs] = values
        allowed = self.limits.allow(values)
        if self.torso is not None:
            transforms = self.evaluator.transforms(poses[allowed])
            allowed[allowed] = ~self.torso.holds_limb(transforms, part)
        energies = np.full(len(values), FORBIDDEN)
        if allowed.any():
            per_view = self.evaluator.energies(self.weights, poses[allowed], part.segments)
            energies[allowed] = np.round(per_view.sum(axis=1) + self._prior(values[allowed]), 6)
        return energies

    def _prior(self, values: np.ndarray) -> np.ndarray:
        spread = self.evaluator.body.dofs.rest_spread[list(self.part.dofs)]
        return self.prior_px * ((values / spread) ** 2).sum(axis=1)


def first_steps(evaluator: Evaluator, pose: np.ndarray, part: Part, tip_px: float) -> np.ndarray:
    """(n,) change of each of the part's DOFs that moves the part's tip by ``tip_px``.

    The tip is whichever joint or bone end of the part moves most; pixels are those of the mean
    view.
    """
    body, epsilon = evaluator.body, 1e-3
    dofs = list(part.dofs)
    poses = np.repeat(pose[None], len(dofs) + 1, axis=0)
    poses[np.arange(1, len(dofs) + 1), dofs] += epsilon
    joints = np.unique(body.segment_joints[list(part.segments)])
    transforms = evaluator.transforms(poses)[:, joints]
    ends = np.einsum("njab,jb->nja", transforms[..., :3], body.tails[joints]) + transforms[..., 3]
    lever = np.linalg.norm(ends[1:] - ends[0], axis=2).max(axis=1) / epsilon
    pixel = metres_per_pixel(evaluator.cameras, ends[0].mean(axis=0))
    return np.round(tip_px * pixel / np.maximum(lever, 0.02), 9)


def metres_per_pixel(cameras: tuple[Camera, ...], point: np.ndarray) -> float:
    """Mean size of a pixel at a world point (3,), in metres."""
    sizes = [camera.depths(point) / camera.matrix[0, 0] for camera in cameras]
    return float(np.mean(np.abs(sizes)))


def part_windows(evaluator: Evaluator, pose: np.ndarray, part: Part, side: int) -> np.ndarray:
    """(V, 4) windows x0, y0, x1, y1 about the middle of the part in ``pose`` (section 4.2).

    ``side`` is the window's edge in px of a picture whose shorter side is 240 px; it grows with the
    resolution.
    """
    bounds = evaluator.bounds(pose[None], part.segments)[0]
    centres = (bounds[:, :2] + bounds[:, 2:]) / 2
    halves = np.array([side * min(camera.size) / 480 for camera in evaluator.cameras])[:, None]
    return np.concatenate([centres - halves, centres + halves], axis=1).round().astype(np.int64)


def leaves_window(bounds: np.ndarray, windows: np.ndarray) -> bool:
    """Whether bounds (V, 4) reach out of the windows (V, 4) in any view."""
    return bool((bounds[:, :2] < windows[:, :2]).any() or (bounds[:, 2:] > windows[:, 2:]).any())
