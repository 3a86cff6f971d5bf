"""The studios of the two multi-camera seed papers, as cameras without distortion.

T (Theobalt et al. 2003) films with 8 cameras of 320 x 240 at 15 fps, at about equal angles. M (the
Monte Carlo filter) films with 6 cameras of 640 x 480 at 60 Hz: three at mid height, 120° apart,
and three elevated by 45° and turned by 60° against them. Distances and focal lengths are not in
print: ours let a standing performer with a raised arm fill most of the picture.
"""

from dataclasses import dataclass

import numpy as np

from .camera import Camera


@dataclass(frozen=True, eq=False)
class Studio:
    """Cameras and the rate at which they film.

    Attributes:
        name: how it is called in menus and reports.
        cameras: named cam_01, cam_02 …
        fps: frames per second.
    """

    name: str
    cameras: tuple[Camera, ...]
    fps: float


@dataclass(frozen=True)
class Ring:
    """Cameras on a circle around the z axis that look at one target.

    Attributes:
        count: number of cameras, at equal angles.
        radius: of the circle, in m.
        heights: of the cameras above the floor in m; taken in turn.
        first_angle_deg: of the first camera, counter-clockwise seen from above, 0 along -y (the
            side that a performer in the rest pose faces).
        target: the world point in m that all look at.
        size: (width, height) in px.
        focal_px: focal length in px.
    """

    count: int
    radius: float = 4.0
    heights: tuple[float, ...] = (1.0,)
    first_angle_deg: float = 0.0
    target: tuple[float, float, float] = (0.0, 0.0, 1.0)
    size: tuple[int, int] = (640, 480)
    focal_px: float = 550.0


def look_at(position: np.ndarray, target: np.ndarray) -> np.ndarray:
    """(3, 4) camera_from_world of an upright camera at ``position`` that looks at ``target``.

    Raises:
        ValueError: both at one place, or one straight above the other (upright is undefined).
    """
    position = np.asarray(position, float)
    forward = np.asarray(target, float) - position
    right = np.cross(forward, [0.0, 0.0, 1.0])
    if np.linalg.norm(right) < 1e-9:
        raise ValueError("expected a camera that does not look straight up or down")
    axes = np.array([right, np.cross(forward, right), forward])
    rotation = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    return np.column_stack([rotation, -rotation @ position])


def ring(layout: Ring, first_number: int = 1) -> tuple[Camera, ...]:
    """The cameras of a ring, named cam_NN from ``first_number`` on."""
    width, height = layout.size
    matrix = np.array(
        [
            [layout.focal_px, 0.0, (width - 1) / 2],
            [0.0, layout.focal_px, (height - 1) / 2],
            [0.0, 0.0, 1.0],
        ]
    )
    angles = np.radians(layout.first_angle_deg + 360.0 / layout.count * np.arange(layout.count))
    return tuple(
        Camera(
            name=f"cam_{first_number + i:02d}",
            size=layout.size,
            matrix=matrix,
            camera_from_world=look_at(
                np.array(
                    [
                        layout.radius * np.sin(angle),
                        -layout.radius * np.cos(angle),
                        layout.heights[i % len(layout.heights)],
                    ]
                ),
                np.array(layout.target),
            ),
        )
        for i, angle in enumerate(angles)
    )


def studio_t() -> Studio:
    """The studio of Theobalt et al.: 8 cameras on a ring, their heights alternating.

    Cameras that face each other both look down a little, so that none is exactly opposite.
    """
    layout = Ring(8, heights=(1.5, 2.2), first_angle_deg=22.5, size=(320, 240), focal_px=275.0)
    return Studio("T", ring(layout), fps=15.0)


def studio_m() -> Studio:
    """The studio of the Monte Carlo filter: three cameras at mid height, three elevated by 45°."""
    level = Ring(3)
    half_diagonal = level.radius * np.sqrt(0.5)
    elevated = Ring(
        3,
        radius=half_diagonal,
        heights=(level.target[2] + half_diagonal,),
        first_angle_deg=60.0,
    )
    return Studio("M", ring(level) + ring(elevated, first_number=4), fps=60.0)
