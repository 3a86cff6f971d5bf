"""Where segments are in the pictures: matrices for OpenGL, and which segments it has to clip.

OpenGL clips what leaves its range, and moves vertices a little where it does. So that a silhouette
depends on nothing but the pose, no triangle is ever left to that: a segment that may come too near
to the camera or too far out of the picture is marked, and clipped by a shader of ours.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...body.body import Body
from ...cameras.camera import Camera
from ..model import GUARD_PX, NEAR, enclosing_spheres
from .chain import Chain

HIDDEN, WHOLE, CUT = 0, 1, 2
"""A segment that covers no pixel of the window; one to draw as it is; one to clip first."""
_SLACK = 1e-6
_NOWHERE = 1e20
"""Metres; what is farther away, or not a number, covers nothing and has no place in float32."""
_MOST_POINTS = 1 << 20


@dataclass(frozen=True, eq=False)
class Placement:
    """N poses of S segments in some views.

    Attributes:
        rows: (V, 3, N, S, 4) float32, rows of the matrices homogeneous px from joint.
        states: (V, N, S) uint32, `HIDDEN`, `WHOLE` or `CUT`.
        reach: (V, 4) int64 px x0, y0, x1, y1, what of each window they can cover, all together;
            empty where they cover nothing.
    """

    rows: np.ndarray
    states: np.ndarray
    reach: np.ndarray


def window_planes(projections: np.ndarray, windows: np.ndarray, margin: float) -> np.ndarray:
    """(V, 9, 4) unit planes in the world, positive inside: near, the region's sides, the window's.

    The region is the window (V, 4) with ``margin`` px all round.
    """
    plane, depth = projections[:, :2], projections[:, 2:]
    low, high = windows[:, :2, None], windows[:, 2:, None] - 1
    near = depth - [0, 0, 0, NEAR]
    sides = [
        side
        for reach in (margin, 1)
        for side in (plane - (low - reach) * depth, (high + reach) * depth - plane)
    ]
    planes = np.concatenate([near, *sides], axis=1)
    return planes / np.linalg.norm(planes[:, :, :3], axis=2, keepdims=True)


def _distances(centres: np.ndarray, planes: np.ndarray) -> np.ndarray:
    """(V, p, N, S) values of planes (V, p, 4) at points (V or 1, 3, N, S)."""
    views, _, count, segments = centres.shape
    flat = planes[:, :, :3] @ centres.reshape(views, 3, -1) + planes[:, :, 3:]
    return flat.reshape(*planes.shape[:2], count, segments)


def _states(centres: np.ndarray, radii: np.ndarray, planes: np.ndarray) -> np.ndarray:
    """(V, N, S) states of spheres with centres (V or 1, 3, N, S), by planes (V, 9, 4)."""
    distances = _distances(centres, planes)
    radii = radii * (1 + _SLACK) + _SLACK
    states = np.where((distances[:, :5] > radii).all(axis=1), WHOLE, CUT)
    unseen = (distances[:, [0, 5, 6, 7, 8]] < -radii).any(axis=1)
    return np.where(unseen, HIDDEN, states).astype(np.uint32)


def _somewhere(world: np.ndarray) -> np.ndarray:
    """(V or 1, N, S) bool, whether matrices (V or 1, N, S, 3, 4) place a segment anywhere."""
    return (np.abs(world) < _NOWHERE).all(axis=(3, 4))


def _reach(
    centres: np.ndarray,
    radii: np.ndarray,
    projections: np.ndarray,
    windows: np.ndarray,
    states: np.ndarray,
) -> np.ndarray:
    """(V, 4) px that hold the pictures of all spheres but hidden ones, clipped to the windows.

    A sphere's homogeneous px lie in intervals, of which the quotient is taken; counted from the
    window's middle, so that the quotients are small and their intervals narrow.
    """
    middles = (windows[:, :2] + windows[:, 2:]) / 2
    planes = projections.copy()
    planes[:, :2] -= middles[:, :, None] * planes[:, 2:]
    h = _distances(centres, planes)
    spread = np.linalg.norm(planes[:, :, :3], axis=2)[:, :, None, None] * radii
    least = h[:, 2:] - spread[:, 2:]
    near, far = np.maximum(least, NEAR), h[:, 2:] + spread[:, 2:]
    low, high = h[:, :2] - spread[:, :2], h[:, :2] + spread[:, :2]
    low = np.where(low < 0, low / near, low / far)
    high = np.where(high > 0, high / near, high / far)
    hidden = (states == HIDDEN)[:, None]
    low = np.where(hidden, np.inf, low).min(axis=(2, 3), initial=np.inf) + middles
    high = np.where(hidden, -np.inf, high).max(axis=(2, 3), initial=-np.inf) + middles
    low = np.clip(np.floor(low) - 1, windows[:, :2], windows[:, 2:])
    high = np.clip(np.ceil(high) + 2, low, windows[:, 2:])
    return np.concatenate([low, high], axis=1).astype(np.int64)


class Placer:
    """Places the segments of a body in the pictures of cameras.

    Args:
        body: the model.
        cameras: V pinhole cameras.
        level: which of the body's surfaces.
    """

    def __init__(self, body: Body, cameras: Sequence[Camera], level: int):
        self.body, self.surface = body, body.surfaces[level]
        self._chain = Chain(body)
        self.projections = np.stack([camera.projection for camera in cameras])
        self.spheres = enclosing_spheres(self.surface.vertices, self.surface.vertex_starts)

    def transforms(self, poses: np.ndarray) -> np.ndarray:
        """(V or 1, N, J, 3, 4) world from joint of poses (N, V, D) or (N, D)."""
        if poses.ndim == 2:
            return self._chain.transforms(poses)[None]
        count, views, dofs = poses.shape
        flat = self._chain.transforms(poses.swapaxes(0, 1).reshape(-1, dofs))
        return flat.reshape(views, count, len(self.body.joint_names), 3, 4)

    def placed(
        self,
        transforms: np.ndarray,
        segments: Sequence[int],
        views: np.ndarray,
        windows: np.ndarray,
        margin: float,
    ) -> Placement:
        """The segments in the windows (k, 4) of some views.

        Args:
            transforms: (V or 1, N, J, 3, 4), as by `transforms`.
            segments: S indices.
            views: (k,) indices.
            windows: (k, 4) px x0, y0, x1, y1.
            margin: px round a window within which vertices may lie unclipped.
        """
        chosen = list(segments)
        world = transforms[:, :, self.body.segment_joints[chosen]]
        world = world if len(world) == 1 else world[views]
        count = world.shape[1]
        columns = np.ascontiguousarray(np.moveaxis(world, 3, 1)).reshape(len(world), 3, -1)
        projections = self.projections[views]
        rows = (projections[:, :, :3] @ columns).reshape(len(views), 3, count, len(chosen), 4)
        rows[..., 3] += projections[:, :, 3, None, None]
        spheres = self.spheres[chosen]
        local = np.append(spheres[:, :3], np.ones((len(chosen), 1)), axis=1)
        centres = np.moveaxis((world * local[:, None]).sum(axis=-1), 3, 1)
        planes = window_planes(projections, windows, margin)
        states = _states(centres, spheres[:, 3], planes)
        states[np.broadcast_to(~_somewhere(world), states.shape)] = HIDDEN
        reach = _reach(centres, spheres[:, 3], projections, windows, states)
        with np.errstate(over="ignore"):
            return Placement(rows.astype(np.float32), states, reach)

    def bounds(self, transforms: np.ndarray, segments: Sequence[int]) -> np.ndarray:
        """(N, V, 4) int32: x0, y0, x1, y1 (exclusive), px that the segments can cover, unclipped.

        The whole guard region where a segment leaves it or comes too near; zeros for no vertices.
        """
        count, guard = transforms.shape[1], int(GUARD_PX)
        low = np.full((len(self.projections), count, 2), np.inf)
        high, inside = -low, np.ones(low.shape[:2], bool)
        for segment in segments:
            begin, end = self.surface.vertex_starts[segment : segment + 2]
            joints = transforms[:, :, self.body.segment_joints[segment]]
            step = max(1, _MOST_POINTS // max(1, len(self.projections) * (end - begin)))
            for n in range(0, count if end > begin else 0, step):
                part = slice(n, n + step)
                px, within = self._snapped(joints[:, part], self.surface.vertices[begin:end])
                inside[:, part] &= within
                low[:, part] = np.minimum(low[:, part], px.min(axis=2))
                high[:, part] = np.maximum(high[:, part], px.max(axis=2))
        low, high = (np.where(np.isfinite(px), px, 0) for px in (low, high))
        boxes = -np.floor(-np.concatenate([low, high], axis=2) / 256)
        boxes[~inside] = -guard, -guard, guard, guard
        return boxes.swapaxes(0, 1).astype(np.int32)

    def _snapped(self, joints: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(V, N, n, 2) px in 1/256 of points (n, 3), and (V, N) whether all can be drawn.

        Products and sums in the reference's order, so that the bits are the same.
        """
        p = self.projections[:, None, :, :, None]
        m = joints[:, :, None]
        a = (
            p[:, :, :, 0] * m[..., 0, :]
            + p[:, :, :, 1] * m[..., 1, :]
            + p[:, :, :, 2] * m[..., 2, :]
        )
        a[..., 3] += self.projections[:, None, :, 3]
        x, y, z = points.T.astype(float)[:, :, None, None, None]
        h = a[..., 0] * x + a[..., 1] * y + a[..., 2] * z + a[..., 3]
        plane, depth = h[..., :2], h[..., 2:]
        guarded = (np.abs(plane) <= GUARD_PX * depth).all(axis=-1) & (depth[..., 0] >= NEAR)
        with np.errstate(divide="ignore", invalid="ignore"):
            px = np.rint(plane * (1.0 / depth) * 256.0)
        px = np.where(guarded[..., None], px, 0.0)
        return np.moveaxis(px, 0, 2), guarded.all(axis=0)
