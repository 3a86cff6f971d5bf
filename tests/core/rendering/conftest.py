"""Bodies of arbitrary triangles, cameras round them, and who draws them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.body.body import Body, Dofs, Surface
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.energy.evaluator import WeightMaps
from silhouette_mocap.core.native.library import load
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator

KINDS = [0, 0, 0, 1, 1, 1]
JOINT_KINDS = [1, 2, 2]


def sphere(rings: int, around: int, radius: float, rng: np.random.Generator, bumps: float = 0.1):
    """A closed, bumpy ball: vertices (n, 3) and triangles (m, 3)."""
    polar = np.linspace(0, np.pi, rings + 2)[1:-1, None]
    turn = np.arange(around)[None] * 2 * np.pi / around
    grid = np.stack(
        np.broadcast_arrays(
            np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)
        ),
        axis=-1,
    ).reshape(-1, 3)
    vertices = np.concatenate([[[0, 0, 1]], grid, [[0, 0, -1]]])
    vertices = vertices * radius * rng.uniform(1 - bumps, 1 + bumps, (len(vertices), 1))
    triangles = []
    for k in range(around):
        n = (k + 1) % around
        triangles.append((0, 1 + k, 1 + n))
        for r in range(rings - 1):
            a, b = 1 + r * around, 1 + (r + 1) * around
            triangles += [(a + k, b + k, b + n), (a + k, b + n, a + n)]
        last = 1 + (rings - 1) * around
        triangles.append((len(vertices) - 1, last + n, last + k))
    return vertices, np.array(triangles)


def soup(rng: np.random.Generator, vertices: int, triangles: int, size: float = 0.15):
    """Open, overlapping, non-manifold, with triangles that name a vertex twice."""
    return rng.normal(0, size, (vertices, 3)), rng.integers(0, vertices, (triangles, 3))


def mixed_pieces(rng: np.random.Generator):
    """A closed ball, an open one, and two soups that share no sense of orientation."""
    vertices, triangles = sphere(3, 6, 0.15, rng)
    open_ball = vertices * 0.7, triangles[::2]
    return [(vertices, triangles), open_ball, soup(rng, 7, 9), soup(rng, 5, 14)]


def body_of(pieces, rng: np.random.Generator) -> Body:
    """Four joints in a random tree; the pieces ride on them in turn."""
    joints = 4
    kinds = KINDS + JOINT_KINDS * (joints - 1)
    rows = [0] * 6 + [j for j in range(1, joints) for _ in JOINT_KINDS]
    axes = np.concatenate(
        [np.eye(3), np.eye(3)] + [Rotation.random(random_state=j).as_matrix() for j in range(3)]
    )
    count = len(kinds)
    dofs = Dofs(
        names=tuple(f"dof_{d}" for d in range(count)),
        joints=rows,
        kinds=kinds,
        axes=axes,
        limits=np.tile([-np.inf, np.inf], (count, 1)),
        rest_spread=np.full(count, np.inf),
        directions=("",) * count,
    )
    vertex_starts = np.cumsum([0, *(len(v) for v, _ in pieces)])
    triangles = [
        np.reshape(t, (-1, 3)) + s for (_, t), s in zip(pieces, vertex_starts, strict=False)
    ]
    surface = Surface(
        vertices=np.concatenate([v for v, _ in pieces]),
        triangles=np.concatenate(triangles),
        vertex_starts=vertex_starts,
        triangle_starts=np.cumsum([0, *(len(t) for t in triangles)]),
    )
    return Body(
        name="test",
        joint_names=tuple(f"joint_{j}" for j in range(joints)),
        parents=[-1, *(int(rng.integers(0, j)) for j in range(1, joints))],
        offsets=rng.normal(0, 0.2, (joints, 3)),
        tails=np.zeros((joints, 3)),
        dofs=dofs,
        cones={},
        segment_names=tuple(f"segment_{s}" for s in range(len(pieces))),
        segment_joints=np.arange(len(pieces)) % joints,
        surfaces=(surface,),
        point_joints=np.zeros(14),
        point_offsets=np.zeros((14, 3)),
        parts=(),
    )


def camera_at(distance: float, focal: float, size, rng: np.random.Generator) -> Camera:
    """A camera anywhere on a ball round the origin, looking at it roughly."""
    rotation = Rotation.random(random_state=int(rng.integers(1 << 30))).as_matrix()
    width, height = size
    matrix = [[focal, 0, width / 2], [0, 1.1 * focal, height / 2], [0, 0, 1]]
    return Camera("test", size, matrix, np.column_stack([rotation, [0.05, -0.05, distance]]))


def maps_for(cameras, largest: int, rng: np.random.Generator) -> WeightMaps:
    """Random weights between -largest and largest."""
    maps = [rng.integers(-largest, largest + 1, c.size[::-1]).astype(np.int16) for c in cameras]
    return WeightMaps(tuple(maps), rng.integers(0, 1000, len(cameras)))


def moving_part(body: Body, count: int, rng: np.random.Generator):
    """A pose (D,), the segments on the last joint, and poses (count, D) where only these move."""
    pose = rng.normal(0, 0.2, len(body.dofs))
    moving = [s for s, joint in enumerate(body.segment_joints) if joint == 3]
    leaf = np.flatnonzero(body.dofs.joints == 3)
    poses = np.repeat(pose[None], count, axis=0)
    poses[:, leaf] += rng.normal(0, 0.5, (count, len(leaf)))
    return pose, moving, poses


def natives(body: Body, cameras) -> list[NativeEvaluator]:
    """The kernel on every code path of this processor."""
    paths = [path for path in (1, 3, 4) if path <= load().sm_processor()]
    return [NativeEvaluator(body, cameras, processor=path) for path in paths]


def exact(body: Body, cameras) -> list:
    """All that must give the same integers: the reference, then the kernel on every code path."""
    return [ReferenceEvaluator(body, cameras), *natives(body, cameras)]


def edge_distances_px(reference: ReferenceEvaluator, pose, view: int, segments, pixels):
    """(n,) distances of the centres of pixels (n, 2), row and column, to the nearest edge."""
    corners = np.array(list(reference._snapped_triangles(pose, view, segments))) / 256
    begin = corners.reshape(-1, 2)
    along = np.roll(corners, -1, axis=1).reshape(-1, 2) - begin
    offsets = pixels[:, None, ::-1] - begin
    squares = np.maximum((along**2).sum(axis=1), 1e-12)
    nearest = np.clip((offsets * along).sum(axis=2) / squares, 0, 1)
    return np.linalg.norm(offsets - nearest[..., None] * along, axis=2).min(axis=1)


@pytest.fixture
def scenes():
    """The makers of bodies, cameras, weights and evaluators."""

    class Scenes:
        sphere = staticmethod(sphere)
        soup = staticmethod(soup)
        mixed_pieces = staticmethod(mixed_pieces)
        body_of = staticmethod(body_of)
        camera_at = staticmethod(camera_at)
        maps_for = staticmethod(maps_for)
        moving_part = staticmethod(moving_part)
        natives = staticmethod(natives)
        exact = staticmethod(exact)
        edge_distances_px = staticmethod(edge_distances_px)

    return Scenes
