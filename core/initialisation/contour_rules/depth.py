"""Depth from the side, which frontal views cannot tell well.

Cameras that face each other, or stand close together, fix a joint across their views but hardly
along them, and a wrong view among few can pull it far. A view from the side shows how deep the
trunk is: its median line runs halfway between the silhouette's front and back, and the joints of
the pose lie in about the same frontal plane. That counts little, against rays that know better.
"""

from collections.abc import Sequence

import numpy as np

from .heading import Heading
from .rays import Meeting, Planes, Rays, meeting, ray
from .seen_view import SeenView

_SIDEWAYS = 0.75
"""Cosine of the angle between a view and the line through the shoulders, at least."""
_WEIGHT = 0.1
"""Of a view from the side, against 1 for a ray from the front."""
_ITERATIONS = 2


def met(views: Sequence[SeenView], heading: Heading, centre: np.ndarray, rays: Rays) -> Meeting:
    """Where frontal rays meet, with what the views from the side know."""
    sides = [view for view in views if view.upright and _is_sideways(view, heading, centre)]
    if not sides:
        return meeting(rays)
    found = meeting(rays, _frontal_planes(heading, [float(heading.front @ centre)]))
    for _ in range(_ITERATIONS):
        median = found.point + ((centre - found.point) @ heading.left) * heading.left
        depths = [d for view in sides if (d := _depth(view, heading, median)) is not None]
        found = meeting(rays, _frontal_planes(heading, depths))
    return found


def _frontal_planes(heading: Heading, depths: Sequence[float]) -> Planes:
    """Planes across the frontal direction, so far along it."""
    return Planes(np.tile(heading.front, (len(depths), 1)), np.array(depths), _WEIGHT)


def _is_sideways(view: SeenView, heading: Heading, centre: np.ndarray) -> bool:
    way = view.camera.centre - centre
    return bool(abs(way @ heading.left) >= _SIDEWAYS * np.linalg.norm(way))


def _depth(view: SeenView, heading: Heading, median: np.ndarray) -> float | None:
    """How far along the frontal direction the median line is, at the height of a point on it.

    Args:
        view: from the side.
        heading: of the performer.
        median: (3,) a point near the median line.

    None where the view shows nothing there.
    """
    assert view.upright is not None
    px = view.camera.project(median)
    across = np.array([-view.upright.up[1], view.upright.up[0]])
    steps = np.arange(-view.upright.height_px / 2, view.upright.height_px / 2, 0.5)
    columns, rows = (px[:, None] + across[:, None] * steps).round().astype(int)
    height, width = view.silhouette.foreground.shape
    within = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    filled = view.silhouette.foreground[np.where(within, rows, 0), np.where(within, columns, 0)]
    shown = steps[filled & within]
    if not len(shown):
        return None
    middle = px + across * (shown[0] + shown[-1]) / 2
    normal = np.cross(ray(view.camera, middle), ray(view.camera, middle + view.upright.up))
    # from the point along the frontal direction to the upright plane through the middle
    ahead = normal @ (view.camera.centre - median) / (normal @ heading.front)
    return float(heading.front @ median + ahead)
