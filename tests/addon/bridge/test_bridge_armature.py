from dataclasses import replace

import bpy
import numpy as np
import pytest
from bl_ext.user_default.silhouette_mocap.addon.bridge.armature import add_armature
from bl_ext.user_default.silhouette_mocap.addon.bridge.mesh import add_mesh
from bl_ext.user_default.silhouette_mocap.addon.bridge.space import add_capture_space
from bl_ext.user_default.silhouette_mocap.core.body.bones import bone_names
from bl_ext.user_default.silhouette_mocap.core.body.kinematics import world_vertices
from bl_ext.user_default.silhouette_mocap.core.body.templates import template


def placed(body):
    collection = bpy.context.scene.collection
    return add_armature(body, "performer", add_capture_space(collection), collection)


def axes(armature, bone):
    """X, Y and Z of a bone in the rest pose."""
    return np.array(armature.data.bones[bone].matrix_local)[:3, :3].T


def test_sides_become_suffixes(small_body):
    names = ("root", "chest", "shoulder.L", "elbow.L", "shoulder.R", "head", "knee.R", "ankle.R")
    assert bone_names(small_body) == names


def test_bones_lie_where_the_rest_pose_has_joints_and_tails(small_body):
    armature = placed(small_body)
    elbow = armature.data.bones["elbow.L"]
    # 0.1 + 0 + 0.2 + 0.2, 0.2, 0.95 + 0.2 + 0.25 - 0.2 by the offsets of the small body
    assert np.allclose(elbow.head_local, [0.5, 0.2, 1.2], atol=1e-6)
    assert np.allclose(elbow.tail_local, [0.68, 0.2, 1.02], atol=1e-6)
    assert elbow.parent.name == "shoulder.L"


def test_rolls_turn_z_to_the_front_and_mirror_left_and_right():
    armature = placed(template("performer"))
    for bone in ("elbow", "knee"):
        left, right = axes(armature, f"{bone}.L"), axes(armature, f"{bone}.R")
        assert left[2] @ [0, -1, 0] > 0.9
        mirror = np.array([-1, 1, 1])
        assert np.allclose(right, left * mirror * [[-1], [1], [1]], atol=1e-5)
    assert axes(armature, "toes.L")[2] @ [0, 0, 1] > 0.9


def test_an_end_without_length_goes_on_from_its_parent(small_body):
    tails = small_body.tails.copy()
    tails[3] = 0
    elbow = placed(replace(small_body, tails=tails)).data.bones["elbow.L"]
    vector = np.array(elbow.tail_local - elbow.head_local)
    assert np.allclose(vector, 0.02 * np.array([1, 0, -1]) / np.sqrt(2), atol=1e-6)


def test_mode_selection_and_active_object_stay_as_they_were(small_body):
    layer = bpy.context.view_layer
    lattice = bpy.data.objects.new("mine", bpy.data.meshes.new("mine"))
    layer.active_layer_collection.collection.objects.link(lattice)
    layer.objects.active = lattice
    lattice.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    placed(small_body)
    assert bpy.context.mode == "EDIT_MESH"
    assert layer.objects.active == lattice
    assert bpy.context.selected_objects == [lattice]
    assert len(bpy.data.scenes) == 1


@pytest.mark.parametrize("name", ["performer", "sixteen_segment", "eleven_segment", "nine_joint"])
def test_every_vertex_of_the_mesh_follows_its_bone(name):
    body = template(name)
    armature = placed(body)
    mesh = add_mesh(body, body.surfaces[0], armature)
    rest = np.array([vertex.co for vertex in mesh.data.vertices])
    assert np.allclose(rest, world_vertices(body, body.rest_pose, level=0), atol=1e-5)
    assert len(mesh.data.polygons) == len(body.surfaces[0].triangles)
    assert {len(vertex.groups) for vertex in mesh.data.vertices} == {1}
    shoulder = armature.pose.bones["shoulder.L"]
    shoulder.rotation_quaternion = (0.8, 0.6, 0, 0)
    evaluated = mesh.evaluated_get(bpy.context.evaluated_depsgraph_get())
    now = np.array([vertex.co for vertex in evaluated.data.vertices])
    carry = np.array(shoulder.matrix @ shoulder.bone.matrix_local.inverted())
    joint = body.joint_names.index("left_shoulder")
    segment = list(body.segment_joints).index(joint)
    own = slice(*body.surfaces[0].vertex_starts[segment : segment + 2])
    assert np.allclose(now[own], rest[own] @ carry[:3, :3].T + carry[:3, 3], atol=1e-5)
    assert np.abs(now[own] - rest[own]).max() > 0.05
