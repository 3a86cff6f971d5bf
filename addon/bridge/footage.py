"""Footage behind the performer, as background images of the cameras."""

from pathlib import Path

import bpy
import numpy as np

from ...core.errors import MocapError
from ...core.footage.patterns import for_frame, has_frame


def show_footage(camera: bpy.types.Object, footage: str, frames: np.ndarray) -> None:
    """Shows ``footage`` in front of nothing and behind everything, seen through ``camera``.

    Args:
        camera: a camera object in a scene of the take's rate.
        footage: a video whose first picture is frame 0, or a pattern with one ``{frame}`` field.
        frames: (T,) frames of the take, of which the pictures are shown.

    Raises:
        MocapError: the first picture or the video cannot be opened.
    """
    first, last = int(frames[0]), int(frames[-1])
    sequence = has_frame(footage)
    path = for_frame(footage, first) if sequence else Path(footage)
    background = camera.data.background_images.new()
    background.image = _opened(path, camera.name)
    background.alpha = 1.0
    background.display_depth = "BACK"
    background.frame_method = "STRETCH"
    camera.data.show_background_images = True
    user = background.image_user
    user.use_auto_refresh = True
    # Blender counts pictures from 1 at frame_start; a sequence then adds frame_offset to find the
    # number in the file name, a video to find the picture.
    user.frame_start = first
    user.frame_offset = first - 1 if sequence else first
    user.frame_duration = last - first + 1
    if sequence:
        background.image.source = "SEQUENCE"


def _opened(path: Path, camera: str) -> bpy.types.Image:
    try:
        return bpy.data.images.load(str(path), check_existing=False)
    except RuntimeError as error:
        remedy = "check the take's footage"
        raise MocapError("cannot be opened as footage", remedy, file=path, camera=camera) from error
