"""Poses keyed onto a user's own bones, read back in Blender, against core's transforms."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
import rigs
from bl_ext.user_default.silhouette_mocap.addon.bridge.action import Keys
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig import read_rig
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig_action import add_rig_action
from bl_ext.user_default.silhouette_mocap.core.body.kinematics import (
    clamped,
    joint_transforms,
    rest_joints,
    world_vertices,
)
from bl_ext.user_default.silhouette_mocap.core.body.scaling import scaled
from bl_ext.user_default.silhouette_mocap.core.errors import MocapError
from mathutils import Matrix

MODES = ("QUATERNION", "XYZ", "ZYX", "YXZ", "AXIS_ANGLE")
FRAMES = 12


def moving(body, seed=3):
    """(T, D) poses in which every DOF moves, within its limits."""
    rng = np.random.default_rng(seed)
    time = np.arange(FRAMES)[:, None] / 8
    poses = rng.uniform(0.2, 0.8, len(body.dofs)) * np.sin(
        time * rng.uniform(0.5, 2, len(body.dofs)) + rng.uniform(0, 6, len(body.dofs))
    )
    poses[:, 3] = 2.5 * time[:, 0]
    return clamped(body, poses)


def keys_of(body, poses, keyed=None):
    joints = len(body.joint_names)
    keyed = np.ones((len(poses), joints), bool) if keyed is None else keyed
    return Keys(np.arange(len(poses)), poses, np.zeros(len(poses), bool), keyed)


def keyed_in_place(armature, rig, keys):
    return add_rig_action(armature, rig, rig.metres_from_armature, "take", keys)


def largest_gap(armature, rig, poses, placed=None):
    """Metres and radians by which bones lie elsewhere than core's joints carry them."""
    rest, transforms = rest_joints(rig.body), joint_transforms(rig.body, poses)
    outer = rig.metres_from_armature
    placed, worst = outer if placed is None else placed, 0.0
    for frame in range(len(poses)):
        bpy.context.scene.frame_set(frame)
        for bone, joint in rig.carriers.items():
            carried = np.eye(4)
            carried[:3] = transforms[frame, joint]
            carried[:3, 3] -= carried[:3, :3] @ rest[joint]
            wanted = carried @ outer @ np.array(armature.data.bones[bone].matrix_local)
            found = placed @ np.array(armature.pose.bones[bone].matrix)
            worst = max(worst, np.abs(found - wanted).max())
    return worst


@pytest.mark.parametrize("bones", ["RIGIFY", "GAME_ENGINE", "MIXAMO", "MAKEHUMAN", "DOG"])
def test_every_bone_lies_where_its_joint_carries_it(bones):
    armature = rigs.make_rig(getattr(rigs, bones))
    rig = read_rig(armature, bpy.data.objects, 1.0)
    poses = moving(rig.body)
    keyed_in_place(armature, rig, keys_of(rig.body, poses))
    assert largest_gap(armature, rig, poses) < 1e-5


@pytest.mark.parametrize("mode", MODES)
def test_bones_keep_their_rotation_mode(mode):
    armature = rigs.make_rig(rigs.RIGIFY)
    for bone in armature.pose.bones:
        bone.rotation_mode = mode
    rig = read_rig(armature, bpy.data.objects, 1.0)
    poses = moving(rig.body)
    action = add_rig_action(
        armature, rig, rig.metres_from_armature, "take", keys_of(rig.body, poses)
    )
    assert {bone.rotation_mode for bone in armature.pose.bones} == {mode}
    assert largest_gap(armature, rig, poses) < 1e-5
    curves = action.layers[0].strips[0].channelbag(action.slots[0]).fcurves
    turns = [c for c in curves if "rotation" in c.data_path and len(c.keyframe_points) > 1]
    steps = [np.abs(np.diff([key.co[1] for key in curve.keyframe_points])).max() for curve in turns]
    assert max(steps) < 1.5  # no leap of half or of a whole turn


def test_an_armature_that_is_turned_moved_and_scaled_in_centimetres():
    armature = rigs.make_rig(rigs.DOG)
    armature.matrix_world = (
        Matrix.Translation((120, -40, 7))
        @ Matrix.Rotation(0.7, 4, (1, 2, 3))
        @ Matrix.Scale(100, 4)
    )
    rig = read_rig(armature, bpy.data.objects, 0.01)
    assert np.ptp(world_vertices(rig.body, rig.body.rest_pose), axis=0).max() < 2
    poses = moving(rig.body)
    keyed_in_place(armature, rig, keys_of(rig.body, poses))
    assert largest_gap(armature, rig, poses) < 1e-5


def test_a_scaled_body_moves_an_armature_scaled_as_much():
    armature = rigs.make_rig(rigs.RIGIFY)
    rig = read_rig(armature, bpy.data.objects, 1.0)
    rig = rig.resized(scaled(rig.body, 1.13))
    assert np.allclose(rig.metres_from_armature[:3, :3], 1.13 * np.eye(3))
    poses = moving(rig.body)
    keyed_in_place(armature, rig, keys_of(rig.body, poses))
    assert largest_gap(armature, rig, poses) < 1e-5


def test_an_armature_placed_elsewhere_shows_the_performance_in_the_same_place():
    armature = rigs.make_rig(rigs.DOG)
    armature.matrix_world = Matrix.Rotation(1.2, 4, (1, 0, 2)) @ Matrix.Scale(2, 4)
    rig = read_rig(armature, bpy.data.objects, 1.0)
    placed = np.array(
        Matrix.Translation((3, 1, 2)) @ Matrix.Rotation(2, 4, "Z") @ Matrix.Scale(2, 4)
    )
    poses = moving(rig.body)
    add_rig_action(armature, rig, placed, "take", keys_of(rig.body, poses))
    assert largest_gap(armature, rig, poses, placed) < 1e-5


def test_a_body_of_another_rig_is_refused():
    armature = rigs.make_rig(rigs.DOG)
    dog = read_rig(armature, bpy.data.objects, 1.0)
    longer = dog.body.offsets.copy()
    longer[5] *= 1.1
    with pytest.raises(MocapError, match=r"another rest pose now .*fit the take anew"):
        dog.resized(replace(dog.body, offsets=longer))
    person = read_rig(rigs.make_rig(rigs.RIGIFY, "Person"), bpy.data.objects, 1.0)
    with pytest.raises(MocapError, match=r"other bones now .*fit the take anew"):
        dog.resized(person.body)


def test_bones_that_do_not_inherit_rotation_or_use_global_location_are_keyed_all_the_same():
    armature = rigs.make_rig(rigs.RIGIFY)
    for name in ("forearm.L", "thigh.R"):
        armature.data.bones[name].use_inherit_rotation = False
    armature.data.bones["spine"].use_local_location = False
    rig = read_rig(armature, bpy.data.objects, 1.0)
    poses = moving(rig.body)
    keyed_in_place(armature, rig, keys_of(rig.body, poses))
    assert largest_gap(armature, rig, poses) < 1e-5


def test_a_pose_that_the_file_was_left_in_does_not_show():
    armature = rigs.make_rig(rigs.MAKEHUMAN)
    rig = read_rig(armature, bpy.data.objects, 1.0)
    for bone in armature.pose.bones:
        bone.rotation_quaternion = (0.9, 0.3, 0.2, 0.1)
        bone.location, bone.scale = (0.02, 0.01, 0.03), (1.2, 1, 1)
    poses = moving(rig.body)
    keyed_in_place(armature, rig, keys_of(rig.body, poses))
    assert largest_gap(armature, rig, poses) < 1e-5


def test_constraints_that_would_pull_keyed_bones_elsewhere_are_muted():
    armature = rigs.make_rig(rigs.RIGIFY)
    target = bpy.data.objects.new("target", None)
    bpy.context.scene.collection.objects.link(target)
    reach = armature.pose.bones["hand.L"].constraints.new("IK")
    reach.target = target
    rig = read_rig(armature, bpy.data.objects, 1.0)
    poses = moving(rig.body)
    keyed_in_place(armature, rig, keys_of(rig.body, poses))
    assert reach.mute
    assert largest_gap(armature, rig, poses) < 1e-5


def test_a_limit_rotation_constraint_lets_every_pose_within_the_body_s_limits_pass():
    armature = rigs.make_rig(rigs.RIGIFY)
    for name, order in (("upper_arm.L", "AUTO"), ("forearm.L", "ZXY"), ("thigh.R", "XYZ")):
        rule = armature.pose.bones[name].constraints.new("LIMIT_ROTATION")
        rule.owner_space, rule.euler_order = "LOCAL", order
        for axis, (low, high) in {"x": (-1, 0.4), "y": (-0.2, 0.3), "z": (-0.5, 0.9)}.items():
            setattr(rule, f"use_limit_{axis}", True)
            setattr(rule, f"min_{axis}", low)
            setattr(rule, f"max_{axis}", high)
    rig = read_rig(armature, bpy.data.objects, 1.0)
    poses = clamped(rig.body, 3 * moving(rig.body))
    keyed_in_place(armature, rig, keys_of(rig.body, poses))
    assert largest_gap(armature, rig, poses) < 1e-5


def test_the_mesh_moves_as_core_draws_it():
    armature = rigs.make_rig(rigs.RIGIFY)
    rig = read_rig(armature, bpy.data.objects, 1.0)
    poses = moving(rig.body)
    keyed_in_place(armature, rig, keys_of(rig.body, poses))
    bpy.context.scene.frame_set(7)
    skin = bpy.data.objects["Skin"].evaluated_get(bpy.context.evaluated_depsgraph_get())
    outer = rig.metres_from_armature
    found = np.array([vertex.co for vertex in skin.data.vertices]) @ outer[:3, :3].T + outer[:3, 3]
    drawn = world_vertices(rig.body, poses[7])
    gaps = np.linalg.norm(found[:, None] - drawn[None], axis=2)
    # core has each of them, those at borders more than once
    assert gaps.min(axis=1).max() < 1e-5 and gaps.min(axis=0).max() < 1e-5


def test_reduced_keys_stay_reduced_in_quaternion_mode_and_become_all_frames_in_others():
    armature = rigs.make_rig(rigs.RIGIFY)
    armature.pose.bones["shin.L"].rotation_mode = "XYZ"
    rig = read_rig(armature, bpy.data.objects, 1.0)
    poses = moving(rig.body)
    keyed = np.zeros((FRAMES, len(rig.body.joint_names)), bool)
    keyed[[0, 5, -1]] = True
    action = add_rig_action(
        armature, rig, rig.metres_from_armature, "take", keys_of(rig.body, poses, keyed)
    )
    curves = action.layers[0].strips[0].channelbag(action.slots[0]).fcurves
    counts = {c.data_path: len(c.keyframe_points) for c in curves}
    assert counts['pose.bones["thigh.L"].rotation_quaternion'] == 3
    assert counts['pose.bones["shin.L"].rotation_euler'] == FRAMES
    assert counts['pose.bones["f_index.01.L"].rotation_quaternion'] == 1
    assert counts['pose.bones["spine"].location'] == 3


def test_a_second_action_keeps_the_first():
    armature = rigs.make_rig(rigs.DOG)
    rig = read_rig(armature, bpy.data.objects, 1.0)
    keys = keys_of(rig.body, moving(rig.body))
    first = keyed_in_place(armature, rig, keys)
    second = add_rig_action(
        armature, rig, rig.metres_from_armature, "take", replace(keys, poses=keys.poses / 2)
    )
    assert armature.animation_data.action == second != first
    assert first.use_fake_user
