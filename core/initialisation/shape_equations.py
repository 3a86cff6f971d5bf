"""Normal equations of a frame's outlines and contours in its pose and in the body's shape.

The distances are those of `fitting.contour_targets`: of outlines along the field of the observed
contour, and of contours to the nearest point of the outline that looks the same way. A point of an
outline is fixed to a segment: it moves with the pose as a joint does, and with the shape as the
segment is stretched.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator, Outline
from ..fitting.contour_descent import DescentSettings
from ..fitting.twists import Twists
from ..silhouettes.observed_contour import ObservedContour
from .shape_model import ShapeModel

_FLAT = 0.2
"""Slope of a distance field, below which it leads to no contour in particular."""


@dataclass(frozen=True, eq=False)
class Sighting:
    """What a frame shows in V views.

    Attributes:
        contours: V, their points as far apart as the outlines'.
        metres: (V,) m that a pixel is wide where the performer stands.
    """

    contours: Sequence[ObservedContour]
    metres: np.ndarray


@dataclass(frozen=True, eq=False)
class FrameEquations:
    """Sums over the distances of a frame, in standard deviations.

    Attributes:
        matrix: (D + S, D + S), of the pose and of the logarithms of the shape.
        slope: (D + S,).
        count: number of distances.
    """

    matrix: np.ndarray
    slope: np.ndarray
    count: int


@dataclass(frozen=True, eq=False)
class _Distances:
    """n distances of points on a body's outline.

    Attributes:
        views: (n,) indices.
        segments: (n,) indices.
        points: (n, 3) m, in the space of the segment's joint.
        world: (n, 3) m.
        slopes: (n, 3) of the distances with the points' places in the world.
        values: (n,) m.
    """

    views: np.ndarray
    segments: np.ndarray
    points: np.ndarray
    world: np.ndarray
    slopes: np.ndarray
    values: np.ndarray


class ShapeEquations:
    """The equations of one body.

    Args:
        model: of its shape.
        evaluator: draws it.
        settings: of points and distances.
    """

    def __init__(self, model: ShapeModel, evaluator: Evaluator, settings: DescentSettings):
        self._model, self._evaluator, self._settings = model, evaluator, settings
        self._twists = Twists(evaluator.body)

    def of(
        self, sighting: Sighting, pose: np.ndarray, trust: np.ndarray, reach_m: float
    ) -> FrameEquations:
        """The equations at a pose (D,); distances beyond ``reach_m`` count for less and less.

        Those of each view count by its ``trust`` (V,), too.
        """
        transforms, twists = self._twists.at(pose)
        distances = self._distances(sighting, pose, transforms)
        rows = self._rows(distances, transforms, twists)
        weights = trust[distances.views] / (1 + (distances.values / reach_m) ** 2) ** 2
        weights /= self._settings.deviation_m**2
        weighed = (rows * weights[:, None]).T
        return FrameEquations(weighed @ rows, weighed @ distances.values, len(rows))

    def _distances(
        self, sighting: Sighting, pose: np.ndarray, transforms: np.ndarray
    ) -> _Distances:
        spacing_px = float((self._settings.spacing_m / sighting.metres).max())
        outlines = self._evaluator.outline(pose, None, spacing_px)
        found = []
        seen = zip(
            outlines, sighting.contours, self._evaluator.cameras, sighting.metres, strict=True
        )
        for view, (outline, contour, camera, metre) in enumerate(seen):
            which, normals, px = _pairs(outline, contour, self._settings.turn_m / metre)
            segments, points = outline.segments[which], outline.points[which]
            placed = transforms[self._evaluator.body.segment_joints[segments]]
            world = (placed[:, :, :3] @ points[..., None])[..., 0] + placed[:, :, 3]
            slopes = metre * _image_slopes(camera, world, normals)
            views = np.full(len(which), view)
            found.append((views, segments, points, world, slopes, metre * px))
        return _Distances(*map(np.concatenate, zip(*found, strict=True)))

    def _rows(
        self, distances: _Distances, transforms: np.ndarray, twists: np.ndarray
    ) -> np.ndarray:
        """(n, D + S) changes of the distances with the pose and the logarithms of the shape."""
        body, slopes = self._evaluator.body, distances.slopes
        turning = np.concatenate([slopes, np.cross(distances.world, slopes)], axis=1)
        joint_rates = self._model.joint_rates(body, transforms)
        rows = np.empty((len(slopes), twists.shape[1] + len(self._model)))
        for segment in np.unique(distances.segments).tolist():
            own, joint = distances.segments == segment, body.segment_joints[segment]
            within = slopes[own] @ transforms[joint, :, :3]
            stretched = self._model.point_rates(body, segment, distances.points[own], within)
            rows[own, : twists.shape[1]] = turning[own] @ twists[joint].T
            rows[own, twists.shape[1] :] = slopes[own] @ joint_rates[joint] + stretched
        return rows


def _pairs(
    outline: Outline, contour: ObservedContour, turn_px: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Indices (n,) of points on an outline, normals (n, 2) and px (n,) of their distances."""
    if not len(outline.px) or not len(contour.px):
        return np.zeros(0, int), np.zeros((0, 2)), np.zeros(0)
    apart, slopes = contour.at(outline.px)
    steep = np.linalg.norm(slopes, axis=1)
    kept = np.flatnonzero(np.isfinite(apart) & (steep > _FLAT))
    looks = np.concatenate([outline.px, turn_px * outline.normals], axis=1)
    sought = np.concatenate([contour.px, turn_px * contour.normals], axis=1)
    nearest = KDTree(looks).query(sought)[1]
    beside = ((outline.px[nearest] - contour.px) * contour.normals).sum(axis=1)
    return (
        np.concatenate([kept, nearest]),
        np.concatenate([slopes[kept] / steep[kept, None], contour.normals]),
        np.concatenate([apart[kept], beside]),
    )


def _image_slopes(camera: Camera, world: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(n, 3) px per m that the images of places (n, 3) move along normals (n, 2)."""
    projection = camera.projection
    x, y, depth = (world @ projection[:, :3].T + projection[:, 3]).T
    along = (normals * np.stack([x / depth, y / depth], axis=1)).sum(axis=1)
    return (normals @ projection[:2, :3] - along[:, None] * projection[2, :3]) / depth[:, None]
