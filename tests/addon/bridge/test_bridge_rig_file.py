"""Rigs read from other .blend files."""

import bpy
import numpy as np
import pytest
import rigs
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig import read_rig
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig_file import read_rig_file
from bl_ext.user_default.silhouette_mocap.core.body.kinematics import rest_height
from bl_ext.user_default.silhouette_mocap.core.body.rig_file import RigFile
from bl_ext.user_default.silhouette_mocap.core.errors import MocapError


@pytest.fixture
def actors(tmp_path):
    """A .blend of two armatures in a scene in centimetres; the person has a material and a prop."""
    person = rigs.make_rig(rigs.RIGIFY, "Person")
    person.scale = (100, 100, 100)
    skin = bpy.data.objects["Skin"]
    skin.data.materials.append(bpy.data.materials.new("Cloth"))
    rigs.make_rig(rigs.DOG, "Dog")
    bpy.context.scene.unit_settings.scale_length = 0.01
    path = tmp_path / "actors.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return path


def held():
    """Everything in the open file, by kind and name."""
    kinds = [k.identifier for k in bpy.data.bl_rna.properties if k.type == "COLLECTION"]
    return {(kind, block.name) for kind in kinds for block in getattr(bpy.data, kind)}


def test_a_rig_in_a_file_is_what_it_is_in_the_open_scene(actors):
    found = read_rig_file(RigFile(actors, "Person"))
    own = read_rig(rigs.make_rig(rigs.RIGIFY), bpy.data.objects, 1.0).body
    assert found.name == "Person" and found.joint_names == own.joint_names
    assert rest_height(found) == pytest.approx(rest_height(own), abs=1e-5)
    assert np.allclose(found.surfaces[0].vertices, own.surfaces[0].vertices, atol=1e-5)


def test_reading_leaves_the_open_file_as_it_is_even_where_names_are_the_same(actors):
    mine = rigs.make_rig(rigs.DOG, "Person")
    before, layer = held(), bpy.context.view_layer
    read_rig_file(RigFile(actors, "Person"))
    assert held() == before
    assert bpy.context.view_layer == layer and layer.objects.active == mine


def test_the_open_file_s_own_rig_is_read_as_it_was_saved(actors):
    bpy.ops.wm.open_mainfile(filepath=str(actors))
    before = held()
    assert read_rig_file(RigFile(actors, "Dog")).joint_names[0] == "hips"
    assert held() == before and bpy.data.filepath == str(actors)


def test_a_wrong_name_is_told_with_the_armatures_there_are(actors):
    wanted = r"actors\.blend: holds no armature 'Cat'; it has: Dog, Person; name the armature"
    with pytest.raises(MocapError, match=wanted):
        read_rig_file(RigFile(actors, "Cat"))
    with pytest.raises(MocapError, match="names no armature; it has: Dog, Person"):
        read_rig_file(RigFile(actors, ""))


def test_files_that_are_none_are_told_and_leave_nothing(tmp_path):
    before = held()
    (tmp_path / "text.blend").write_text("text", "utf-8")
    with pytest.raises(MocapError, match=r"text\.blend: is no \.blend file; check the path"):
        read_rig_file(RigFile(tmp_path / "text.blend", "Rig"))
    with pytest.raises(MocapError, match=r"gone\.blend: no such file; check the path"):
        read_rig_file(RigFile(tmp_path / "gone.blend", "Rig"))
    assert held() == before


def test_a_fault_of_the_rig_names_its_file(tmp_path):
    rigs.make_rig(rigs.DOG, "Bare", skinned=False)
    path = tmp_path / "bare.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with pytest.raises(MocapError, match=r"bare\.blend: no mesh follows the bones of 'Bare'"):
        read_rig_file(RigFile(path, "Bare"))
