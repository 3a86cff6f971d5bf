"""Poses as keys of an action.

A joint's motion turns its frame, which in the rest pose is parallel to the world. The bone's own
frame B is turned against that by the rest pose, so the bone turns by the conjugate B^T R B with R
the joint's rotation relative to its parent. Moves of a joint are told in the bone's frame too.

Where all frames are keys, they are joined by straight lines; where only some are, by Bézier curves
that go through them as core's `curves` say, with handles a third of the way to the next key.
"""

from dataclasses import dataclass

import bpy
import numpy as np

from ...core.body.body import Body, DofKind
from ...core.body.bones import bone_names
from ...core.body.kinematics import joint_motions
from ...core.motion.curves import key_slopes, quaternions


@dataclass(frozen=True, eq=False)
class Keys:
    """What is keyed.

    Attributes:
        frames: (T,) frames of the scene, whole or not.
        poses: (T, D) poses of the body.
        locked: (T,) bool; these become extremes, the others plain keyframes.
        keyed: (T, J) bool, the frames that are keys, joint by joint; the first and the last are.
    """

    frames: np.ndarray
    poses: np.ndarray
    locked: np.ndarray
    keyed: np.ndarray


def add_action(armature: bpy.types.Object, body: Body, name: str, keys: Keys) -> bpy.types.Action:
    """A new action with a slot for ``armature``, made by `add_armature` of ``body``, and assigned.

    Every bone is keyed in rotation, quaternions of one sign along time; bones of joints that move
    are keyed in location too. Earlier actions stay in the file, kept by a fake user.
    """
    action, bag = new_channels(armature, name)
    moves = joint_motions(body, keys.poses)
    moved = body.dofs.joints[body.dofs.kinds == DofKind.TRANSLATION]
    for joint, bone in enumerate(bone_names(body)):
        rest = np.array(armature.data.bones[bone].matrix_local)[:3, :3]
        group = bag.groups.new(bone)
        path = f'pose.bones["{bpy.utils.escape_identifier(bone)}"]'
        curves = {"rotation_quaternion": quaternions(rest.T @ moves[:, joint, :, :3] @ rest)}
        if joint in moved:
            curves["location"] = moves[:, joint, :, 3] @ rest
        for channel, values in curves.items():
            for index in range(values.shape[1]):
                curve = bag.fcurves.new(f"{path}.{channel}", index=index)
                curve.group = group
                key_curve(curve, keys, keys.keyed[:, joint], values[:, index])
    return action


def new_channels(
    armature: bpy.types.Object, name: str
) -> tuple[bpy.types.Action, bpy.types.ActionChannelbag]:
    """A new action, assigned to ``armature``, and where its curves go; the earlier one stays."""
    animation = armature.animation_data_create()
    if animation.action:
        animation.action.use_fake_user = True
    action = bpy.data.actions.new(name)
    slot = action.slots.new(id_type="OBJECT", name=armature.name)
    animation.action, animation.action_slot = action, slot
    strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
    return action, strip.channelbag(slot, ensure=True)


def key_curve(curve: bpy.types.FCurve, keys: Keys, keyed: np.ndarray, values: np.ndarray) -> None:
    """Adds the keys of one component (T,)."""
    frames, points = keys.frames[keyed], curve.keyframe_points
    places = np.column_stack([frames, values[keyed]])
    points.add(len(frames))
    points.foreach_set("co", places.ravel())
    joined = "LINEAR" if keyed.all() or keyed.sum() == 1 else "BEZIER"
    interpolation = _number(bpy.types.Keyframe, "interpolation", joined)
    points.foreach_set("interpolation", np.full(len(frames), interpolation, np.int32))
    plain, extreme = (_number(bpy.types.Keyframe, "type", t) for t in ("KEYFRAME", "EXTREME"))
    points.foreach_set("type", np.where(keys.locked[keyed], extreme, plain).astype(np.int32))
    if joined == "BEZIER":
        slope = key_slopes(values[:, None], np.flatnonzero(keyed))[:, 0]
        _set_handles(points, places, slope / np.gradient(keys.frames)[keyed])
    curve.update()


def _set_handles(points: bpy.types.FCurveKeyframePoints, places: np.ndarray, slope) -> None:
    """Handles a third of the way to the keys beside, so that time runs evenly between them."""
    thirds = np.diff(places[:, 0]) / 3
    free = _number(bpy.types.Keyframe, "handle_left_type", "FREE")
    reaches = {"left": -np.r_[thirds[:1], thirds], "right": np.r_[thirds, thirds[-1:]]}
    for side, reach in reaches.items():
        points.foreach_set(f"handle_{side}_type", np.full(len(slope), free, np.int32))
        handles = places + reach[:, None] * np.column_stack([np.ones_like(slope), slope])
        points.foreach_set(f"handle_{side}", handles.ravel())


def _number(owner: type, attribute: str, item: str) -> int:
    return owner.bl_rna.properties[attribute].enum_items[item].value
