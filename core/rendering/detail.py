"""Which of a body's surfaces is fine enough for the cameras, by the size of their pixels.

A coarse surface's outline lies some distance beside the finest one's. Seen by a camera that is a
part of a pixel, and of the pixels along the outline the same part changes. It may be `OUTLINE_PX`:
in the studio of Theobalt et al. (8 cameras of 320x240, `cameras.presets.studio_t`) a performer's
silhouette has 4.7 px of area for every px of its outline, so that there 2 % of the area change
when the outline moves by 0.02 * 4.7 px. Larger pictures keep the part of a pixel: of their area,
which grows faster than its outline, less changes.

Of the templates' surfaces none comes as near to that in the studio: the coarse one's distance is
0.04 px, and even the worst of views and poses, which changes 1.7 times as much as the mean, keeps
the 2 %.
"""

from collections.abc import Callable, Sequence

import numpy as np

from ..body.body import Body
from ..body.kinematics import joint_positions
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from .choice import MakeEvaluator

OUTLINE_PX = 0.094
"""Mean distance of outlines, coarse from finest, that may be: 2 % of the area at 320x240."""


def level_for(body: Body, cameras: Sequence[Camera], pose: np.ndarray) -> int:
    """The coarsest of the body's surfaces that will do for ``pose`` (D,) in all ``cameras``."""
    distances = pixels_per_metre(body, cameras, pose) * np.array(
        [surface.outline_distance for surface in body.surfaces]
    )
    fine = np.flatnonzero(distances <= OUTLINE_PX)
    return int(fine[0]) if len(fine) else len(body.surfaces) - 1


def pixels_per_metre(body: Body, cameras: Sequence[Camera], pose: np.ndarray) -> float:
    """Of the camera that shows the body in ``pose`` (D,) largest; 0 if it is behind all of them."""
    middle = joint_positions(body, pose[None])[0].mean(axis=0)
    scales = [
        camera.matrix[[0, 1], [0, 1]].max() / depth
        for camera in cameras
        if (depth := float(camera.depths(middle))) > 0
    ]
    return float(max(scales, default=0.0))


def with_level_for(
    pose: np.ndarray, make_evaluator: MakeEvaluator
) -> Callable[[Body, tuple[Camera, ...]], Evaluator]:
    """``make_evaluator`` with the surface that ``pose`` (D,) needs in the cameras it is given."""

    def make(body: Body, cameras: tuple[Camera, ...]) -> Evaluator:
        return make_evaluator(body, cameras, level_for(body, cameras, pose))

    return make


def drawn_surface(body: Body, cameras: Sequence[Camera], pose: np.ndarray) -> dict[str, float]:
    """What a report tells of the surface that `level_for` chooses."""
    level = level_for(body, cameras, pose)
    distance = body.surfaces[level].outline_distance
    return {
        "level": level,
        "levels": len(body.surfaces),
        "triangles": len(body.surfaces[level].triangles),
        "outline_distance_mm": 1000 * distance,
        "outline_distance_px": distance * pixels_per_metre(body, cameras, pose),
    }
