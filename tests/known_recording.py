"""A recording of a body of ours, made without files."""

from collections.abc import Callable
from fractions import Fraction
from functools import cache

import numpy as np
from silhouette_mocap.core.bench.disturbances.recording import Recording
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.motion.point_track import PointTrack
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import dof_values, filmed, small_body, small_studio

FRAMES = 10


@cache
def known_poses() -> np.ndarray:
    """(FRAMES, D) of ``sixteen_segment``: sideways, the forearms rising."""
    body = small_body("sixteen_segment")
    return np.stack(
        [
            dof_values(
                body, root_x=0.03 * k, left_elbow_flexion=0.1 * k, right_elbow_flexion=0.1 * k
            )
            for k in range(FRAMES)
        ]
    )


@cache
def _pictures(cameras: int) -> Callable[[int, int], Silhouette]:
    body, studio = small_body("sixteen_segment"), small_studio(cameras)
    seen = [filmed(body, studio, pose) for pose in known_poses()]
    return lambda frame, view: Silhouette(seen[frame][view].foreground, seen[frame][view].observed)


def known_recording(cameras: int = 4, fps: int = 15) -> Recording:
    """Frames 0 to 9 before a ring of cameras of 160 x 120 px, about 33 mm per px."""
    body = small_body("sixteen_segment")
    frames = np.arange(FRAMES)
    return Recording(
        cameras=small_studio(cameras),
        frames=tuple(range(FRAMES)),
        look=_pictures(cameras),
        truth=PointTrack(POINT_NAMES, frames, points(body, known_poses()), fps=float(fps)),
        fps=Fraction(fps),
        floor=0.0,
    )
