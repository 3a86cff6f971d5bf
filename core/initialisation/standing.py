"""Where the performer stands and how tall they are, from silhouettes alone.

The rays through the silhouettes' centroids meet in the middle of the body; a vertical line through
that point is seen by every camera, and the row where the silhouette ends on top says how high up
the line the body reaches.
"""

import numpy as np

from ..cameras.camera import Camera
from ..errors import MocapError
from ..silhouettes.silhouette import Silhouette


def body_centre(cameras: tuple[Camera, ...], silhouettes: tuple[Silhouette, ...]) -> np.ndarray:
    """(3,) world point nearest to the rays through the silhouettes' centroids, least squares.

    Raises:
        MocapError: fewer than two views show anything.
    """
    normal, right = np.zeros((3, 3)), np.zeros(3)
    views = 0
    for camera, silhouette in zip(cameras, silhouettes, strict=True):
        rows, columns = np.nonzero(silhouette.foreground & silhouette.observed)
        if not len(rows):
            continue
        views += 1
        ray = camera.rotation.T @ np.linalg.solve(camera.matrix, [columns.mean(), rows.mean(), 1.0])
        ray /= np.linalg.norm(ray)
        across = np.eye(3) - np.outer(ray, ray)
        normal += across
        right += across @ camera.centre
    if views < 2:
        raise MocapError(
            f"only {views} of {len(cameras)} views show the performer in the initial pose",
            "give other initial_pose frames or better silhouettes",
        )
    return np.linalg.solve(normal, right)


def standing_height(
    cameras: tuple[Camera, ...],
    silhouettes: tuple[Silhouette, ...],
    centre: np.ndarray,
    floor: float,
) -> float:
    """Height in metres of the body above the floor (z = ``floor``), the median over the views.

    A view counts if the silhouette's top lies inside its picture.
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
    return float(np.median(heights))


def row_span(silhouette: Silhouette) -> tuple[int, int] | None:
    """First and last row of the silhouette's px, or None if there are none."""
    rows = np.flatnonzero((silhouette.foreground & silhouette.observed).any(axis=1))
    return (int(rows[0]), int(rows[-1])) if len(rows) else None
