"""Frames all over a take that show the whole performer."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..cameras.camera import Camera
from ..errors import MocapError
from ..silhouettes.place import main_patch, performer_centre
from ..silhouettes.silhouette import Silhouette
from .standing import standing_height

Silhouettes = tuple[Silhouette, ...]
FEWEST_WHOLE = 2
"""Views that show all of the performer."""
_CUT_PX = 3
"""Of a silhouette at the edge, that do not cut the performer off."""
_WALK_S = 0.5
"""To either side of a frame, in which the performer goes some way."""
REMEDY = (
    "name frames that show the whole performer in an A-pose, a T-pose, or upper arms lifted with "
    'the forearms hanging: initial_pose = { frames = [0, 7], kind = "A" }'
)


@dataclass(frozen=True, eq=False)
class Footage:
    """What there is to look at.

    Attributes:
        cameras: V.
        look: gives what they see in a frame.
        frames: first and last that there is.
        fps: frames per second.
    """

    cameras: tuple[Camera, ...]
    look: Callable[[int], Silhouettes]
    frames: tuple[int, int]
    fps: float

    def way(self, frame: int) -> np.ndarray | None:
        """(2,) m that the performer moves about ``frame``; None where too few views show it."""
        span = max(1, round(_WALK_S * self.fps))
        ends = np.clip([frame - span, frame + span], *self.frames).tolist()
        before, after = (performer_centre(self.cameras, self.look(end)) for end in ends)
        return None if before is None or after is None else (after - before)[:2]


@dataclass(frozen=True, eq=False)
class Sighting:
    """A frame that shows the whole performer.

    Attributes:
        frame: its number.
        height_m: of the performer, as far as this frame tells.
        likely: mean confidence of the best pose so far.
        pose: (D,) that pose; empty before any was sought.
    """

    frame: int
    height_m: float
    likely: float
    pose: np.ndarray


def sightings(footage: Footage, frames: Sequence[int], floor: float) -> list[Sighting]:
    """Those of ``frames`` that show the whole performer, who stands at ``floor``, m.

    Raises:
        MocapError: there are none.
    """
    found = []
    for frame in frames:
        silhouettes = footage.look(frame)
        centre = performer_centre(footage.cameras, silhouettes)
        if centre is not None and sum(map(is_whole, silhouettes)) >= FEWEST_WHOLE:
            height = standing_height(footage.cameras, silhouettes, centre, floor)
            found.append(Sighting(frame, height, 0.0, np.zeros(0)))
    if not found:
        raise MocapError(
            "no initial pose is given, and none was found: fewer than two cameras see the whole "
            f"performer in any of {len(frames)} frames from {frames[0]} to {frames[-1]}",
            REMEDY,
        )
    return found


def is_whole(silhouette: Silhouette) -> bool:
    """Whether it shows a performer that neither the edge nor anything unobserved cuts off."""
    patch = main_patch(silhouette)
    inside = np.pad(silhouette.observed, 1).astype(np.uint8)
    inner = cv2.erode(inside, np.ones((3, 3), np.uint8))[1:-1, 1:-1].astype(bool)
    return bool(patch.any()) and np.count_nonzero(patch & ~inner) <= _CUT_PX
