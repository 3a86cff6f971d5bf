"""Poses of a rig as keys of the user's own bones, each in its own rotation mode.

A joint carries its bones from where they are at rest by C, told in the armature's space. A bone
whose own C is not that of its parent is keyed: with B its rest matrix and C' its parent's,

    matrix_basis = B^-1 C'^-1 C B.

Bones that keep their place get one key of it at the beginning, lest they show a pose that the file
was left in. Constraints other than Limit Rotation would pull keyed bones elsewhere; they are muted.
Bones above the root carry the whole performance and are left alone.
"""

import bpy
import numpy as np
from mathutils import Matrix

from ...core.body.kinematics import joint_transforms, rest_joints
from ...core.motion.curves import quaternions
from .action import Keys, key_curve, new_channels
from .rig import Rig

_TOO_SMALL = 1e-9


def add_rig_action(
    armature: bpy.types.Object, rig: Rig, metres: np.ndarray, name: str, keys: Keys
) -> bpy.types.Action:
    """A new action with a slot for ``armature``, and assigned; earlier actions stay in the file.

    Args:
        armature: the one that ``rig`` was read from, or a copy.
        rig: its body and bones.
        metres: (4, 4) from the armature's space to the world of the take, as the armature is
            placed; of the same scale as ``rig.metres_from_armature``.
        name: the action's.
        keys: what is keyed.
    """
    action, bag = new_channels(armature, name)
    carried = _carried(rig, metres, keys.poses)
    always, once = np.ones(len(keys.frames), bool), np.arange(len(keys.frames)) == 0
    for bone in armature.pose.bones:
        joint = rig.carriers.get(bone.name)
        if joint is None:
            continue
        above = rig.carriers.get(bone.parent.name) if bone.parent else None
        keyed, basis = once, np.broadcast_to(np.eye(4), (len(keys.frames), 4, 4))
        if joint != above:
            still = np.eye(4)[None].repeat(len(basis), axis=0)
            basis = _basis(bone.bone, carried[joint], still if above is None else carried[above])
            keyed = keys.keyed[:, joint] if bone.rotation_mode == "QUATERNION" else always
            _mute(bone)
        bone.scale = (1.0, 1.0, 1.0)
        group = bag.groups.new(bone.name)
        path = f'pose.bones["{bpy.utils.escape_identifier(bone.name)}"]'
        rotation = _rotation(bone, basis[:, :3, :3])
        shifted = keyed if above is None else once
        for (channel, values), when in zip(
            (rotation, ("location", basis[:, :3, 3])), (keyed, shifted), strict=True
        ):
            for index in range(values.shape[1]):
                curve = bag.fcurves.new(f"{path}.{channel}", index=index)
                curve.group = group
                key_curve(curve, keys, when, values[:, index])
    return action


def _carried(rig: Rig, metres: np.ndarray, poses: np.ndarray) -> list[np.ndarray]:
    """J arrays (T, 4, 4) by which the joints carry their bones, in the armature's space."""
    transforms, rest = joint_transforms(rig.body, poses), rest_joints(rig.body)
    inner, found = np.linalg.inv(metres), []
    for joint, place in enumerate(rest):
        moved = np.broadcast_to(np.eye(4), (len(poses), 4, 4)).copy()
        moved[:, :3] = transforms[:, joint]
        moved[:, :3, 3] -= transforms[:, joint, :, :3] @ place
        found.append(inner @ moved @ rig.metres_from_armature)
    return found


def _basis(bone: bpy.types.Bone, own: np.ndarray, above: np.ndarray) -> np.ndarray:
    """(T, 4, 4) what the bone adds to its rest pose."""
    rest = np.array(bone.matrix_local)
    if bone.use_inherit_rotation and bone.use_local_location:
        return np.linalg.inv(rest) @ np.linalg.inv(above) @ own @ rest
    parent = np.array(bone.parent.matrix_local) if bone.parent else np.eye(4)
    found = [
        bone.convert_local_to_pose(
            Matrix(pose), bone.matrix_local, parent_matrix=Matrix(carrier),
            parent_matrix_local=Matrix(parent), invert=True,
        )
        for pose, carrier in zip(own @ rest, above @ parent, strict=True)
    ]  # fmt: skip
    return np.array(found)


def _rotation(bone: bpy.types.PoseBone, rotations: np.ndarray) -> tuple[str, np.ndarray]:
    """Channel and values (T, k) of rotations (T, 3, 3), in the bone's own mode."""
    if bone.rotation_mode == "QUATERNION":
        return "rotation_quaternion", quaternions(rotations)
    if bone.rotation_mode == "AXIS_ANGLE":
        return "rotation_axis_angle", _axis_angles(rotations)
    return "rotation_euler", _eulers(rotations, bone.rotation_mode)


def _axis_angles(rotations: np.ndarray) -> np.ndarray:
    """(T, 4) angles and axes without leaps; the axis of no turn is that of the frame before."""
    found, axis = [], np.array([0.0, 1.0, 0.0])
    for w, *xyz in quaternions(rotations):
        length = float(np.linalg.norm(xyz))
        axis = np.array(xyz) / length if length > _TOO_SMALL else axis
        found.append([2 * np.arctan2(length, w), *axis])
    return np.array(found)


def _eulers(rotations: np.ndarray, order: str) -> np.ndarray:
    """(T, 3) Euler angles without leaps."""
    found, before = [], None
    for rotation in rotations:
        turn = Matrix(rotation)
        before = turn.to_euler(order) if before is None else turn.to_euler(order, before)
        found.append(tuple(before))
    return np.array(found)


def _mute(bone: bpy.types.PoseBone) -> None:
    for constraint in bone.constraints:
        if constraint.type != "LIMIT_ROTATION":
            constraint.mute = True
