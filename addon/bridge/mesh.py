"""A body's surface as a mesh that the armature carries, each segment with its bone."""

import bpy
import numpy as np

from ...core.body.body import Body, Surface
from .armature import bone_names, rest_joints


def add_mesh(body: Body, surface: Surface, armature: bpy.types.Object) -> bpy.types.Object:
    """A new mesh object, child of ``armature``, in the armature's collections.

    Every vertex has the weight 1 in the vertex group of the bone that carries its segment.
    """
    data = bpy.data.meshes.new(f"{armature.name} body")
    segments = np.repeat(np.arange(len(body.segment_names)), np.diff(surface.vertex_starts))
    joints = body.segment_joints[segments]
    vertices = surface.vertices + rest_joints(body)[joints]
    data.from_pydata(vertices.tolist(), [], surface.triangles.tolist())
    data.shade_smooth()
    placed = bpy.data.objects.new(data.name, data)
    for collection in armature.users_collection:
        collection.objects.link(placed)
    _weigh(placed, joints, bone_names(body))
    placed.parent = armature
    modifier = placed.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    return placed


def _weigh(placed: bpy.types.Object, joints: np.ndarray, names: tuple[str, ...]) -> None:
    for joint in np.unique(joints):
        group = placed.vertex_groups.new(name=names[joint])
        group.add(np.flatnonzero(joints == joint).tolist(), 1.0, "REPLACE")
