"""Footage to show behind the performer, as the pinhole cameras of the take see it."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..files import made_folder
from ..footage.patterns import ends_in_frame, has_frame
from ..footage.pictures import colour_picture
from ..footage.video_writing import write_video
from ..take.views import View

FOOTAGE = "footage"
"""Folder of the videos that are written."""


def shown_footage(views: Sequence[View], last: int, fps: float, folder: Path) -> dict[str, str]:
    """Camera name -> its footage, as Blender can show it.

    That of distorting lenses is written undistorted, and folders of pictures whose names do not
    end in the frame's number are written as videos.

    Args:
        views: the cameras.
        last: the last frame that will be shown.
        fps: frames per second.
        folder: written videos go into its ``footage``.

    Returns:
        Path patterns of pictures, or videos whose first picture is frame 0.
    """
    found = {}
    for view in views:
        name = view.undistortion.camera.name
        if view.undistortion.is_identity and _can_be_shown(view.place):
            found[name] = view.place
        else:
            path = folder / FOOTAGE / f"{name}.mp4"
            _write_video(view, last, fps, path)
            found[name] = str(path)
    return found


def _can_be_shown(place: str) -> bool:
    return ends_in_frame(place) if has_frame(place) else Path(place).is_file()


def _write_video(view: View, last: int, fps: float, path: Path) -> None:
    made_folder(path.parent)
    footage, camera = view.source.footage, view.undistortion.camera
    empty = np.zeros((*camera.size[::-1], 3), np.uint8)

    def shown(frame: int) -> np.ndarray:
        if frame < footage.frames[0]:
            return empty
        return view.undistortion.undistorted(colour_picture(footage.picture(frame)))

    write_video(path, (shown(frame) for frame in range(last + 1)), fps)
