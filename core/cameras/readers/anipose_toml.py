"""TOML with one table per camera: anipose, Pose2Sim, FreeMoCap, Caliscope.

All four store world to camera, OpenCV axes: ``size``, ``matrix``, ``distortions``, ``rotation``
(Rodrigues; 3 x 3 in older Caliscope files), ``translation``, and mostly ``fisheye``. The tables
stand at the top (``[cam_01]``) or, in Caliscope, under ``[cameras.N]``. A camera is called by its
``name``, else by its table. Caliscope's ``rotation_count`` turns pictures for display only: the
matrix belongs to the pictures as they are stored.
"""

import re
from pathlib import Path

from ...toml import read_toml
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

CAMERA_KEYS = ("size", "matrix", "rotation", "translation")


def recognises(content: bytes) -> bool:
    """Whether there is a table header and at least one key of a camera."""
    has_table = re.search(rb"^[ \t]*\[[^\[\],\n]+\][ \t\r]*(#.*)?$", content, re.MULTILINE)
    has_key = re.search(rb"^[ \t]*(matrix|distortions|translation)\s*=", content, re.MULTILINE)
    return bool(has_table and has_key)


def read(path: Path) -> FileContent:
    """The cameras of a TOML file; those marked ``ignore = true`` are left out with a note.

    Raises:
        MocapError: not TOML, a missing key, or a value that no camera can have.
    """
    tables = _camera_tables(path)
    ignored = [name for name, table in tables if table.get("ignore", False)]
    cameras = [
        _camera(path, name, table) for name, table in tables if not table.get("ignore", False)
    ]
    notes = [f"camera {name} is left out: the file says ignore = true" for name in ignored]
    notes += [
        f"camera {name} has rotation_count {table['rotation_count']}: its pictures are expected "
        "as they are stored, not turned"
        for name, table in tables
        if table.get("rotation_count", 0) and name not in ignored
    ]
    return FileContent(tuple(cameras), tuple(notes))


def _camera_tables(path: Path) -> list[tuple[str, dict]]:
    document = read_toml(path)
    nested = document.get("cameras")
    tables = nested if isinstance(nested, dict) else document
    return [
        (str(table.get("name", key)), table)
        for key, table in tables.items()
        if isinstance(table, dict) and any(k in table for k in CAMERA_KEYS)
    ]


def _camera(path: Path, name: str, table: dict) -> FileCamera:
    def place(key: str) -> Place:
        return Place(path, name, key)

    for key in CAMERA_KEYS:
        if key not in table:
            raise place(key).fault("is missing", "add it, or leave this camera out of the file")
    fisheye = bool(table.get("fisheye", False))
    no_lens = [0.0] * 4
    return FileCamera(
        name=name,
        size=picture_size(table["size"], place("size")),
        matrix=intrinsic_matrix(table["matrix"], place("matrix")),
        rotation=rotation_matrix(table["rotation"], place("rotation")),
        translation=numbers_of_shape(table["translation"], (3,), place("translation")),
        distortion=distortion_coefficients(
            table.get("distortions", no_lens), fisheye, place("distortions")
        ),
        fisheye=fisheye,
    )


READER = Reader("toml", "anipose / Pose2Sim / FreeMoCap / Caliscope TOML", None, recognises, read)
