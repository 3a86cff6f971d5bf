"""A user's own rig in the exported files: its bones, its mesh, its modes, the take's motion."""

from dataclasses import replace

import bpy
import numpy as np
import pybvh
import pytest
import rigs
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig_file import read_rig_file
from bl_ext.user_default.silhouette_mocap.addon.export import export_take
from bl_ext.user_default.silhouette_mocap.core.body.kinematics import world_vertices
from bl_ext.user_default.silhouette_mocap.core.body.rig_file import RigFile
from bl_ext.user_default.silhouette_mocap.core.body.scaling import scaled
from bl_ext.user_default.silhouette_mocap.core.errors import MocapError
from mathutils import Matrix

TOLERANCE = 1e-3  # metres


def empty_scene():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


@pytest.fixture(params=["person", "dog in centimetres", "scaled person"])
def take(request, tmp_path, make_take):
    armature = rigs.make_rig(rigs.DOG if "dog" in request.param else rigs.RIGIFY)
    if "centimetres" in request.param:
        armature.matrix_world = Matrix.Translation((50, 20, 0)) @ Matrix.Rotation(1, 4, "X")
        armature.scale = (100, 100, 100)
        bpy.context.scene.unit_settings.scale_length = 0.01
    for bone in armature.pose.bones:
        bone.rotation_mode = "XYZ" if bone.name.startswith("t") else "QUATERNION"
        bone.rotation_quaternion = (0.9, 0.1, 0.3, 0.3)  # the file was left in some pose
    armature.data.pose_position = "REST"
    skin = bpy.data.objects["Skin"]
    skin.data.materials.append(bpy.data.materials.new("Cloth"))
    rig = RigFile(tmp_path / "actor.blend", "Actor")
    bpy.ops.wm.save_as_mainfile(filepath=str(rig.path))
    empty_scene()
    body = read_rig_file(rig)
    if "scaled" in request.param:
        body = scaled(body, 0.9)
    return replace(make_take(body), rig=rig)


def joints_in_scene(take):
    """(T, J - 1, 3) world heads of the bones of all joints but the first."""
    (armature,) = [ob for ob in bpy.data.objects if ob.type == "ARMATURE"]
    heads = []
    for frame in take.motion.frames:
        bpy.context.scene.frame_set(int(frame))
        bones = [armature.pose.bones[name] for name in take.body.joint_names[1:]]
        heads.append([armature.matrix_world @ bone.head for bone in bones])
    return np.array(heads)


def largest_error(take, joints):
    return np.linalg.norm(joints - take.motion.joints[:, 1:], axis=-1).max()


def test_the_blend_file_holds_the_users_rig_with_the_motion(take):
    (path,) = export_take(replace(take, formats=("blend",)))
    empty_scene()
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert largest_error(take, joints_in_scene(take)) < 1e-5
    armature = bpy.data.objects["Actor"]
    assert armature.parent == bpy.data.objects["Capture Space"]
    assert armature.animation_data.action.name == "walk"
    assert {bone.name for bone in armature.data.bones} >= {"head", "thigh.L"} & set(
        take.body.joint_names
    )
    assert armature.pose.bones["thigh.L"].rotation_mode == "XYZ"
    skin = bpy.data.objects["Skin"]
    assert [material.name for material in skin.data.materials] == ["Cloth"]
    bpy.context.scene.frame_set(9)
    posed = skin.evaluated_get(bpy.context.evaluated_depsgraph_get())
    places = np.array([posed.matrix_world @ vertex.co for vertex in posed.data.vertices])
    drawn = world_vertices(take.body, take.motion.pose[9 - take.motion.frames[0]])
    gaps = np.linalg.norm(places[:, None] - drawn[None], axis=2)
    assert gaps.min(axis=1).max() < 2e-5


def test_the_fbx_file_gives_the_users_bones_the_motion(take):
    (path,) = export_take(replace(take, formats=("fbx",)))
    empty_scene()
    bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
    assert largest_error(take, joints_in_scene(take)) < TOLERANCE


def test_the_bvh_file_gives_the_users_bones_the_motion(take):
    (path,) = export_take(replace(take, formats=("bvh",)))
    bvh = pybvh.read_bvh_file(str(path))
    columns = [bvh.joint_names.index(name) for name in take.body.joint_names[1:]]
    assert largest_error(take, bvh.joint_positions()[:, columns]) < TOLERANCE


def test_a_rig_that_is_gone_is_told(take):
    take.rig.path.unlink()
    with pytest.raises(MocapError, match=r"actor\.blend: no such file"):
        export_take(replace(take, formats=("blend",)))
