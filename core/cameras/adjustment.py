"""Cameras for footage that is not as it was when calibrated: resized, cropped or shifted.

A resize keeps the picture's content, so pixel centres follow c' = (c + 0.5) * s - 0.5. A crop or
a shift cannot be told from sizes alone and has to be said by the user, as
``footage pixel = scale * calibrated pixel + shift`` (SPEC §9, ``adjust``). Both change only the
intrinsic matrix: the lens acts before it, on rays, and stays as calibrated.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ..errors import MocapError
from .camera import Camera


def adjusted(
    camera: Camera, scale: float, shift: tuple[float, float], size: tuple[int, int]
) -> Camera:
    """The camera of footage of ``size`` whose pixels are ``scale`` * calibrated pixel + ``shift``.

    Raises:
        ValueError: a scale that is not positive and finite, or a shift that is not finite.
    """
    if not (np.isfinite(scale) and scale > 0):
        raise ValueError(f"expected a positive scale, got {scale}")
    matrix = camera.matrix.copy()
    matrix[:2] *= scale
    matrix[:2, 2] += shift
    return replace(camera, matrix=matrix, size=size)


def observed_pixels(
    calibrated_size: tuple[int, int],
    scale: float,
    shift: tuple[float, float],
    footage_size: tuple[int, int],
) -> np.ndarray:
    """(H, W) bool: False where adjusted footage shows what the calibrated picture never held.

    Such pixels were filled in by the tool that scaled and shifted the footage. A pixel counts as
    observed where its centre falls into the area of the calibrated picture.
    """
    inside = [
        (positions >= -0.5) & (positions <= length - 0.5)
        for length, footage, offset in zip(calibrated_size, footage_size, shift, strict=True)
        for positions in [(np.arange(footage) - offset) / scale]
    ]
    return inside[1][:, None] & inside[0]


def matched_to_footage(camera: Camera, size: tuple[int, int], file: str | Path) -> Camera:
    """The camera of footage of ``size`` (width, height): itself, or resized if the aspect agrees.

    Sizes agree in aspect where one is the other times a factor, rounded to whole pixels. ``file``
    is the footage, for the message.

    Raises:
        MocapError: another aspect (turned to portrait or landscape, or cropped).
    """
    width, height = size
    if (width, height) == camera.size:
        return camera
    if _same_aspect(camera.size, size):
        return camera.scaled((width / camera.size[0], height / camera.size[1]), size)
    footage, calibrated = f"{width} x {height}", f"{camera.size[0]} x {camera.size[1]}"
    sizes = f"the footage has {footage} px, the calibration {calibrated} px"
    if _same_aspect(camera.size, (height, width)):
        raise MocapError(
            f"{sizes}: portrait and landscape are swapped",
            "turn the footage to how it was calibrated, or calibrate as it was filmed",
            file=file,
            camera=camera.name,
        )
    raise MocapError(
        f"{sizes}: another aspect",
        "tell how it was scaled and cropped with [cameras] adjust = "
        f"{{ {camera.name} = {{ scale = 1.0, shift = [0.0, 0.0] }} }} "
        "(footage pixel = scale * calibrated pixel + shift)",
        file=file,
        camera=camera.name,
    )


def _same_aspect(calibrated: tuple[int, int], footage: tuple[int, int]) -> bool:
    """Whether one is the other times a factor, the shorter side rounded by less than 1 px."""
    (w, h), (width, height) = calibrated, footage
    return abs(w * height - h * width) < max(w, h)
