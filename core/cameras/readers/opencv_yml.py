"""OpenCV FileStorage in EasyMocap's pair: intri.yml with lenses, extri.yml with positions.

Per camera n: ``K_n`` and ``dist_n`` (older ``D_n``), optionally ``W_n`` and ``H_n``; ``Rot_n``
(3 x 3) or ``R_n`` (Rodrigues) and ``T_n``, world to camera, OpenCV axes. The cameras are those that
have a ``K_n``: the list ``names`` may be absent or padded with "none". Files of OpenCV in XML and
one file that holds both halves are read alike.
"""

import re
from collections import Counter
from pathlib import Path

import cv2
import numpy as np

from ...errors import MocapError
from ...files import check_ordinary
from ...toml import POINTS_NOT_COMMAS
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

LENS, POSITION = "intri", "extri"


def recognises(content: bytes) -> bool:
    """Whether OpenCV wrote it."""
    is_yaml = content.lstrip().startswith(b"%YAML") and b"opencv-matrix" in content
    return is_yaml or b"<opencv_storage>" in content


def read(path: Path) -> FileContent:
    """The cameras of a pair of files, given either of them.

    Raises:
        MocapError: the other file is missing, a file is truncated, or a camera lacks a value.
    """
    lens_file, position_file = _pair(path)
    lenses = _nodes(lens_file)
    positions = lenses if position_file == lens_file else _nodes(position_file)
    names = [key[2:] for key in lenses if key.startswith("K_")]
    listed = lenses.get("names")
    listed = listed if isinstance(listed, list) else []
    listed = [name for name in listed if name != "none"]
    placed = [key[2:] for key in positions if key.startswith("T_")]
    missing = [name for name in (*listed, *placed) if name not in names]
    if missing:
        raise Place(lens_file, missing[0], f"K_{missing[0]}").fault(
            f"is missing, though {position_file.name} has the camera",
            "add it, or leave this camera out of both files",
        )
    return FileContent(
        tuple(
            _camera(name, _Values(lens_file, name, lenses), _Values(position_file, name, positions))
            for name in names
        )
    )


class _Values:
    """The values of one camera in one file, by key."""

    def __init__(self, file: Path, camera: str, nodes: dict):
        self.file, self.camera, self.nodes = file, camera, nodes

    def get(self, *keys: str):
        """The first of the keys' values that is there, and its place; (None, place) without."""
        full = [f"{key}_{self.camera}" for key in keys]
        found = next((key for key in full if key in self.nodes), None)
        place = Place(self.file, self.camera, found or " or ".join(full))
        return (self.nodes[found] if found else None), place

    def need(self, *keys: str):
        """The same, for keys of which one has to be there."""
        value, place = self.get(*keys)
        if value is None:
            raise place.fault("is missing", "add it, or leave this camera out of both files")
        return value, place


def _camera(name: str, lens: _Values, position: _Values) -> FileCamera:
    width, _ = lens.get("W")
    height, place = lens.get("H")
    sized = width is not None and height is not None
    distortion, distortion_place = lens.need("dist", "D")
    translation, translation_place = position.need("T")
    return FileCamera(
        name=name,
        size=picture_size([width, height], place) if sized else None,
        matrix=intrinsic_matrix(*lens.need("K")),
        rotation=rotation_matrix(*position.need("Rot", "R")),
        translation=numbers_of_shape(translation, (3,), translation_place),
        distortion=distortion_coefficients(distortion, False, distortion_place),
    )


def _pair(path: Path) -> tuple[Path, Path]:
    for this, other in ((LENS, POSITION), (POSITION, LENS)):
        if this not in path.name:
            continue
        partner = path.with_name(path.name.replace(this, other))
        if not partner.exists():
            raise MocapError(
                f"its other half {partner.name} is not beside it", "put both in one folder",
                file=path,
            )  # fmt: skip
        return (path, partner) if this == LENS else (partner, path)
    return path, path


def _nodes(path: Path) -> dict[str, np.ndarray | list[str] | float]:
    """Matrices, lists of strings and numbers of a file by key."""
    try:
        check_ordinary(path)
        text = path.read_text(encoding="utf-8-sig")
        _check_one_document(text, path)
        storage = cv2.FileStorage(text, cv2.FileStorage_READ | cv2.FileStorage_MEMORY)
        root = storage.root()
        keys = root.keys()
        nodes = {key: _value(root.getNode(key)) for key in keys}
    except (cv2.error, SystemError, UnicodeDecodeError, OSError) as error:
        raise MocapError(
            "is cut short or not as OpenCV writes it",
            f"complete the file or write it again; {POINTS_NOT_COMMAS}",
            file=path,
        ) from error
    if len(nodes) < len(keys):
        key = Counter(keys).most_common(1)[0][0]
        raise MocapError(f"{key} stands in it twice", "give each camera its own name", file=path)
    return nodes


def _check_one_document(text: str, path: Path) -> None:
    """Refuses YAML with several documents, in which OpenCV may search for keys without end."""
    before, *after = re.split("^---", text, flags=re.MULTILINE)
    if len(after) > 1 or (after and re.search(r"^[^%#\s]|^[ \t]+[^\s#]", before, re.MULTILINE)):
        raise MocapError(
            'has more than "---" between its first line and the cameras', "write the file again",
            file=path,
        )  # fmt: skip


def _value(node: cv2.FileNode):
    if node.isSeq():
        items = [node.at(i) for i in range(node.size())]
        return [item.string() for item in items if item.isString()]
    return node.mat() if node.isMap() else node.real()


READER = Reader("opencv", "OpenCV / EasyMocap intri.yml + extri.yml", None, recognises, read)
