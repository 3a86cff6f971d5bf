"""A body's surface as a mesh that the armature carries, segments or their skin with the bones."""

import bpy
import numpy as np

from ...core.body.body import Body, Skin, Surface
from ...core.body.bones import bone_names
from ...core.body.kinematics import rest_joints


def add_mesh(body: Body, surface: Surface, armature: bpy.types.Object) -> bpy.types.Object:
    """A new mesh object, child of ``armature``, in the armature's collections.

    Every vertex has the weight 1 in the vertex group of the bone that carries its segment, or those
    of its skin.
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
    skin = surface.skin or Skin(
        np.tile(joints[:, None], 4), np.tile([1.0, 0, 0, 0], (len(joints), 1))
    )
    _weigh(placed, skin, bone_names(body))
    placed.parent = armature
    modifier = placed.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    return placed


def _weigh(placed: bpy.types.Object, skin: Skin, names: tuple[str, ...]) -> None:
    for joint in np.unique(skin.joints[skin.weights > 0]):
        group = placed.vertex_groups.new(name=names[joint])
        weights = np.where(skin.joints == joint, skin.weights, 0).sum(axis=1)
        for weight in np.unique(weights[weights > 0]):
            group.add(np.flatnonzero(weights == weight).tolist(), float(weight), "REPLACE")
