"""Qualisys .qca.txt: the calibration that QTM exports as XML.

Lengths are millimetres. Focal lengths and the principal point are 1/64 px on the whole sensor; the
picture's left and top edge are subtracted. ``transform`` holds the camera's position x y z and a
rotation on whose sense sources disagree. Settled on a real file that comes with the matching
OpenCV calibration: row i of r11 … r33 is axis i of the camera (x right, y up, z backwards) in the
world, so that ``rotation = diag(1, -1, -1) @ r`` maps world to OpenCV axes and the position is the
centre. With it all centres and rotations agree to rounding; every other reading (transposed, or
without the turn of the axes) is off by a radian or more.

The lens coefficients are OpenCV's k1 k2 p1 p2 k3 as they stand. Pose2Sim divides them by 64 like
the focal length; calibrating the four cameras of its demonstration from their own checkerboard
pictures gives k1 = -0.046 … -0.064 and k2 = 0.08 … 0.19, where the file says -0.046 … -0.048 and
0.13 … 0.14: they have no unit.
"""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

from ...errors import MocapError
from .file_camera import (
    FileCamera,
    FileContent,
    Place,
    Reader,
    distortion_coefficients,
    intrinsic_matrix,
    numbers_of_shape,
    picture_size,
    rotation_matrix,
)

SUBPIXELS = 64.0
OPENCV_FROM_QUALISYS_AXES = np.diag([1.0, -1.0, -1.0])
ROTATION_KEYS = tuple(f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3))
MATRIX_KEYS = ("focalLengthU", "focalLengthV", "centerPointU", "centerPointV", "skew")
DISTORTION_KEYS = tuple(
    f"{kind}Distortion{n}"
    for kind, n in [("radial", 1), ("radial", 2), ("tangental", 1), ("tangental", 2), ("radial", 3)]
)


def recognises(content: bytes) -> bool:
    """Whether it is XML with a <calibration> whose cameras have fields of view in Qualisys' way."""
    return bool(re.search(rb"<calibration[\s>]", content)) and b"<fov_" in content


def read(path: Path) -> FileContent:
    """The active cameras of a .qca.txt file, in millimetres, called by their serial.

    Raises:
        MocapError: not XML, or a missing or impossible value.
    """
    content = path.read_bytes()
    if b"<!ENTITY" in content:
        # a few lines of them can stand for gigabytes
        raise MocapError("declares entities", "export it again from QTM", file=path)
    try:
        root = ElementTree.fromstring(content)
    except (ElementTree.ParseError, LookupError, ValueError) as error:
        # the latter two: an encoding that is unknown or cannot be read
        raise MocapError(
            f"is not complete XML ({error})", "export it again from QTM", file=path
        ) from None
    elements = list(root.iter("camera"))
    active = [element for element in elements if element.get("active", "1") != "0"]
    notes = [
        f"camera {element.get('serial')} is left out: the file marks it as inactive"
        for element in elements
        if element not in active
    ]
    return FileContent(tuple(_camera(path, element) for element in active), tuple(notes))


def _camera(path: Path, element: ElementTree.Element) -> FileCamera:
    name = element.get("serial")
    if not name:
        raise MocapError("a camera has no serial", "export it again from QTM", file=path)
    left, top, right, bottom = map(float, _field_of_view(path, name, element))
    place = Place(path, name, "intrinsic")
    fx, fy, cx, cy, skew = _attributes(path, name, element, "intrinsic", MATRIX_KEYS) / SUBPIXELS
    matrix = [[fx, skew, cx - left], [0, fy, cy - top], [0, 0, 1]]
    axes = _attributes(path, name, element, "transform", ROTATION_KEYS).reshape(3, 3)
    centre = _attributes(path, name, element, "transform", ("x", "y", "z"))
    rotation = OPENCV_FROM_QUALISYS_AXES @ rotation_matrix(axes, Place(path, name, "transform"))
    lens = _attributes(path, name, element, "intrinsic", DISTORTION_KEYS)
    return FileCamera(
        name=name,
        size=picture_size([right - left + 1, bottom - top + 1], Place(path, name, "fov_video")),
        matrix=intrinsic_matrix(matrix, place),
        rotation=rotation,
        translation=rotation @ -centre,
        distortion=distortion_coefficients(lens, False, place),
    )


def _field_of_view(path: Path, name: str, element: ElementTree.Element) -> np.ndarray:
    tag = "fov_video" if element.find("fov_video") is not None else "fov_marker"
    return _attributes(path, name, element, tag, ("left", "top", "right", "bottom"))


def _attributes(
    path: Path, name: str, element: ElementTree.Element, tag: str, keys: tuple[str, ...]
) -> np.ndarray:
    """The numbers that child ``tag`` of a camera has under ``keys``."""
    child = element.find(tag)
    if child is None:
        raise Place(path, name, f"<{tag}>").fault("is missing", "export it again from QTM")
    for key in keys:
        if key not in child.attrib:
            raise Place(path, name, f"{tag} {key}").fault("is missing", "export it again from QTM")
    return numbers_of_shape([child.get(key) for key in keys], (len(keys),), Place(path, name, tag))


READER = Reader("qca", "Qualisys .qca.txt", 0.001, recognises, read)
