"""Tracked takes as files: .blend, FBX, BVH and TRC.

Blender's own exporters write FBX and BVH, with settings that keep motion capture whole: one take,
every frame, no simplification, no leaf bones. FBX gets its unit in the file's head (FBX_SCALE_ALL),
so that no scale of 100 sits on the performer in game engines. BVH is in metres with Z up, its root
alone carries positions. A user's own rig keeps its bones, rest pose, meshes and materials.
"""

import contextlib
import io
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy

from ..core.errors import MocapError
from ..core.files import whole_file
from ..core.motion.export_request import ExportRequest
from ..core.motion.formats.trc import write_trc
from .bridge.data_blocks import taken_back
from .bridge.performance import Performance, add_performance
from .bridge.timing import set_rate

_FBX_SETTINGS = {
    "object_types": {"ARMATURE", "MESH"},
    "use_selection": False,
    "apply_scale_options": "FBX_SCALE_ALL",
    "add_leaf_bones": False,
    "mesh_smooth_type": "FACE",
    "bake_anim": True,
    "bake_anim_use_all_bones": True,
    "bake_anim_use_nla_strips": False,
    "bake_anim_use_all_actions": False,
    "bake_anim_force_startend_keying": True,
    "bake_anim_step": 1.0,
    "bake_anim_simplify_factor": 0.0,
}


def export_take(request: ExportRequest) -> tuple[Path, ...]:
    """Writes the take and returns the paths, in the order of the formats; each whole or not at all.

    Without a window (pip's bpy, ``blender -b``) an empty scene replaces what was open. In a window
    the take gets a scene beside the user's, which goes away again.

    Raises:
        MocapError: footage or a rig that cannot be opened, a folder that cannot be written, or an
            exporter that is switched off.
    """
    with _take_scene(request) as scene:
        performance = add_performance(scene, request)
        return tuple(_write(request, suffix, scene, performance) for suffix in request.formats)


@contextlib.contextmanager
def _take_scene(request: ExportRequest) -> Iterator[bpy.types.Scene]:
    """An empty scene with the rate and range of the take."""
    if bpy.app.background:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        scene = bpy.context.scene
        scene.name = request.name
        _set_time(scene, request)
        yield scene
        return
    with taken_back():
        scene = bpy.data.scenes.new(request.name)
        _set_time(scene, request)
        yield scene


def _set_time(scene: bpy.types.Scene, request: ExportRequest) -> None:
    set_rate(scene, request.motion.rate)
    scene.frame_start, scene.frame_end = (int(request.motion.frames[i]) for i in (0, -1))
    scene.frame_set(scene.frame_start)


def _write(
    request: ExportRequest, suffix: str, scene: bpy.types.Scene, performance: Performance
) -> Path:
    """Writes one format under a temporary name and gives it its own when it is whole."""
    path = request.path(suffix).absolute()
    if suffix == "trc":
        write_trc(path, request.motion)
        return path
    try:
        # standard output is read by programs, not Blender's to fill
        with whole_file(path) as partial, contextlib.redirect_stdout(io.StringIO()):
            _WRITERS[suffix](partial, scene, performance)
    except RuntimeError as error:
        reason = str(error).strip().splitlines()[-1]
        raise MocapError(f"cannot be written ({reason})", "check the folder", file=path) from error
    return path


def _write_blend(path: Path, scene: bpy.types.Scene, performance: Performance) -> None:
    if bpy.app.background:
        bpy.ops.wm.save_as_mainfile(
            filepath=str(path), copy=True, compress=True, relative_remap=True
        )
    else:
        bpy.data.libraries.write(str(path), {scene}, path_remap="RELATIVE_ALL", compress=True)


def _write_fbx(path: Path, scene: bpy.types.Scene, performance: Performance) -> None:
    _run_exporter("export_scene", "fbx", scene, performance, filepath=str(path), **_FBX_SETTINGS)


def _write_bvh(path: Path, scene: bpy.types.Scene, performance: Performance) -> None:
    settings = {
        "filepath": str(path),
        "frame_start": scene.frame_start,
        "frame_end": scene.frame_end,
        "root_transform_only": True,
        "global_scale": performance.armature.matrix_world.median_scale,
    }
    _run_exporter("export_anim", "bvh", scene, performance, **settings)


def _run_exporter(
    group: str, name: str, scene: bpy.types.Scene, performance: Performance, **settings
) -> None:
    """Runs ``bpy.ops.group.name`` on the performer in ``scene``."""
    if not hasattr(bpy.types, f"{group.upper()}_OT_{name}"):
        raise MocapError(
            f"Blender's {name.upper()} exporter is switched off",
            "switch it on under Preferences, Add-ons",
        )
    active = performance.armature
    with bpy.context.temp_override(
        scene=scene, view_layer=scene.view_layers[0], active_object=active, object=active
    ):
        getattr(getattr(bpy.ops, group), name)(**settings)


_WRITERS: dict[str, Callable[[Path, bpy.types.Scene, Performance], None]] = {
    "blend": _write_blend,
    "fbx": _write_fbx,
    "bvh": _write_bvh,
}
