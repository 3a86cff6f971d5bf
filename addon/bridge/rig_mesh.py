"""The meshes that follow an armature, as they stand in its rest pose.

Modifiers are applied, the armature's own at rest, so that Mirror and Subdivision show as they do in
a render; vertex groups come out of them with their weights.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ...core.errors import MocapError


@dataclass(frozen=True, eq=False)
class RestMesh:
    """Triangles of all the meshes, and the bones that carry their n vertices.

    Attributes:
        vertices: (n, 3) world, Blender's units.
        triangles: (m, 3) indices.
        weights: bone's name -> (n,) weights, not negative, before they are made to sum up to 1.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    weights: dict[str, np.ndarray]


def followers(
    armature: bpy.types.Object, objects: Iterable[bpy.types.Object]
) -> tuple[bpy.types.Object, ...]:
    """The meshes among ``objects`` that follow the bones; not those hidden from renders."""
    meshes = (ob for ob in objects if ob.type == "MESH" and not ob.hide_render)
    return tuple(ob for ob in meshes if _is_skinned(ob, armature) or _bone_of(ob, armature))


def _is_skinned(ob: bpy.types.Object, armature: bpy.types.Object) -> bool:
    modified = any(m.type == "ARMATURE" and m.object == armature for m in ob.modifiers)
    return modified or (ob.parent == armature and ob.parent_type == "ARMATURE")


def _bone_of(ob: bpy.types.Object, armature: bpy.types.Object) -> str:
    """The bone that carries all of ``ob``; empty where none does."""
    rigid = ob.parent == armature and ob.parent_type == "BONE"
    return ob.parent_bone if rigid else ""


@contextmanager
def at_rest(
    armature: bpy.types.Object, meshes: Iterable[bpy.types.Object]
) -> Iterator[bpy.types.Depsgraph]:
    """All of them evaluated in a scene of their own, the armature at rest; then as they were."""
    before = armature.data.pose_position
    scene = bpy.data.scenes.new("Rest")
    try:
        for ob in (armature, *meshes):
            scene.collection.objects.link(ob)
        armature.data.pose_position = "REST"
        layer = scene.view_layers[0]
        with bpy.context.temp_override(scene=scene, view_layer=layer):
            yield bpy.context.evaluated_depsgraph_get()
    finally:
        armature.data.pose_position = before
        bpy.data.scenes.remove(scene)


def rest_mesh(
    armature: bpy.types.Object,
    meshes: Iterable[bpy.types.Object],
    depsgraph: bpy.types.Depsgraph,
) -> RestMesh:
    """The ``meshes`` in a ``depsgraph`` of `at_rest`, as one.

    Raises:
        MocapError: no vertex follows any bone.
    """
    deforming = {bone.name for bone in armature.data.bones if bone.use_deform}
    vertices, triangles = [np.zeros((0, 3))], [np.zeros((0, 3), int)]
    weights: list[dict[str, np.ndarray]] = []
    for ob in meshes:
        placed = ob.evaluated_get(depsgraph)
        mesh = placed.to_mesh()
        own = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", own)
        mesh.calc_loop_triangles()
        corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
        bone = _bone_of(ob, armature)
        weights.append({bone: np.ones(len(own) // 3)} if bone else _groups(ob, mesh, deforming))
        matrix = np.array(placed.matrix_world)
        triangles.append(corners.reshape(-1, 3) + sum(map(len, vertices)))
        vertices.append(own.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
        placed.to_mesh_clear()
    found = RestMesh(
        np.concatenate(vertices), np.concatenate(triangles), _joined(weights, vertices)
    )
    if not found.weights or not len(found.triangles):
        raise MocapError(
            f"no mesh follows the bones of {armature.name!r}",
            "parent one to it, with weights or to a bone, and show it in renders",
        )
    return found


def _groups(
    ob: bpy.types.Object, mesh: bpy.types.Mesh, deforming: set[str]
) -> dict[str, np.ndarray]:
    """Bone's name -> (n,) weights of a mesh's vertices."""
    names = {group.index: group.name for group in ob.vertex_groups if group.name in deforming}
    found = {name: np.zeros(len(mesh.vertices)) for name in names.values()}
    for vertex in mesh.vertices:
        for element in vertex.groups:
            if element.group in names:
                found[names[element.group]][vertex.index] = element.weight
    return {name: values for name, values in found.items() if values.any()}


def _joined(
    weights: list[dict[str, np.ndarray]], vertices: list[np.ndarray]
) -> dict[str, np.ndarray]:
    """The meshes' weights over all vertices; ``vertices`` begin with none."""
    starts = np.cumsum([len(own) for own in vertices])
    found: dict[str, np.ndarray] = {}
    for own, begin in zip(weights, starts, strict=False):
        for name, values in own.items():
            whole = found.setdefault(name, np.zeros(starts[-1]))
            whole[begin : begin + len(values)] = values
    return found
