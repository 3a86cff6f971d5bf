"""Where the performer stands and how tall they are, from silhouettes alone.

The rays through the silhouettes' centroids meet in the middle of the body; a vertical line through
that point is seen by every camera, and the row where the silhouette ends on top says how high up
the line the body reaches.
"""

import numpy as np

from ..cameras.camera import Camera
from ..errors import MocapError
from ..silhouettes.cleaning import Cleaning, cleaned
from ..silhouettes.silhouette import Silhouette

_REWEIGHTINGS = 20


def body_centre(cameras: tuple[Camera, ...], silhouettes: tuple[Silhouette, ...]) -> np.ndarray:
    """(3,) world point nearest to the rays through the silhouettes' centroids, least squares.

    Raises:
        MocapError: fewer than two views show anything.
    """
    centres, directions = [], []
    for camera, silhouette in zip(cameras, silhouettes, strict=True):
        ray = centroid_ray(camera, silhouette)
        if ray is not None:
            centres.append(camera.centre)
            directions.append(ray)
    if len(centres) < 2:
        raise MocapError(
            f"only {len(centres)} of {len(cameras)} views show the performer in the initial pose",
            "give other initial_pose frames or better silhouettes",
        )
    return _nearest_to_rays(np.array(centres), np.array(directions))


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


def standing_height(
    cameras: tuple[Camera, ...],
    silhouettes: tuple[Silhouette, ...],
    centre: np.ndarray,
    floor: float,
) -> float:
    """Height in metres of the body above the floor (z = ``floor``), the median over the views.

    A view counts if the silhouette's top lies inside its picture.

    Raises:
        MocapError: no view counts, or the body would end below the floor.
    """
    heights = []
    for camera, silhouette in zip(cameras, silhouettes, strict=True):
        span = row_span(silhouette)
        if span is None or span[0] <= 0:
            continue
        foot = camera.projection @ np.array([centre[0], centre[1], 0.0, 1.0])
        up = camera.projection[:, 2]
        row = span[0] - 0.5
        heights.append((foot[1] - row * foot[2]) / (row * up[2] - up[1]) - floor)
    if not heights:
        raise MocapError(
            "no view shows the performer's head in the initial pose",
            "set height_m under [performer]",
        )
    height = round(float(np.median(heights)), 6)
    if height <= 0:
        raise MocapError(
            f"the performer's head would be {-height:.2f} m below the floor",
            "check floor under [world], and up under [cameras]",
        )
    return height


def row_span(silhouette: Silhouette) -> tuple[int, int] | None:
    """First and last row of the silhouette's main patch, or None if it is empty."""
    rows = np.flatnonzero(main_patch(silhouette).any(axis=1))
    return (int(rows[0]), int(rows[-1])) if len(rows) else None


def main_patch(silhouette: Silhouette) -> np.ndarray:
    """(H, W) bool: the largest patch of foreground and those of at least half its size."""
    return cleaned(silhouette.foreground & silhouette.observed, Cleaning(0.5, 0.0)).mask
