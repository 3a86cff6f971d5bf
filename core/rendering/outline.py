"""Points on the outline of the rendered silhouettes, each with its place on the body's surface.

The outline is made of edges between a triangle that shows its front and one that shows its back,
and of borders. Sampled in even steps along the image, a point of such an edge lies on the outline
where the pixel beside it, on the far side from the triangle, is not covered. What was snapped to
1/256 px for the picture decides here as well, so that all backends find the same edges.

Contour fitting moves these points towards the observed contour; since each is fixed to a joint, the
derivative of its image is that of the skeleton (Rosenhahn et al., IJCV 73, 2007, section 3).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ..body.body import Body, Surface
from ..body.kinematics import joint_transforms, posed_segment
from ..cameras.camera import Camera
from ..energy.evaluator import Outline
from .model import clipping_planes, enclosing_spheres
from .records import EdgeRecords, edge_records
from .snapping import homogeneous_px, snapped_px

BESIDE_PX = 0.75
"""Just over half a pixel's diagonal: the pixel's centre there lies beyond a straight edge."""
NOWHERE = Outline(np.zeros(0, np.int32), np.zeros((0, 3)), np.zeros((0, 2)), np.zeros((0, 2)))


@dataclass(frozen=True, eq=False)
class Posed:
    """Some segments of a body in a pose.

    Attributes:
        body: the model.
        level: which of its surfaces.
        pose: (D,), or (V, D) with one pose per view.
        segments: indices.
    """

    body: Body
    level: int
    pose: np.ndarray
    segments: Sequence[int]

    def transforms(self, views: int) -> np.ndarray:
        """(V, J, 3, 4) world_from_joint of each of V views."""
        pose = np.asarray(self.pose, float)
        found = joint_transforms(self.body, np.atleast_2d(pose))
        return np.broadcast_to(found, (views, *found.shape[1:]))


def find_outlines(
    posed: Posed, cameras: Sequence[Camera], pictures: Sequence[np.ndarray], spacing_px: float
) -> tuple[Outline, ...]:
    """V outlines of the segments, given the V pictures (H, W) of what they cover.

    A segment that a camera sees from too near, or far outside its picture, has no points there.

    Raises:
        ValueError: no positive spacing.
    """
    if not spacing_px > 0:
        raise ValueError(f"expected a positive spacing, got {spacing_px}")
    outlines = []
    views = zip(posed.transforms(len(cameras)), cameras, pictures, strict=True)
    for placed, camera, picture in views:
        parts = [_samples(posed, placed, camera, s, spacing_px) for s in posed.segments]
        outlines.append(_kept(parts, picture))
    return tuple(outlines)


@lru_cache(maxsize=8)
def _meshes(surface: Surface) -> tuple[tuple[np.ndarray, EdgeRecords], ...]:
    """By segment: triangles (m, 3) counted from its first vertex, and their edge records."""
    starts = pairwise(surface.vertex_starts), pairwise(surface.triangle_starts)
    meshes = [surface.triangles[f0:f1] - v0 for (v0, _), (f0, f1) in zip(*starts, strict=True)]
    return tuple((triangles, edge_records(triangles)) for triangles in meshes)


def _is_wholly_seen(camera: Camera, vertices: np.ndarray, carried: np.ndarray) -> bool:
    """Whether the sphere round vertices (n, 3) lies in the region that can be drawn."""
    sphere = enclosing_spheres(vertices, np.array([0, len(vertices)]))[0]
    centre = carried @ [*sphere[:3], 1.0]
    distances = clipping_planes(camera)[:5] @ [*centre, 1.0]
    return bool((distances > sphere[3] * (1 + 1e-6) + 1e-9).all())


def _samples(
    posed: Posed, placed: np.ndarray, camera: Camera, segment: int, spacing_px: float
) -> Outline:
    """All samples of a segment's contour edges, hidden ones too; joints as ``placed`` (J, 3, 4)."""
    body, surface = posed.body, posed.body.surfaces[posed.level]
    triangles, records = _meshes(surface)[segment]
    vertices, carried = posed_segment(body, surface, placed, segment)
    if not len(triangles) or not _is_wholly_seen(camera, vertices, carried):
        return NOWHERE
    h = homogeneous_px(camera.projection, carried, vertices)
    snapped = snapped_px(h)
    a, b, c = (snapped[triangles[:, k]] for k in range(3))
    areas = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    signs = np.append(np.sign(areas), 0)
    sums = signs[records.faces[:, 0]] - signs[records.faces[:, 1]]
    p, q = records.vertices[sums != 0].T
    steps = (snapped[q] - snapped[p]) / 256.0
    lengths = np.hypot(*steps.T)
    counts = np.ceil(lengths / spacing_px).astype(int)
    edge = np.repeat(np.arange(len(p)), counts)
    t = (np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[edge]
    p, q, steps, t = p[edge], q[edge], steps[edge], t[:, None]
    ahead = (t / h[q, 2:]) / ((1 - t) / h[p, 2:] + t / h[q, 2:])
    points = vertices[p] + ahead * (vertices[q] - vertices[p])
    own = placed[body.segment_joints[segment]]
    world = points @ carried[:, :3].T + carried[:, 3]
    turned = np.stack([steps[:, 1], -steps[:, 0]], axis=1) / lengths[edge, None]
    return Outline(
        np.full(len(edge), segment, np.int32),
        (world - own[:, 3]) @ own[:, :3],
        snapped[p] / 256.0 + t * steps,
        turned * np.sign(sums[sums != 0])[edge, None],
    )


def _kept(parts: Sequence[Outline], picture: np.ndarray) -> Outline:
    """The samples beside which the picture is empty, all parts in one."""
    parts = [NOWHERE, *parts]
    joined = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in ("segments", "points", "px", "normals")
    }
    beside = np.floor(joined["px"] + BESIDE_PX * joined["normals"] + 0.5).astype(int)
    inside = ((beside >= 0) & (beside < picture.shape[::-1])).all(axis=1)
    x, y = np.where(inside[:, None], beside, 0).T
    kept = inside & ~picture[y, x]
    return Outline(**{name: array[kept] for name, array in joined.items()})
