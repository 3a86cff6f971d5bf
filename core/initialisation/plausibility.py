"""Whether a first fit can be a performer; wrong units, floor or height give what cannot be."""

from pathlib import Path

import numpy as np

from ..body.body import POINT_NAMES
from ..body.kinematics import rest_height
from ..cameras.camera import Camera
from ..errors import MocapError
from .first_pose import FirstFit

HEIGHTS_M = (0.5, 2.6)
"""The shortest and the tallest performer."""
_LEAST_IOU = 0.3
_FAR_BELOW = 0.5
_REMEDY = (
    "check units and up under [cameras], floor under [world], height_m under [performer] "
    "and the frames of initial_pose"
)


def check_height(height: float, file: Path | None = None) -> None:
    """Refuses a standing height (m) that nobody has; ``file`` is the body's or the take's.

    Raises:
        MocapError: a dwarf or a giant.
    """
    lowest, highest = HEIGHTS_M
    if not lowest <= height <= highest:
        raise MocapError(
            f"the performer would be {height:.4g} m tall, not {lowest} to {highest} m",
            _REMEDY,
            file=file,
        )


def check_first_fit(first: FirstFit, cameras: tuple[Camera, ...]) -> tuple[str, ...]:
    """One note per camera that shows less than half of what the others show, by median IoU.

    Args:
        first: the fit of the initial pose.
        cameras: its V cameras.

    Raises:
        MocapError: a height that nobody has, or silhouettes that the fit does not resemble.
    """
    if first.body.point_names == POINT_NAMES:
        check_height(rest_height(first.body))
    iou = first.iou
    seen = np.flatnonzero(np.isfinite(iou))
    if not len(seen) or iou[seen].mean() < _LEAST_IOU:
        shown = f"{iou[seen].mean():.2f}" if len(seen) else "unknown"
        raise MocapError(
            f"the initial pose does not fit the silhouettes (IoU {shown}, 1 is perfect)", _REMEDY
        )
    notes = []
    for view in seen:
        others = np.median(iou[seen[seen != view]]) if len(seen) > 1 else 0.0
        if iou[view] < _FAR_BELOW * others:
            notes.append(
                f"camera {cameras[view].name} fits far worse than the others in the initial pose "
                f"(IoU {iou[view]:.2f}, theirs {others:.2f}); check its calibration and footage"
            )
    return tuple(notes)
