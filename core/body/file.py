"""body.npz: a whole body as plain arrays, nothing pickled.

Lists of lists (cones, parts) are stored end to end with their starts, as in CSR matrices.
"""

from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

import numpy as np

from ..errors import MocapError
from ..geometry.archive import read_archive, write_archive
from .body import POINT_NAMES, Body, Dofs, Part, Skin, Surface

VERSION = 1

ARRAYS = ("parents", "offsets", "tails", "segment_joints", "point_joints", "point_offsets")
DOF_ARRAYS = ("joints", "kinds", "axes", "limits", "rest_spread")
SURFACE_ARRAYS = ("vertices", "triangles", "vertex_starts", "triangle_starts")
PART_LISTS = ("dofs", "grid", "segments")
_DISTANCE = "outline_distance"


def write_body(path: Path, body: Body) -> None:
    """Writes ``body`` whole or not at all."""
    write_archive(path, version=VERSION, **_packed(body))


def _packed(body: Body) -> dict[str, np.ndarray]:
    cones = [body.cones[joint] for joint in body.cones]
    values = {
        "name": body.name,
        "joint_names": body.joint_names,
        "segment_names": body.segment_names,
        "dof_names": body.dofs.names,
        "dof_directions": body.dofs.directions,
        "cone_joints": np.array(list(body.cones), np.int32),
        "cone_starts": _starts(cones),
        "cone_corners": np.concatenate([*cones, np.zeros((0, 2))]),
        "levels": len(body.surfaces),
        "point_names": body.point_names,
        "part_names": [part.name for part in body.parts],
        "part_roles": [part.role for part in body.parts],
    }
    values |= {name: getattr(body, name) for name in ARRAYS}
    values |= {f"dof_{name}": getattr(body.dofs, name) for name in DOF_ARRAYS}
    for level, surface in enumerate(body.surfaces):
        values |= {f"surface_{level}_{name}": getattr(surface, name) for name in SURFACE_ARRAYS}
        values[f"surface_{level}_{_DISTANCE}"] = surface.outline_distance
        if surface.skin is not None:
            values[f"surface_{level}_skin_joints"] = surface.skin.joints
            values[f"surface_{level}_skin_weights"] = surface.skin.weights
    for name in PART_LISTS:
        lists = [getattr(part, name) for part in body.parts]
        values[f"part_{name}"] = np.array([i for indices in lists for i in indices], np.int32)
        values[f"part_{name}_starts"] = _starts(lists)
    return {name: np.asarray(value) for name, value in values.items()}


def _starts(lists: Iterable) -> np.ndarray:
    return np.cumsum([0, *map(len, lists)]).astype(np.int32)


def read_body(path: Path) -> Body:
    """The body stored in ``path``.

    Raises:
        MocapError: no such file, not a body file, one of another version, or a damaged one.
    """
    remedy = "give the body.npz that fit or initialise wrote"
    stored = read_archive(path, "body.npz", remedy)
    if "version" not in stored or "dof_names" not in stored:
        raise MocapError("is no body file", remedy, file=path)
    if stored["version"] != VERSION:
        raise MocapError(
            f"is a body file of version {stored['version']}, not {VERSION}",
            "write it again",
            file=path,
        )
    try:
        return _unpacked(stored)
    except (KeyError, ValueError, IndexError) as error:
        raise MocapError(f"is a damaged body file ({error})", remedy, file=path) from error


def _unpacked(stored: dict[str, np.ndarray]) -> Body:
    corners = _lists(stored["cone_corners"], stored["cone_starts"])
    return Body(
        name=str(stored["name"]),
        joint_names=_texts(stored["joint_names"]),
        dofs=Dofs(
            names=_texts(stored["dof_names"]),
            directions=_texts(stored["dof_directions"]),
            **{name: stored[f"dof_{name}"] for name in DOF_ARRAYS},
        ),
        cones=dict(zip(stored["cone_joints"].tolist(), corners, strict=True)),
        segment_names=_texts(stored["segment_names"]),
        surfaces=tuple(_surface(stored, level) for level in range(int(stored["levels"]))),
        parts=_parts(stored),
        # files of old have a person's
        point_names=_texts(stored.get("point_names", np.array(POINT_NAMES))),
        **{name: stored[name] for name in ARRAYS},
    )


def _surface(stored: dict[str, np.ndarray], level: int) -> Surface:
    arrays = {name: stored[f"surface_{level}_{name}"] for name in SURFACE_ARRAYS}
    # files of old do not tell it, and were fitted with the coarsest surface
    distance = float(stored.get(f"surface_{level}_{_DISTANCE}", 0))
    skin = None
    if f"surface_{level}_skin_joints" in stored:
        joints, weights = (stored[f"surface_{level}_skin_{name}"] for name in ("joints", "weights"))
        skin = Skin(joints, weights)
    return Surface(**arrays, outline_distance=distance, skin=skin)


def _parts(stored: dict[str, np.ndarray]) -> tuple[Part, ...]:
    columns = [
        [tuple(x.tolist()) for x in _lists(stored[f"part_{n}"], stored[f"part_{n}_starts"])]
        for n in PART_LISTS
    ]
    names, roles = _texts(stored["part_names"]), _texts(stored["part_roles"])
    return tuple(Part(*row) for row in zip(names, roles, *columns, strict=True))


def _lists(values: np.ndarray, starts: np.ndarray) -> list[np.ndarray]:
    return [values[a:b] for a, b in pairwise(starts)]


def _texts(values: np.ndarray) -> tuple[str, ...]:
    return tuple(str(text) for text in values)
