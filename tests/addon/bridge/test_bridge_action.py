from dataclasses import replace

import bpy
import numpy as np
import pytest
from bl_ext.user_default.silhouette_mocap.addon.bridge.action import Keys, add_action
from bl_ext.user_default.silhouette_mocap.addon.bridge.armature import add_armature
from bl_ext.user_default.silhouette_mocap.addon.bridge.space import add_capture_space
from bl_ext.user_default.silhouette_mocap.addon.bridge.timing import scene_frames, set_rate
from bl_ext.user_default.silhouette_mocap.core.body.bones import bone_names
from bl_ext.user_default.silhouette_mocap.core.body.kinematics import chained, joint_motions
from bl_ext.user_default.silhouette_mocap.core.body.templates import template
from bl_ext.user_default.silhouette_mocap.core.motion.curves import followed


@pytest.fixture(params=["small", "performer", "sixteen_segment"])
def take(request, small_body, make_take):
    return make_take(small_body if request.param == "small" else template(request.param))


def keyed_in(take, frames=None):
    collection = bpy.context.scene.collection
    armature = add_armature(take.body, "performer", add_capture_space(collection), collection)
    motion = take.motion
    frames = motion.frames if frames is None else frames
    keys = Keys(frames, motion.pose, motion.locked, motion.keyed)
    return armature, add_action(armature, take.body, "walk", keys)


def curves_of(action):
    return list(action.layers[0].strips[0].channelbag(action.slots[0]).fcurves)


def heads(armature, take):
    bones = [armature.pose.bones[name] for name in bone_names(take.body)]
    return np.array([armature.matrix_world @ bone.head for bone in bones])


def test_bones_stand_at_the_joints_in_every_frame(take):
    armature, _ = keyed_in(take)
    for frame, joints in zip(take.motion.frames, take.motion.joints, strict=True):
        bpy.context.scene.frame_set(int(frame))
        assert np.abs(heads(armature, take) - joints).max() < 1e-5


def test_quaternions_keep_their_sign_over_more_than_a_whole_turn(take):
    _, action = keyed_in(take)
    rotations = [c for c in curves_of(action) if "rotation_quaternion" in c.data_path]
    for bone in range(0, len(rotations), 4):
        columns = [[key.co.y for key in c.keyframe_points] for c in rotations[bone : bone + 4]]
        quaternions = np.transpose(columns)
        assert (np.sum(quaternions[1:] * quaternions[:-1], axis=1) > 0).all()
        assert np.allclose(np.linalg.norm(quaternions, axis=1), 1, atol=1e-5)


def test_only_the_root_travels_and_all_keys_are_linear(take):
    _, action = keyed_in(take)
    moved = {c.data_path for c in curves_of(action) if c.data_path.endswith("location")}
    assert moved == {'pose.bones["root"].location'}
    kinds = {key.interpolation for c in curves_of(action) for key in c.keyframe_points}
    assert kinds == {"LINEAR"}


def test_locked_frames_are_extremes(take):
    _, action = keyed_in(take)
    kinds = [key.type for key in curves_of(action)[0].keyframe_points]
    assert [i for i, kind in enumerate(kinds) if kind == "EXTREME"] == [2]
    assert set(kinds) == {"EXTREME", "KEYFRAME"}


def test_a_second_take_is_a_second_action_and_the_first_is_kept(small_body, make_take):
    take = make_take(small_body)
    armature, first = keyed_in(take)
    motion = take.motion
    keys = Keys(motion.frames, motion.pose, motion.locked, motion.keyed)
    second = add_action(armature, small_body, "walk", keys)
    assert armature.animation_data.action == second != first
    assert armature.animation_data.action_slot.name_display == "performer"
    assert first.use_fake_user


def test_keys_fall_between_frames_where_the_scene_has_another_rate(small_body, make_take):
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = 24, 1.0
    take = make_take(small_body, frames=range(10), fps=(15, 1))
    armature, _ = keyed_in(take, scene_frames(scene, take.motion.frames, take.motion.rate))
    assert (scene.render.fps, scene.render.fps_base) == (24, 1.0)
    scene.frame_set(11, subframe=0.2)  # 7 / 15 s
    assert np.abs(heads(armature, take) - take.motion.joints[7]).max() < 1e-5


@pytest.mark.parametrize("rate", [(15, 1), (24, 1)])
def test_reduced_keys_give_the_curves_that_core_reckons_with(take, rate):
    motion = take.motion
    joints, count = len(take.body.parents), len(motion.frames)
    keyed = np.random.default_rng(2).random((count, joints)) < 0.4
    keyed[[0, -1]] = True
    keyed[:, 1] = True
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = rate
    frames = scene_frames(scene, motion.frames, motion.rate)
    armature, action = keyed_in(replace(take, motion=replace(motion, keyed=keyed)), frames)
    counts = {c.data_path: len(c.keyframe_points) for c in curves_of(action)}
    for joint, bone in enumerate(bone_names(take.body)):
        assert counts[f'pose.bones["{bone}"].rotation_quaternion'] == keyed[:, joint].sum()
    motions = joint_motions(take.body, motion.pose)
    for joint in range(joints):
        keys = np.flatnonzero(keyed[:, joint])
        motions[:, joint] = followed(motions[:, joint], keys)
    expected = chained(take.body, motions)[..., 3]
    assert np.abs(expected - motion.joints).max() > 1e-3
    for frame, joints in zip(frames, expected, strict=True):
        scene.frame_set(int(frame), subframe=float(frame % 1))
        assert np.abs(heads(armature, take) - joints).max() < 2e-5


@pytest.mark.parametrize("rate", [(25, 1), (30000, 1001), (25, 2), (119.88 * 100, 100)])
def test_a_scene_made_for_a_take_gets_its_rate_and_frames_agree(rate):
    from fractions import Fraction

    scene = bpy.context.scene
    wanted = Fraction(int(rate[0]), rate[1])
    set_rate(scene, wanted)
    assert scene.render.fps / scene.render.fps_base == pytest.approx(float(wanted), rel=1e-6)
    assert np.array_equal(scene_frames(scene, np.array([0, 17, 3000]), wanted), [0, 17, 3000])
