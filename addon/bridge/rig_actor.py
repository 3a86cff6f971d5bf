"""A user's rig in the scene of a take, its own bones keyed."""

import bpy
import numpy as np
from mathutils import Matrix

from ...core.motion.export_request import ExportRequest
from .action import Keys
from .rig import read_rig
from .rig_action import add_rig_action
from .rig_file import Actor, append_actor


def add_actor(
    take: ExportRequest, keys: Keys, space: bpy.types.Object, collection: bpy.types.Collection
) -> Actor:
    """The take's rig under ``space``, in metres, with the take's action.

    The armature's origin and axes are those of the space: where it stood in its own file, the root
    bone takes it away from.

    Raises:
        MocapError: the file or armature is gone, or changed since the take was fitted.
    """
    assert take.rig is not None
    actor = append_actor(take.rig)
    rig = read_rig(actor.armature, actor.meshes, actor.metres_per_unit).resized(take.body)
    scale = np.cbrt(np.linalg.det(rig.metres_from_armature[:3, :3]))
    metres = np.diag([scale, scale, scale, 1.0])
    _place(actor, Matrix(metres), space, collection)
    armature = actor.armature
    armature.data.pose_position = "POSE"
    if armature.animation_data:
        armature.animation_data.use_nla = False
    add_rig_action(armature, rig, metres, take.name, keys)
    return actor


def _place(
    actor: Actor, metres: Matrix, space: bpy.types.Object, collection: bpy.types.Collection
) -> None:
    """Puts the armature at ``metres`` in the ``space``, and what follows it where it follows."""
    own = (actor.armature, *actor.meshes)
    for ob in own:
        collection.objects.link(ob)
    scene = next(s for s in bpy.data.scenes if collection in s.collection.children_recursive)
    layer = scene.view_layers[0]
    layer.update()
    carry = metres @ actor.armature.matrix_world.inverted()
    placed = {ob: carry @ ob.matrix_world for ob in own if ob.parent not in own}
    for ob, matrix in placed.items():
        ob.parent, ob.parent_type = space, "OBJECT"
        ob.matrix_parent_inverse = Matrix()
        ob.matrix_basis = matrix
    layer.update()
