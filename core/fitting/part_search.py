"""Searching one part of the body while the rest stands still (Theobalt et al. 2003, section 3)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..body.body import Body, Part
from ..body.limits import Limits
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator, Weights
from .torso_volume import TorsoVolume
from .tracker import Tally

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
        torso: volume that the part must stay out of; None for parts that hold it.
        windows: (V, 4) px outside of which the weights are 0; None for whole pictures.
        prior_px: energy in px of one standard deviation away from the rest pose.
        tally: counts what is evaluated.
        segments: what is drawn of each candidate; all of the body where ``weights`` hold the other
            parts' silhouettes unmasked.
        offset_px: added to every energy.
    """

    evaluator: Evaluator
    weights: Weights
    pose: np.ndarray
    part: Part
    limits: Limits
    torso: TorsoVolume | None
    windows: np.ndarray | None
    prior_px: float
    tally: Tally
    segments: Sequence[int]
    offset_px: int = 0

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """(N,) energies of values (N, n)."""
        poses = np.repeat(self.pose[None], len(values), axis=0)
        poses[:, self.part.dofs] = values
        allowed = self.limits.allow(values)
        if self.torso is not None:
            transforms = self.evaluator.transforms(poses[allowed])
            allowed[allowed] = ~self.torso.holds_part(transforms, self.part)
        energies = np.full(len(values), FORBIDDEN)
        if allowed.any():
            energies[allowed] = self._pixels(poses[allowed])
            if self.prior_px:
                prior = rest_prior(self.evaluator.body, values[allowed], self.part.dofs)
                energies[allowed] = np.round(energies[allowed] + self.prior_px * prior, 6)
        return energies

    def _pixels(self, poses: np.ndarray) -> np.ndarray:
        self.tally.evaluated += len(poses)
        if self.windows is not None:
            bounds = self.evaluator.bounds(poses, self.part.segments)
            self.tally.outside_windows += int(leave_windows(bounds, self.windows).sum())
        pixels = self.evaluator.energies(self.weights, poses, self.segments).sum(axis=1)
        return pixels + self.offset_px


def rest_prior(body: Body, values: np.ndarray, dofs: Sequence[int] | None = None) -> np.ndarray:
    """(N,) squared distances of values (N, n) from rest, in standard deviations of the DOFs."""
    spread = body.dofs.rest_spread if dofs is None else body.dofs.rest_spread[list(dofs)]
    return ((values / spread) ** 2).sum(axis=1)


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
    """(V, 4) windows x0, y0, x1, y1 about the part's centre of mass in ``pose`` (section 4.2).

    ``side`` is the window's edge in px of a picture whose shorter side is 240 px; it grows with the
    resolution.
    """
    bounds = evaluator.bounds(pose[None], part.segments)[0]
    pictures = evaluator.silhouettes(pose, part.segments)
    centres = np.array(
        [
            np.argwhere(picture).mean(axis=0)[::-1] if picture.any() else (box[:2] + box[2:]) / 2
            for picture, box in zip(pictures, bounds, strict=True)
        ]
    )
    halves = np.array([side * min(camera.size) / 480 for camera in evaluator.cameras])[:, None]
    return np.concatenate([centres - halves, centres + halves], axis=1).round().astype(np.int64)


def leave_windows(bounds: np.ndarray, windows: np.ndarray) -> np.ndarray:
    """(N,) bool: whether bounds (N, V, 4) reach out of the windows (V, 4) in any view."""
    out = (bounds[..., :2] < windows[:, :2]) | (bounds[..., 2:] > windows[:, 2:])
    return out.any(axis=(1, 2))
