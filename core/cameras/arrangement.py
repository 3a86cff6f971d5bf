"""Questions about how cameras stand to each other and to the performer."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from .camera import Camera

OPPOSITE_DEG = 170.0


def opposite_pairs(cameras: Sequence[Camera]) -> list[tuple[str, str]]:
    """Pairs of names whose viewing directions are more than 170° apart.

    Such cameras see nearly mirrored silhouettes: the second adds almost nothing (SPEC §2).
    """
    limit = np.cos(np.radians(OPPOSITE_DEG))
    return [
        (first.name, second.name)
        for first, second in combinations(cameras, 2)
        if first.rotation[2] @ second.rotation[2] < limit
    ]


def millimetres_per_pixel(camera: Camera, point: np.ndarray) -> float:
    """How many millimetres one pixel spans at a world point (3,), near the picture's centre.

    Raises:
        ValueError: a point that is not in front of the camera.
    """
    depth = float(camera.depths(np.asarray(point, float)))
    if depth <= 0:
        raise ValueError(f"expected a point in front of camera {camera.name}, got depth {depth}")
    return 1000.0 * depth / float(np.sqrt(camera.matrix[0, 0] * camera.matrix[1, 1]))
