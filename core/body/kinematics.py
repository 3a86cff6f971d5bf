"""Where joints and points are in a pose, and which poses the limits allow.

The plain statement of the convention in `body.py`, made of SciPy rotations: slow and obvious, the
oracle of the native transforms.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from .body import Body, DofKind, Surface

TOLERANCE = 1e-9
"""Slack of the limits, rad or m: a value put on its limit stays within it."""
_BLOCK = 500
"""Poses."""


def joint_transforms(body: Body, poses: np.ndarray) -> np.ndarray:
    """(N, J, 3, 4) world_from_joint of poses (N, D), metres."""
    return chained(body, joint_motions(body, poses))


def joint_motions(body: Body, poses: np.ndarray) -> np.ndarray:
    """(N, J, 3, 4) rotation and shift of every joint in its own space, of poses (N, D)."""
    poses = _checked(body, poses)
    motions = np.zeros((len(poses), len(body.joint_names), 3, 4))
    for joint in range(len(body.joint_names)):
        motions[:, joint, :, :3], motions[:, joint, :, 3] = _joint_motion(body, joint, poses)
    return motions


def chained(body: Body, motions: np.ndarray) -> np.ndarray:
    """(N, J, 3, 4) world_from_joint of the joints' own motions (N, J, 3, 4)."""
    out = np.zeros_like(motions)
    for joint, parent in enumerate(body.parents):
        rotation, offset = motions[:, joint, :, :3], body.offsets[joint] + motions[:, joint, :, 3]
        if parent < 0:
            out[:, joint, :, :3], out[:, joint, :, 3] = rotation, offset
            continue
        world_from_parent = out[:, parent, :, :3]
        out[:, joint, :, :3] = world_from_parent @ rotation
        out[:, joint, :, 3] = (world_from_parent @ offset[..., None])[..., 0] + out[:, parent, :, 3]
    return out


def _joint_motion(body: Body, joint: int, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Rotation (N, 3, 3) and shift (N, 3) of one joint: the product of its rows in order."""
    rotation = np.broadcast_to(np.eye(3), (len(poses), 3, 3))
    shift = np.zeros((len(poses), 3))
    rows = iter(np.flatnonzero(body.dofs.joints == joint))
    for row in rows:
        vector = poses[:, row, None] * body.dofs.axes[row]
        if body.dofs.kinds[row] == DofKind.TRANSLATION:
            shift = shift + (rotation @ vector[..., None])[..., 0]
            continue
        if body.dofs.kinds[row] == DofKind.SWING:
            second = next(rows)
            vector = vector + poses[:, second, None] * body.dofs.axes[second]
        rotation = rotation @ Rotation.from_rotvec(vector).as_matrix()
    return rotation, shift


def joint_positions(body: Body, poses: np.ndarray) -> np.ndarray:
    """(N, J, 3) world metres of all joints in poses (N, D)."""
    return joint_transforms(body, poses)[..., 3]


def points(body: Body, poses: np.ndarray) -> np.ndarray:
    """(N, P, 3) world metres of the body's points in poses (N, D)."""
    return carried_points(body, joint_transforms(body, poses))


def carried_points(body: Body, transforms: np.ndarray) -> np.ndarray:
    """(N, P, 3) world metres of the body's points, of world_from_joint (N, J, 3, 4)."""
    transforms = transforms[:, body.point_joints]
    return (transforms[..., :3] @ body.point_offsets[..., None])[..., 0] + transforms[..., 3]


def in_blocks(
    places: Callable[[Body, np.ndarray], np.ndarray], body: Body, poses: np.ndarray
) -> np.ndarray:
    """The (T, …) places of all poses; long takes would need much memory for their transforms."""
    first = places(body, poses[:_BLOCK])
    found = np.empty((len(poses), *first.shape[1:]))
    found[:_BLOCK] = first
    for begin in range(_BLOCK, len(poses), _BLOCK):
        found[begin : begin + _BLOCK] = places(body, poses[begin : begin + _BLOCK])
    return found


def rest_joints(body: Body) -> np.ndarray:
    """(J, 3) world metres of all joints in the rest pose."""
    joints = np.array(body.offsets)
    for joint, parent in enumerate(body.parents):
        if parent >= 0:
            joints[joint] += joints[parent]
    return joints


@lru_cache(maxsize=16)
def skinned_segments(body: Body, surface: Surface) -> np.ndarray:
    """(S,) bool, which segments have a vertex that follows another joint than their own."""
    if surface.skin is None:
        return np.zeros(len(body.segment_names), bool)
    own = np.repeat(body.segment_joints, np.diff(surface.vertex_starts))
    strays = ((surface.skin.joints != own[:, None]) & (surface.skin.weights > 0)).any(axis=1)
    starts = surface.vertex_starts
    return np.array([strays[a:b].any() for a, b in pairwise(starts)], bool)


def posed_segment(
    body: Body, surface: Surface, transforms: np.ndarray, segment: int
) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) of a segment and (3, 4) what carries them into the world, metres.

    ``transforms`` (J, 3, 4) are those of `joint_transforms`. A skinned segment's vertices come in
    the world already, blended in float64, term by term in the kernel's order, then rounded to
    float32.
    """
    begin, end = surface.vertex_starts[segment : segment + 2]
    joint, vertices = body.segment_joints[segment], surface.vertices[begin:end].astype(float)
    if surface.skin is None or not skinned_segments(body, surface)[segment]:
        return vertices, transforms[joint]
    rest = rest_joints(body)
    blended = np.zeros_like(vertices)
    for k in range(surface.skin.joints.shape[1]):
        followed = surface.skin.joints[begin:end, k]
        m, weight = transforms[followed], surface.skin.weights[begin:end, k].astype(float)
        x, y, z = (vertices + (rest[joint] - rest[followed])).T[:, :, None]
        carried = m[:, :, 0] * x + m[:, :, 1] * y + m[:, :, 2] * z + m[:, :, 3]
        blended += weight[:, None] * carried
    return blended.astype(np.float32).astype(float), np.eye(3, 4)


def world_vertices(body: Body, pose: np.ndarray, level: int = -1) -> np.ndarray:
    """(n, 3) world metres of the vertices of one level of detail in a pose (D,)."""
    transforms = joint_transforms(body, np.asarray(pose)[None])[0]
    placed = []
    for segment in range(len(body.segment_names)):
        vertices, carried = posed_segment(body, body.surfaces[level], transforms, segment)
        placed.append(vertices @ carried[:, :3].T + carried[:, 3])
    return np.concatenate(placed)


def rest_height(body: Body) -> float:
    """Metres from the floor to the top of the head in the rest pose."""
    return float(world_vertices(body, body.rest_pose)[:, 2].max())


def swing_rows(body: Body, joint: int) -> tuple[int, int]:
    """The two rows of the DOF table that make the joint's swing.

    Raises:
        ValueError: the joint has no swing.
    """
    dofs = body.dofs
    rows = np.flatnonzero((dofs.joints == joint) & (dofs.kinds == DofKind.SWING))
    if len(rows) != 2:
        raise ValueError(f"expected a swing in joint {body.joint_names[joint]}")
    return int(rows[0]), int(rows[1])


def within_limits(body: Body, poses: np.ndarray) -> np.ndarray:
    """(N,) bool, whether all values of poses (N, D) lie in their intervals and cones."""
    poses = _checked(body, poses)
    low, high = body.dofs.limits.T
    inside = ((poses >= low - TOLERANCE) & (poses <= high + TOLERANCE)).all(axis=1)
    for cone in _swings(body).cones:
        inside &= cone.depths(poses[:, cone.rows]) >= -TOLERANCE
    return inside


def clamped(body: Body, poses: np.ndarray) -> np.ndarray:
    """Poses (N, D) brought within the limits: each value and each swing to the nearest allowed."""
    low, high = body.dofs.limits.T
    poses = np.minimum(np.maximum(_checked(body, poses), low), high)
    swings = _swings(body)
    apart = poses[:, swings.rows] - swings.centres
    doubted = (np.square(apart).sum(axis=2) > swings.radii**2).any(axis=0)
    for index in np.flatnonzero(doubted).tolist():
        cone = swings.cones[index]
        values = poses[:, cone.rows]
        outside = np.flatnonzero(cone.depths(values) < 0)
        if len(outside):
            poses[outside[:, None], cone.rows] = cone.nearest_on_outline(values[outside])
    return poses


def inward_normals(cone: np.ndarray) -> np.ndarray:
    """(K, 2) unit normals of a cone's edges, pointing inside."""
    edges = np.roll(cone, -1, axis=0) - cone
    return np.stack([-edges[:, 1], edges[:, 0]], -1) / np.linalg.norm(edges, axis=1)[:, None]


@dataclass(frozen=True, eq=False)
class _Cone:
    """A swing's rows, its polygon's corners (K, 2), edges (K, 2) and their inward normals (K, 2).

    ``offsets`` (K,) are the edges' signed distances from 0.
    """

    rows: list[int]
    corners: np.ndarray
    edges: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray

    def depths(self, swings: np.ndarray) -> np.ndarray:
        """(N,) signed distances of swings (N, 2) to the nearest edge's line, inside positive."""
        return (swings @ self.normals.T - self.offsets).min(axis=1)

    def nearest_on_outline(self, swings: np.ndarray) -> np.ndarray:
        """(N, 2) points of the polygon's outline nearest to swings (N, 2)."""
        offsets = swings[:, None] - self.corners
        along = np.clip((offsets * self.edges).sum(-1) / (self.edges**2).sum(-1), 0, 1)
        candidates = self.corners + along[..., None] * self.edges
        nearest = np.linalg.norm(swings[:, None] - candidates, axis=-1).argmin(axis=1)
        return candidates[np.arange(len(swings)), nearest]


@dataclass(frozen=True, eq=False)
class _Swings:
    """All C cones of a body, their rows (C, 2), and circles (C, 2) and (C,) that lie inside."""

    cones: tuple[_Cone, ...]
    rows: np.ndarray
    centres: np.ndarray
    radii: np.ndarray


@lru_cache(maxsize=16)
def _swings(body: Body) -> _Swings:
    cones = []
    for joint, corners in body.cones.items():
        inward = inward_normals(corners)
        edges = np.roll(corners, -1, axis=0) - corners
        offsets = (inward * corners).sum(axis=1)
        cones.append(_Cone(list(swing_rows(body, joint)), corners, edges, inward, offsets))
    rows = np.array([cone.rows for cone in cones], int).reshape(-1, 2)
    centres = np.array([cone.corners.mean(axis=0) for cone in cones]).reshape(-1, 2)
    radii = [cone.depths(centre[None])[0] for cone, centre in zip(cones, centres, strict=True)]
    return _Swings(tuple(cones), rows, centres, np.array(radii))


def _checked(body: Body, poses: np.ndarray) -> np.ndarray:
    poses = np.array(poses, float)
    if poses.ndim != 2 or poses.shape[1] != len(body.dofs):
        raise ValueError(f"expected poses of shape any x {len(body.dofs)}, got {poses.shape}")
    return poses
