"""A body as an armature: one bone per joint.

A bone's head is the joint, its tail the end that the body names; a joint that is itself an end,
such as the top of the head, gets a short bone that goes on from its parent's.

Rolls follow one rule: the bone's Z points to the performer's front, or up where the bone itself
points to the front (feet). So X is the axis of flexion everywhere and the two sides mirror each
other, as Blender's pose tools expect.
"""

import bpy
import numpy as np
from mathutils import Vector

from ...core.body.body import Body
from ...core.body.bones import bone_names
from ...core.body.kinematics import rest_joints

END_LENGTH = 0.02
"""Metres, the bone of an end; Blender silently removes bones of no length."""

_FRONT, _UP = np.array([0.0, -1.0, 0.0]), np.array([0.0, 0.0, 1.0])


def add_armature(
    body: Body, name: str, parent: bpy.types.Object, collection: bpy.types.Collection
) -> bpy.types.Object:
    """A new armature in the rest pose of ``body``, in quaternion mode; mode and selection stay."""
    placed = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    _add_bones(placed, body)
    collection.objects.link(placed)
    placed.parent = parent
    placed.show_in_front = True
    for bone in placed.pose.bones:
        bone.rotation_mode = "QUATERNION"
    return placed


def _add_bones(placed: bpy.types.Object, body: Body) -> None:
    """Adds bones in a scene of their own, for edit mode needs one and the user's is not ours."""
    scene = bpy.data.scenes.new("Bones")
    layer = scene.view_layers[0]
    scene.collection.objects.link(placed)
    layer.objects.active = placed
    try:
        with bpy.context.temp_override(scene=scene, view_layer=layer, active_object=placed):
            bpy.ops.object.mode_set(mode="EDIT")
            _fill(placed.data.edit_bones, body)
            bpy.ops.object.mode_set(mode="OBJECT")
    finally:
        bpy.data.scenes.remove(scene)


def _fill(bones: bpy.types.ArmatureEditBones, body: Body) -> None:
    names, heads, tails = bone_names(body), rest_joints(body), _visible_tails(body)
    for joint, name in enumerate(names):
        bone = bones.new(name)
        bone.head, bone.tail = heads[joint], heads[joint] + tails[joint]
        direction = tails[joint] / np.linalg.norm(tails[joint])
        faces_front = abs(direction @ _FRONT) > np.cos(np.radians(30))
        bone.align_roll(Vector(_UP if faces_front else _FRONT))
        if body.parents[joint] >= 0:
            bone.parent = bones[names[body.parents[joint]]]


def _visible_tails(body: Body) -> np.ndarray:
    """(J, 3) tails in the joints' spaces, none of them without length."""
    tails = np.array(body.tails)
    for joint in np.flatnonzero(np.linalg.norm(tails, axis=1) < 1e-3):
        parent = body.parents[joint]
        along = tails[parent] if parent >= 0 else _UP
        tails[joint] = along * END_LENGTH / np.linalg.norm(along)
    return tails
