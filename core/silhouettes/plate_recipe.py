"""How the plate of each camera is made when nobody filmed the empty scene.

A TOML file with a table per camera, whose paths are relative to it:

.. code-block:: toml

    [cam01]
    still = "stills/cam01.png"             # the same view with the performer elsewhere
    box = [358, 303, 923, 1295]            # where the still is needed; left, top, right, bottom px
    still_boxes = [[110, 248, 361, 992]]   # where the still shows the performer
    patches = [{ box = [600, 400, 860, 570], frames = [82, 86] }]   # frames that show it empty
"""

from dataclasses import dataclass
from pathlib import Path

from ..errors import MocapError
from ..toml import read_toml

Box = tuple[int, int, int, int]


@dataclass(frozen=True)
class Patch:
    """Frames in which the performer has left a part of the picture.

    Attributes:
        box: (left, top, right, bottom) in footage px, the latter two exclusive.
        frames: first and last frame, inclusive.
    """

    box: Box
    frames: tuple[int, int]


@dataclass(frozen=True)
class PlateRecipe:
    """Helps for the plate of one camera.

    Attributes:
        still: a picture of the same view with the performer elsewhere, or None.
        box: where the still is needed, in footage px; None for everywhere.
        still_boxes: where the still shows the performer, in footage px.
        patches: parts of the picture that some frames show empty.
    """

    still: Path | None = None
    box: Box | None = None
    still_boxes: tuple[Box, ...] = ()
    patches: tuple[Patch, ...] = ()


def read_plate_recipes(path: Path) -> dict[str, PlateRecipe]:
    """The recipes of ``path`` by camera name.

    Raises:
        MocapError: no such file, not TOML, or an entry that is none of a recipe's.
    """
    tables = read_toml(path)
    return {camera: _recipe(table, path, camera) for camera, table in tables.items()}


def _recipe(table, path: Path, camera: str) -> PlateRecipe:
    _expect(isinstance(table, dict), "each camera has a table of its own", path, camera)
    known = ("still", "box", "still_boxes", "patches")
    for key in table:
        _expect(key in known, f'unknown key "{key}"; known are {", ".join(known)}', path, camera)
    still = table.get("still")
    _expect(still is None or isinstance(still, str), "still is a path in quotes", path, camera)
    still_boxes = table.get("still_boxes", [])
    _expect(isinstance(still_boxes, list), "still_boxes is a list of boxes", path, camera)
    patches = table.get("patches", [])
    _expect(
        isinstance(patches, list)
        and all(isinstance(patch, dict) and set(patch) == {"box", "frames"} for patch in patches),
        "patches are a list of { box = [left, top, right, bottom], frames = [first, last] }",
        path,
        camera,
    )
    return PlateRecipe(
        still=None if still is None else path.parent / still,
        box=None if "box" not in table else _box(table["box"], path, camera),
        still_boxes=tuple(_box(box, path, camera) for box in still_boxes),
        patches=tuple(_patch(patch, path, camera) for patch in patches),
    )


def _patch(table: dict, path: Path, camera: str) -> Patch:
    frames = table["frames"]
    _expect(
        _are_numbers(frames, 2) and 0 <= frames[0] <= frames[1],
        "frames of a patch are [first, last]",
        path,
        camera,
    )
    return Patch(_box(table["box"], path, camera), tuple(frames))


def _box(value, path: Path, camera: str) -> Box:
    _expect(
        _are_numbers(value, 4) and 0 <= value[0] < value[2] and 0 <= value[1] < value[3],
        "a box is [left, top, right, bottom] in px",
        path,
        camera,
    )
    return tuple(value)


def _are_numbers(value, count: int) -> bool:
    return isinstance(value, list) and len(value) == count and all(type(n) is int for n in value)


def _expect(condition: bool, rule: str, path: Path, camera: str) -> None:
    if not condition:
        raise MocapError(rule, "see the comments of an example", file=path, camera=camera)
