"""Armatures in other .blend files, read and brought in without disturbing the open one."""

import contextlib
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...core.body.body import Body
from ...core.body.rig_file import RigFile
from ...core.errors import MocapError
from .data_blocks import taken_back
from .rig import read_rig
from .rig_mesh import followers


@dataclass(frozen=True, eq=False)
class Actor:
    """An armature with its meshes, appended to the open file, in no scene yet.

    Attributes:
        armature: the object.
        meshes: what follows it.
        metres_per_unit: the scale of the scene that it came from.
    """

    armature: bpy.types.Object
    meshes: tuple[bpy.types.Object, ...]
    metres_per_unit: float


def read_rig_file(file: RigFile) -> Body:
    """The body that an armature in a file is; see `rig.read_rig`.

    Raises:
        MocapError: no such file or armature, or it is no body.
    """
    with taken_back():
        actor = append_actor(file)
        try:
            return read_rig(actor.armature, actor.meshes, actor.metres_per_unit).body
        except MocapError as error:
            raise error.about(file.path) from error


def append_actor(file: RigFile) -> Actor:
    """The armature and its meshes, copied into the open file.

    Raises:
        MocapError: no such file or armature.
    """
    with _library(file.path) as library:
        names, metres_per_unit = _found(file, library)
        with bpy.data.libraries.load(library, link=False) as (_, wanted):
            wanted.objects = list(names)
    armature, *meshes = wanted.objects
    return Actor(armature, tuple(meshes), metres_per_unit)


@contextlib.contextmanager
def _library(path: Path) -> Iterator[str]:
    """A file that can be appended from: Blender refuses the one that is open, but not a copy."""
    if not bpy.data.filepath or Path(bpy.data.filepath).resolve() != path.resolve():
        yield str(path)
        return
    with tempfile.TemporaryDirectory() as folder:
        yield shutil.copy(path, folder)


def _found(file: RigFile, library: str) -> tuple[tuple[str, ...], float]:
    """Names of the armature and its meshes, and the scale of their scene.

    Raises:
        MocapError: no such file or armature.
    """
    try:
        armatures = _armatures(library)
    except OSError as error:
        problem = "no such file" if not file.path.exists() else "is no .blend file"
        raise MocapError(problem, "check the path", file=file.path) from error
    if file.armature not in armatures:
        held = ", ".join(sorted(armatures)) or "none"
        named = f"holds no armature {file.armature!r}" if file.armature else "names no armature"
        raise MocapError(
            f"{named}; it has: {held}", "name the armature object after the #", file=file.path
        )
    meshes, metres_per_unit = armatures[file.armature]
    return (file.armature, *meshes), metres_per_unit


def _armatures(library: str) -> dict[str, tuple[tuple[str, ...], float]]:
    """Armature's name -> names of its meshes and the scale of its scene, of all in a file.

    Nothing of it stays in memory, so that names alone may be handed out.
    """
    with bpy.data.temp_data() as inside:
        with inside.libraries.load(library, link=True) as (there, wanted):
            wanted.objects, wanted.scenes = there.objects, there.scenes
        objects = [ob for ob in wanted.objects if ob is not None]
        scenes = [scene for scene in wanted.scenes if scene is not None]
        return {
            ob.name: (tuple(mesh.name for mesh in followers(ob, objects)), _unit(ob, scenes))
            for ob in objects
            if ob.type == "ARMATURE"
        }


def _unit(armature: bpy.types.Object, scenes: list[bpy.types.Scene]) -> float:
    """Metres that a unit is long where the armature is."""
    own = (scene.unit_settings for scene in scenes if armature.name in scene.objects)
    units = next(own, None)
    return 1.0 if units is None or units.system == "NONE" else units.scale_length
