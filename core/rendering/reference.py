"""The oracle: the energy as its definition says it, pixel by pixel and triangle by triangle.

Slow and obvious. Every triangle is projected in float64, clipped where it must be, snapped to
1/256 px, and tested by integer edge functions against every pixel centre of its bounding box, with
the top-left rule. Fast backends must give the same integers.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..body.body import Body
from ..body.kinematics import joint_transforms, posed_segment
from ..cameras.camera import Camera
from ..energy.evaluator import Outline, WeightMaps
from .arguments import (
    Sizes,
    check_weights,
    checked_level,
    checked_maps,
    chosen_segments,
    fixed_segments,
    picture_sizes,
)
from .model import GUARD_PX, check_cameras
from .outline import Posed, find_outlines
from .snapping import homogeneous_px, plane_distances, snapped_px


@dataclass(frozen=True, eq=False)
class ReferenceWeights:
    """Weight maps as they are.

    Attributes:
        maps: V arrays (H, W) int64.
        constants: (V,) int64.
        sizes: of the V pictures.
    """

    maps: tuple[np.ndarray, ...]
    constants: np.ndarray
    sizes: Sizes


def clipped_polygon(corners: np.ndarray) -> np.ndarray:
    """(m, 3) what is left of a triangle (3, 3) in front of all planes (Sutherland and Hodgman).

    A cut is computed from the inner point outwards, so that neighbouring triangles agree on it.
    """
    for plane in range(5):
        distances = plane_distances(corners)[:, plane] if len(corners) else []
        kept = []
        for i, d in enumerate(distances):
            j = (i + 1) % len(corners)
            if d >= 0:
                kept.append(corners[i])
            if (d >= 0) != (distances[j] >= 0):
                inner, outer = (i, j) if d >= 0 else (j, i)
                t = distances[inner] / (distances[inner] - distances[outer])
                kept.append(corners[inner] + t * (corners[outer] - corners[inner]))
        corners = np.reshape(kept, (-1, 3))
    return corners


def covered_pixels(corners: np.ndarray, shape: tuple[int, int]) -> tuple[slice, slice, np.ndarray]:
    """Rows, columns and (h, w) bool: the pixels that a snapped triangle (3, 2) covers.

    A pixel belongs to the triangle where its centre (256 x, 256 y) lies inside, or on a left edge,
    or on a top edge: shared edges are then counted exactly once.
    """
    (ax, ay), (bx, by), (cx, cy) = corners
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    if area < 0:
        corners = corners[::-1]
    low = np.clip(-(-corners.min(axis=0) // 256), 0, shape[::-1])
    high = np.clip(corners.max(axis=0) // 256 + 1, low, shape[::-1])
    rows, columns = slice(low[1], high[1]), slice(low[0], high[0])
    y, x = 256 * np.mgrid[rows, columns]
    covered = np.full(x.shape, area != 0)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
        is_top, is_left = y1 == y0 and x1 > x0, y1 < y0
        covered &= (side >= 0) if is_top or is_left else (side > 0)
    return rows, columns, covered


class ReferenceEvaluator:
    """Energies and silhouettes by definition; see `energy.evaluator.Evaluator`.

    Args:
        body: the model.
        cameras: V pinhole cameras.
        level: which of the body's surfaces to draw.

    Raises:
        ValueError: a camera with lens distortion or too large pictures, or no such level.
    """

    def __init__(self, body: Body, cameras: Sequence[Camera], level: int = 0):
        check_cameras(cameras)
        self.body, self.cameras, self.level = body, tuple(cameras), checked_level(body, level)
        self._sizes = picture_sizes(cameras)

    def prepared(self, maps: WeightMaps) -> ReferenceWeights:
        """The maps as int64."""
        maps = checked_maps(maps, self._sizes)
        wide = tuple(weight_map.astype(np.int64) for weight_map in maps.maps)
        return ReferenceWeights(wide, maps.constants, self._sizes)

    def masked(
        self,
        weights: ReferenceWeights,
        pose: np.ndarray,
        moving: Sequence[int],
        windows: np.ndarray | None = None,
    ) -> ReferenceWeights:
        """Weights under which the ``moving`` segments alone give the full energy."""
        check_weights(weights, ReferenceWeights, self._sizes)
        maps, constants = [], []
        covered = self.silhouettes(pose, fixed_segments(self.body, moving))
        for v, (weight_map, picture) in enumerate(zip(weights.maps, covered, strict=True)):
            constants.append(weights.constants[v] + weight_map[picture].sum())
            left = np.where(picture, 0, weight_map)
            if windows is not None:
                x0, y0, x1, y1 = np.maximum(windows[v], 0)
                inside = np.zeros_like(picture)
                inside[y0:y1, x0:x1] = True
                left = np.where(inside, left, 0)
            maps.append(left)
        return ReferenceWeights(tuple(maps), np.array(constants, np.int64), self._sizes)

    def energies(
        self, weights: ReferenceWeights, poses: np.ndarray, segments: Sequence[int] | None = None
    ) -> np.ndarray:
        """(N, V) int64 energies of poses (N, D) or (N, V, D), of all or the given segments."""
        check_weights(weights, ReferenceWeights, self._sizes)
        poses = np.asarray(poses, float)
        energies = np.empty((len(poses), len(self.cameras)), np.int64)
        for row, pose in zip(energies, poses, strict=True):
            for v, picture in enumerate(self.silhouettes(pose, segments)):
                row[v] = weights.constants[v] + weights.maps[v][picture].sum()
        return energies

    def silhouettes(
        self, pose: np.ndarray, segments: Sequence[int] | None = None
    ) -> tuple[np.ndarray, ...]:
        """V boolean pictures (H, W), True where the body covers the pixel's centre."""
        chosen = self._chosen(segments)
        pictures = []
        for view, camera in enumerate(self.cameras):
            width, height = camera.size
            picture = np.zeros((height, width), bool)
            for corners in self._snapped_triangles(pose, view, chosen):
                rows, columns, covered = covered_pixels(corners, (height, width))
                picture[rows, columns] |= covered
            pictures.append(picture)
        return tuple(pictures)

    def outline(
        self, pose: np.ndarray, segments: Sequence[int] | None = None, spacing_px: float = 1.0
    ) -> tuple[Outline, ...]:
        """V outlines of what the segments cover, in steps of at most ``spacing_px``."""
        chosen = self._chosen(segments)
        pictures = self.silhouettes(pose, chosen)
        posed = Posed(self.body, self.level, pose, chosen)
        return find_outlines(posed, self.cameras, pictures, spacing_px)

    def bounds(self, poses: np.ndarray, segments: Sequence[int]) -> np.ndarray:
        """(N, V, 4) int: x0, y0, x1, y1 (exclusive), px that the segments can cover, unclipped.

        The whole guard region where a segment leaves it or comes too near.
        """
        chosen = self._chosen(segments)
        boxes = np.zeros((len(poses), len(self.cameras), 4), np.int32)
        guard = int(GUARD_PX)
        for n, pose in enumerate(np.asarray(poses, float)):
            for v in range(len(self.cameras)):
                h = np.concatenate(
                    [np.zeros((0, 3)), *(self._projected(pose, v, s) for s in chosen)]
                )
                if not (plane_distances(h) >= 0).all():
                    boxes[n, v] = -guard, -guard, guard, guard
                elif len(h):
                    px = snapped_px(h)
                    boxes[n, v] = -(-np.concatenate([px.min(axis=0), px.max(axis=0)]) // 256)
        return boxes

    def transforms(self, poses: np.ndarray) -> np.ndarray:
        """(N, J, 3, 4) world_from_joint of poses (N, D), metres."""
        return joint_transforms(self.body, poses)

    def snapped(self, pose: np.ndarray) -> np.ndarray:
        """(V, n, 2) int32 vertices in 1/256 px; the lowest int32 where one is clipped away."""
        count = len(self.body.surfaces[self.level].vertices)
        vertices = np.full((len(self.cameras), count, 2), np.iinfo(np.int32).min, np.int32)
        for v in range(len(self.cameras)):
            segments = range(len(self.body.segment_names))
            h = np.concatenate([self._projected(pose, v, s) for s in segments])
            inside = (plane_distances(h) >= 0).all(axis=1)
            vertices[v, inside] = snapped_px(h[inside])
        return vertices

    def _chosen(self, segments: Sequence[int] | None) -> Sequence[int]:
        everything = range(len(self.body.segment_names))
        return everything if segments is None else chosen_segments(self.body, segments)

    def _projected(self, pose: np.ndarray, view: int, segment: int) -> np.ndarray:
        """(n, 3) homogeneous px of a segment's vertices."""
        pose = np.asarray(pose, float)
        pose = pose if pose.ndim == 1 else pose[view]
        transforms = joint_transforms(self.body, pose[None])[0]
        surface = self.body.surfaces[self.level]
        vertices, carried = posed_segment(self.body, surface, transforms, segment)
        return homogeneous_px(self.cameras[view].projection, carried, vertices)

    def _snapped_triangles(self, pose: np.ndarray, view: int, segments: Sequence[int]):
        """Yields (3, 2) int64 triangles, clipped where they leave the region that can be drawn."""
        surface = self.body.surfaces[self.level]
        for segment in segments:
            h = self._projected(pose, view, segment)
            inside = (plane_distances(h) >= 0).all(axis=1)
            begin, end = surface.triangle_starts[segment : segment + 2]
            for triangle in surface.triangles[begin:end] - surface.vertex_starts[segment]:
                whole = inside[triangle].all()
                polygon = snapped_px(h[triangle] if whole else clipped_polygon(h[triangle]))
                for i in range(1, len(polygon) - 1):
                    yield polygon[[0, i, i + 1]]
