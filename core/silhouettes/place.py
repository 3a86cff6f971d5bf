"""Where the performer is, from silhouettes alone.

The rays through the silhouettes' centroids meet in the middle of the body. The visual hull, all
that every view shows as foreground, is the largest body that explains them (Laurentini 1994).
"""

from collections.abc import Sequence

import numpy as np

from ..cameras.camera import Camera
from .cleaning import Cleaning, cleaned
from .silhouette import Silhouette

_REWEIGHTINGS = 20


def performer_centre(
    cameras: Sequence[Camera], silhouettes: Sequence[Silhouette]
) -> np.ndarray | None:
    """(3,) world point nearest to the rays through the silhouettes' centroids.

    None where fewer than two views show anything.
    """
    centres, directions = [], []
    for camera, silhouette in zip(cameras, silhouettes, strict=True):
        ray = centroid_ray(camera, silhouette)
        if ray is not None:
            centres.append(camera.centre)
            directions.append(ray)
    if len(centres) < 2:
        return None
    return _nearest_to_rays(np.array(centres), np.array(directions))


def visual_hull(
    cameras: Sequence[Camera],
    silhouettes: Sequence[Silhouette],
    centre: np.ndarray,
    half_m: float,
    step_m: float,
) -> np.ndarray:
    """(n, 3) points of a cubic grid about ``centre`` (3,) that lie in the visual hull.

    Of four views or more that show a point, one may be wrong. Points that fewer than two views
    show, unobserved places apart, are not in it.
    """
    axis = np.arange(-half_m, half_m + step_m / 2, step_m)
    grid = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3) + centre
    shown, inside = np.zeros(len(grid), int), np.zeros(len(grid), int)
    for camera, silhouette in zip(cameras, silhouettes, strict=True):
        px = np.nan_to_num(camera.project(grid), nan=-1.0).round().astype(int)
        height, width = silhouette.foreground.shape
        within = ((px >= 0) & (px < [width, height])).all(axis=1)
        columns, rows = np.where(within[:, None], px, 0).T
        within &= silhouette.observed[rows, columns]
        shown += within
        inside += within & silhouette.foreground[rows, columns]
    return grid[(shown >= 2) & (inside >= shown - (shown >= 4))]


def centroid_ray(camera: Camera, silhouette: Silhouette) -> np.ndarray | None:
    """(3,) unit direction in the world from the camera to the silhouette's centroid.

    None where the silhouette is empty.
    """
    rows, columns = np.nonzero(main_patch(silhouette))
    if not len(rows):
        return None
    pixel = [columns.mean(), rows.mean(), 1.0]
    ray = camera.rotation.T @ np.linalg.solve(camera.matrix, pixel)
    return ray / np.linalg.norm(ray)


def _nearest_to_rays(centres: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(3,) point with the least sum of distances to rays (V, 3), by reweighted least squares.

    A sum of distances, not of squares, lets a camera that shows something else be outvoted.
    """
    across = np.eye(3) - directions[:, :, None] * directions[:, None, :]
    weights, point = np.ones(len(centres)), centres.mean(axis=0)
    for _ in range(_REWEIGHTINGS):
        weighted = weights[:, None, None] * across
        right = np.einsum("vab,vb->a", weighted, centres)
        point = np.linalg.solve(weighted.sum(axis=0), right)
        distances = np.linalg.norm(np.einsum("vab,vb->va", across, point - centres), axis=1)
        weights = 1.0 / np.maximum(distances, 1e-3)
    return np.round(point, 6)


def main_patch(silhouette: Silhouette) -> np.ndarray:
    """(H, W) bool: the largest patch of foreground and those of at least half its size."""
    return cleaned(silhouette.foreground & silhouette.observed, Cleaning(0.5, 0.0)).mask
