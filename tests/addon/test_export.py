"""Exported files, read back by Blender's importers and by a BVH reader that is not Blender's.

The truth is the forward kinematics of conftest, which share no code with the product.
"""

from dataclasses import replace

import addon_utils
import bpy
import cv2
import numpy as np
import pybvh
import pytest
from bl_ext.user_default.silhouette_mocap.addon.export import export_take
from bl_ext.user_default.silhouette_mocap.core.body.bones import bone_names
from bl_ext.user_default.silhouette_mocap.core.body.templates import template
from bl_ext.user_default.silhouette_mocap.core.cameras.camera import Camera
from bl_ext.user_default.silhouette_mocap.core.errors import MocapError
from io_scene_fbx import parse_fbx

TOLERANCE = 1e-3  # metres


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


@pytest.fixture(params=["small, 15 fps", "small, 29.97 fps", "performer", "sixteen_segment"])
def take(request, small_body, make_take):
    name, _, speed = request.param.partition(", ")
    fps = (30000, 1001) if "29.97" in speed else (15, 1)
    return make_take(small_body if name == "small" else template(name), fps=fps)


def exported(take, *formats):
    return export_take(replace(take, formats=formats))


def test_the_blend_file_opens_with_the_joints_of_the_motion(take):
    (path,) = exported(take, "blend")
    empty_scene()
    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    assert scene.name == "walk"
    assert (scene.frame_start, scene.frame_end) == (3, 22)
    rate = scene.render.fps / scene.render.fps_base
    assert rate == pytest.approx(float(take.motion.rate), rel=1e-6)
    assert largest_error(take, joints_in_scene(take)) < 1e-5


def test_the_fbx_file_gives_the_joints_of_the_motion(take):
    (path,) = exported(take, "fbx")
    empty_scene()
    bpy.ops.import_scene.fbx(filepath=str(path), anim_offset=0.0)
    # The importer sets 29.97 frames per second and then places keys as if it were 30.
    joints = joints_in_scene(take, rate=bpy.context.scene.render.fps)
    assert largest_error(take, joints) < TOLERANCE


def test_the_fbx_file_has_one_take_with_a_key_in_every_frame_and_no_further_bones(take):
    (path,) = exported(take, "fbx")
    empty_scene()
    bpy.ops.import_scene.fbx(filepath=str(path))
    (action,) = bpy.data.actions
    curves = action.layers[0].strips[0].channelbag(action.slots[0]).fcurves
    assert {len(curve.keyframe_points) for curve in curves} == {len(take.motion.frames)}
    bones = {bone.name for ob in bpy.data.armatures for bone in ob.bones}
    assert bones == set(bone_names(take.body))


def properties(path, name):
    """The values of all properties of that name in an FBX file, wherever they stand."""
    found = []

    def walk(element):
        if element.id == b"P" and element.props[0] == name:
            found.append(element.props[4:])
        for child in element.elems:
            walk(child)

    walk(parse_fbx.parse(str(path))[0])
    return found


def test_the_fbx_file_tells_its_unit_once_and_scales_no_object(small_body, make_take):
    (path,) = exported(make_take(small_body), "fbx")
    assert properties(path, b"UnitScaleFactor") == [[100.0]]  # centimetres
    assert np.allclose(properties(path, b"Lcl Scaling"), 1)


def test_the_bvh_file_gives_the_joints_of_the_motion(take):
    (path,) = exported(take, "bvh")
    empty_scene()
    first = int(take.motion.frames[0])
    bpy.ops.import_anim.bvh(filepath=str(path), axis_forward="Y", axis_up="Z", frame_start=first)
    assert largest_error(take, joints_in_scene(take)) < TOLERANCE


@pytest.mark.filterwarnings("ignore:Rest pose suggests")  # the performer bows in the first frame
def test_the_bvh_file_gives_the_joints_to_an_independent_reader(take):
    (path,) = exported(take, "bvh")
    bvh = pybvh.read_bvh_file(str(path))
    columns = [bvh.joint_names.index(name) for name in bone_names(take.body)]
    assert bvh.fps == pytest.approx(float(take.motion.rate), rel=1e-4)
    assert largest_error(take, bvh.joint_positions()[:, columns]) < TOLERANCE


def test_all_formats_come_out_together_and_nothing_else(small_body, make_take):
    take = make_take(small_body)
    paths = exported(take, "blend", "fbx", "bvh", "trc")
    assert [path.name for path in paths] == ["walk.blend", "walk.fbx", "walk.bvh", "walk.trc"]
    assert sorted(take.folder.iterdir()) == sorted(paths)


def test_a_folder_that_is_not_there_is_one_clear_line(small_body, make_take):
    take = replace(make_take(small_body), folder=make_take(small_body).folder / "missing")
    for suffix in ("blend", "fbx", "bvh", "trc"):
        with pytest.raises(
            MocapError, match=rf"walk\.{suffix}: cannot be written .*check the folder"
        ):
            exported(take, suffix)


def test_an_exporter_that_is_switched_off_is_named(small_body, make_take):
    addon_utils.disable("io_anim_bvh")
    try:
        with pytest.raises(MocapError, match="BVH exporter is switched off"):
            exported(make_take(small_body), "bvh")
    finally:
        addon_utils.enable("io_anim_bvh")


def test_the_blend_file_holds_cameras_with_footage_under_the_capture_space(
    small_body, make_take, tmp_path
):
    pictures = tmp_path / "footage"
    pictures.mkdir()
    for frame in range(3, 23):
        cv2.imwrite(str(pictures / f"{frame:04d}.png"), np.zeros((48, 64), np.uint8))
    lens, pose = [[50, 0, 32], [0, 50, 24], [0, 0, 1]], np.eye(4)[:3]
    cameras = [Camera(name, (64, 48), lens, pose) for name in ("cam01", "cam02")]
    footage = {"cam01": str(pictures / "{frame:04d}.png")}
    take = make_take(small_body, cameras=cameras, footage=footage)
    (path,) = exported(take, "blend")
    bpy.ops.wm.open_mainfile(filepath=str(path))
    space = bpy.data.objects["Capture Space"]
    assert {ob.name for ob in space.children} == {"cam01", "cam02", "walk"}
    assert bpy.context.scene.camera.name == "cam01"
    assert not bpy.data.cameras["cam02"].background_images
    (background,) = bpy.data.cameras["cam01"].background_images
    assert background.image.filepath == "//footage/0003.png"
    assert bpy.path.abspath(background.image.filepath) == str(pictures / "0003.png")


def test_exporting_prints_nothing(small_body, make_take, capfd):
    exported(make_take(small_body), "blend", "fbx", "bvh")
    assert capfd.readouterr().out == ""
