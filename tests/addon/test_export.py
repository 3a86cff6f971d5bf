"""Exported files, read back by Blender's importers and by a BVH reader that is not Blender's.

The truth is the forward kinematics of conftest, which share no code with the product.
"""

import bpy
import numpy as np
import pybvh
import pytest
from bl_ext.user_default.silhouette_mocap.addon.bridge.armature import bone_names
from bl_ext.user_default.silhouette_mocap.addon.export import export_take

TOLERANCE = 1e-3  # metres
SPEEDS = [(15, 1), (30000, 1001)]


def joints_in_scene(take, rate=None):
    """(T, J, 3) world heads of the only armature's bones at the take's frames.

    With a rate, at the frames that the times of the take fall on at that many frames per second.
    """
    (armature,) = [ob for ob in bpy.data.objects if ob.type == "ARMATURE"]
    heads = []
    for frame in take.motion.frames:
        place = frame if rate is None else frame * rate / float(take.motion.rate)
        whole = int(np.floor(place + 1e-6))
        bpy.context.scene.frame_set(whole, subframe=max(0.0, place - whole))
        bones = [armature.pose.bones[name] for name in bone_names(take.body)]
        heads.append([armature.matrix_world @ bone.head for bone in bones])
    return np.array(heads)


def empty_scene():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def largest_error(take, joints):
    return np.linalg.norm(joints - take.motion.joints, axis=-1).max()


@pytest.mark.parametrize("fps", SPEEDS)
def test_the_blend_file_opens_with_the_joints_of_the_motion(small_body, make_take, fps):
    take = make_take(small_body, fps=fps, formats=("blend",))
    (path,) = export_take(take)
    empty_scene()
    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    assert scene.name == "walk"
    assert (scene.frame_start, scene.frame_end) == (3, 22)
    assert scene.render.fps / scene.render.fps_base == pytest.approx(fps[0] / fps[1], rel=1e-6)
    assert largest_error(take, joints_in_scene(take)) < 1e-5


@pytest.mark.parametrize("fps", SPEEDS)
def test_the_fbx_file_gives_the_joints_of_the_motion(small_body, make_take, fps):
    take = make_take(small_body, fps=fps, formats=("fbx",))
    (path,) = export_take(take)
    empty_scene()
    bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
    # The importer sets 29.97 frames per second and then places keys as if it were 30.
    joints = joints_in_scene(take, rate=bpy.context.scene.render.fps)
    assert largest_error(take, joints) < TOLERANCE


@pytest.mark.parametrize("fps", SPEEDS)
def test_the_bvh_file_gives_the_joints_of_the_motion(small_body, make_take, fps):
    take = make_take(small_body, fps=fps, formats=("bvh",))
    (path,) = export_take(take)
    empty_scene()
    first = int(take.motion.frames[0])
    bpy.ops.import_anim.bvh(filepath=str(path), axis_forward="Y", axis_up="Z", frame_start=first)
    assert largest_error(take, joints_in_scene(take)) < TOLERANCE


def test_the_bvh_file_gives_the_joints_to_an_independent_reader(small_body, make_take):
    take = make_take(small_body, formats=("bvh",))
    (path,) = export_take(take)
    bvh = pybvh.read_bvh_file(str(path))
    columns = [bvh.joint_names.index(name) for name in bone_names(small_body)]
    assert bvh.fps == pytest.approx(15, rel=1e-4)
    assert largest_error(take, bvh.joint_positions()[:, columns]) < TOLERANCE
