"""Where the performer stands and how tall they are, from silhouettes alone.

A vertical line through the middle of the body is seen by every camera, and the row where the
silhouette ends on top says how high up the line the body reaches.
"""

import numpy as np

from ..cameras.camera import Camera
from ..errors import MocapError
from ..silhouettes.place import main_patch, performer_centre
from ..silhouettes.silhouette import Silhouette


def body_centre(cameras: tuple[Camera, ...], silhouettes: tuple[Silhouette, ...]) -> np.ndarray:
    """(3,) world point in the middle of the performer, `silhouettes.place.performer_centre`.

    Raises:
        MocapError: fewer than two views show anything.
    """
    centre = performer_centre(cameras, silhouettes)
    if centre is None:
        shown = sum(silhouette.foreground.any() for silhouette in silhouettes)
        raise MocapError(
            f"only {shown} of {len(cameras)} views show the performer in the initial pose",
            "give other initial_pose frames or better silhouettes",
        )
    return centre


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
