"""Poses as keys of an action.

A joint's motion turns its frame, which in the rest pose is parallel to the world. The bone's own
frame B is turned against that by the rest pose, so the bone turns by the conjugate B^T R B with R
the joint's rotation relative to its parent. Moves of a joint are told in the bone's frame too.
"""

from dataclasses import dataclass

import bpy
import numpy as np
from scipy.spatial.transform import Rotation

from ...core.body.body import Body, DofKind
from ...core.body.kinematics import joint_transforms
from .armature import bone_names


@dataclass(frozen=True, eq=False)
class Keys:
    """What is keyed.

    Attributes:
        frames: (T,) frames of the scene, whole or not.
        poses: (T, D) poses of the body.
        locked: (T,) bool; these become extremes, the others plain keyframes.
    """

    frames: np.ndarray
    poses: np.ndarray
    locked: np.ndarray


def add_action(armature: bpy.types.Object, body: Body, name: str, keys: Keys) -> bpy.types.Action:
    """A new action with a slot for ``armature``, made by `add_armature` of ``body``, and assigned.

    Every bone is keyed in rotation, quaternions of one sign along time; bones of joints that move
    are keyed in location too. Earlier actions stay in the file, kept by a fake user.
    """
    animation = armature.animation_data_create()
    if animation.action:
        animation.action.use_fake_user = True
    action = bpy.data.actions.new(name)
    slot = action.slots.new(id_type="OBJECT", name=armature.name)
    animation.action, animation.action_slot = action, slot
    strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
    bag = strip.channelbag(slot, ensure=True)
    moves = _moves(body, keys.poses)
    moved = body.dofs.joints[body.dofs.kinds == DofKind.TRANSLATION]
    for joint, bone in enumerate(bone_names(body)):
        rest = np.array(armature.data.bones[bone].matrix_local)[:3, :3]
        group = bag.groups.new(bone)
        path = f'pose.bones["{bpy.utils.escape_identifier(bone)}"]'
        curves = {"rotation_quaternion": _quaternions(rest.T @ moves[:, joint, :, :3] @ rest)}
        if joint in moved:
            curves["location"] = moves[:, joint, :, 3] @ rest
        for channel, values in curves.items():
            for index, column in enumerate(values.T):
                curve = bag.fcurves.new(f"{path}.{channel}", index=index)
                curve.group = group
                _key(curve, keys, column)
    return action


def _moves(body: Body, poses: np.ndarray) -> np.ndarray:
    """(T, J, 3, 4) motion of every joint in its own space, on top of its offset."""
    world = joint_transforms(body, poses)
    moves = np.empty((len(poses), len(body.parents), 3, 4))
    for joint, parent in enumerate(body.parents):
        rotation, position = world[:, joint, :3, :3], world[:, joint, :3, 3]
        if parent >= 0:
            upright = world[:, parent, :3, :3].transpose(0, 2, 1)
            position = position - world[:, parent, :3, 3]
            position = np.einsum("tij,tj->ti", upright, position)
            rotation = upright @ rotation
        moves[:, joint, :, :3] = rotation
        moves[:, joint, :, 3] = position - body.offsets[joint]
    return moves


def _quaternions(rotations: np.ndarray) -> np.ndarray:
    """(T, 4) quaternions w x y z of (T, 3, 3), each on the side of the sphere of the one before."""
    quaternions = Rotation.from_matrix(rotations).as_quat()[:, [3, 0, 1, 2]]
    quaternions[0] *= np.copysign(1.0, quaternions[0, 0])
    turned = np.einsum("ti,ti->t", quaternions[1:], quaternions[:-1]) < 0
    quaternions[1:][np.cumsum(turned) % 2 == 1] *= -1
    return quaternions


def _key(curve: bpy.types.FCurve, keys: Keys, values: np.ndarray) -> None:
    points = curve.keyframe_points
    points.add(len(values))
    points.foreach_set("co", np.column_stack([keys.frames, values]).ravel())
    interpolation = _number(bpy.types.Keyframe, "interpolation", "LINEAR")
    points.foreach_set("interpolation", np.full(len(values), interpolation, np.int32))
    plain, extreme = (_number(bpy.types.Keyframe, "type", t) for t in ("KEYFRAME", "EXTREME"))
    points.foreach_set("type", np.where(keys.locked, extreme, plain).astype(np.int32))
    curve.update()


def _number(owner: type, attribute: str, item: str) -> int:
    return owner.bl_rna.properties[attribute].enum_items[item].value
