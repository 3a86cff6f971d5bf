"""Armatures of all kinds as bodies."""

import contextlib
import io

import addon_utils
import bpy
import numpy as np
import pytest
import rigs
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig import read_rig
from bl_ext.user_default.silhouette_mocap.addon.bridge.rig_names import BoneName, point_bones
from bl_ext.user_default.silhouette_mocap.core.body.body import POINT_NAMES, DofKind
from bl_ext.user_default.silhouette_mocap.core.body.file import read_body, write_body
from bl_ext.user_default.silhouette_mocap.core.body.kinematics import (
    points,
    rest_joints,
    skinned_segments,
    world_vertices,
)
from bl_ext.user_default.silhouette_mocap.core.errors import MocapError
from bl_ext.user_default.silhouette_mocap.core.fitting.limbs import LIMB_NAMES, limb_names
from mathutils import Matrix

PEOPLE = ("RIGIFY", "GAME_ENGINE", "MIXAMO", "MAKEHUMAN")


def read(bones, **settings):
    return read_rig(rigs.make_rig(bones, **settings), bpy.data.objects, 1.0)


def rows_of(body, bone):
    """Kind, name and limits of the bone's DOFs, in order."""
    own = np.flatnonzero(body.dofs.joints == body.joint_names.index(bone))
    return [
        (DofKind(int(body.dofs.kinds[row])).name, body.dofs.names[row].removeprefix(f"{bone}_"),
         tuple(np.round(body.dofs.limits[row], 6).tolist()))
        for row in own
    ]  # fmt: skip


@pytest.mark.parametrize("name", PEOPLE)
def test_people_are_known_by_the_usual_names_of_their_bones(name):
    body = read(getattr(rigs, name)).body
    assert body.point_names == POINT_NAMES
    assert limb_names(body) == LIMB_NAMES
    places = dict(zip(POINT_NAMES, points(body, body.rest_pose[None])[0], strict=True))
    # the same figure under other names, the root over the origin; heads of bones in rigs.py
    wanted = {"left_shoulder": (0.19, 0.02, 1.51), "right_elbow": (-0.40, 0.05, 1.32),
              "left_wrist": (0.58, 0.01, 1.14), "right_hip": (-0.1, 0.02, 0.98),
              "left_knee": (0.11, 0.0, 0.53), "right_ankle": (-0.12, 0.03, 0.09),
              "neck": (0, 0.01, 1.58), "head": (0, -0.015, 1.75)}  # fmt: skip
    lowest = min(vertex.co[2] for vertex in bpy.data.objects["Skin"].data.vertices)
    for point, place in wanted.items():
        assert np.allclose(places[point], np.array(place) - (0, 0.05, lowest), atol=1e-5), point


@pytest.mark.parametrize("name", PEOPLE)
def test_fingers_toes_faces_and_twists_are_held_and_move_with_what_carries_them(name):
    rig = read(getattr(rigs, name))
    held = [bone for bone in rig.carriers if bone not in rig.body.joint_names]
    words = ("index", "toe", "ball", "Toe", "Index", "breast", "pelvis.", "arm02", "leg02", "jaw",
             "metacarpal", "finger", "twist")  # fmt: skip
    assert held and all(any(word in bone for word in words) for bone in held)
    assert not any(word in bone for word in words for bone in rig.body.joint_names)


def test_blenders_own_human_metarig_is_a_person():
    armature = metarig("human")
    body = read_rig(armature, bpy.data.objects, 1.0).body
    assert body.point_names == POINT_NAMES and limb_names(body) == LIMB_NAMES
    assert set(body.joint_names) == {
        "spine", *(f"spine.00{k}" for k in range(1, 7)),
        *(f"{bone}.{side}" for side in "LR"
          for bone in ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot")),
    }  # fmt: skip


def test_blenders_own_wolf_metarig_has_four_legs_a_neck_and_a_tail():
    body = read_rig(metarig("Animals.wolf"), bpy.data.objects, 1.0).body
    limbs = limb_names(body)
    assert set(limbs[1:]) == {"shoulder.L", "shoulder.R", "thigh.L", "thigh.R", "spine.009",
                              "spine.003"}  # fmt: skip
    assert not any(word in bone for word in ("lid", "ear", "nose", "palm", "tongue")
                   for bone in body.joint_names)  # fmt: skip
    assert len(set(body.point_names)) == len(body.point_names)


def metarig(kind):
    """One of Rigify's, with a skin of tubes."""
    with contextlib.redirect_stdout(io.StringIO()):
        addon_utils.enable("rigify", default_set=True)
        from importlib import import_module

        source = import_module(f"rigify.metarigs.{kind}")
    armature = rigs.make_rig([], skinned=False)
    bpy.ops.object.mode_set(mode="EDIT")
    source.create(armature)
    bpy.ops.object.mode_set(mode="OBJECT")
    bones = [
        (b.name, b.parent.name if b.parent else "", b.head_local, b.tail_local, b.length / 6)
        for b in armature.data.bones
        if "heel" not in b.name
    ]
    rigs.skin(armature, bones)
    return armature


def test_a_dog_has_its_own_limbs_and_turns_about_its_middle():
    body = read(rigs.DOG).body
    legs = {f"{bone}.{side}" for bone in ("front_thigh", "thigh") for side in "LR"}
    assert set(limb_names(body)) == {"torso", "neck", "tail", *legs}
    vertices = world_vertices(body, body.rest_pose)
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    assert np.allclose([*middle[:2], vertices[:, 2].min()], 0, atol=1e-6)
    assert np.allclose(rest_joints(body)[0, :2], 0, atol=1e-6)
    assert "left_hip" in body.point_names and "end of tail.001" in body.point_names


def test_ends_too_small_to_be_seen_are_held_and_short_branches_make_no_limbs():
    horns = [(f"horn.{s}", "head", (x, -0.5, 0.88), (x, -0.5, 1.0), 0.02)
             for s, x in (("L", 0.05), ("R", -0.05))]  # fmt: skip
    knobs = [(f"knob.{s}", f"horn.{s}", horn[3], (horn[3][0], -0.5, 1.03), 0.02)
             for s, horn in zip("LR", horns, strict=True)]  # fmt: skip
    rig = read([*rigs.DOG, *horns, *knobs])
    assert "horn.L" in rig.body.joint_names and "knob.L" not in rig.body.joint_names
    assert rig.carriers["knob.L"] == rig.body.joint_names.index("horn.L")
    assert len(limb_names(rig.body)) == 7
    (neck,) = (part for part in rig.body.parts if part.name == "neck")
    names = {rig.body.segment_names[segment] for segment in neck.segments}
    assert names == {"neck", "head", "horn.L", "horn.R"}


def test_where_nothing_is_seen_of_the_trunk_the_longest_limb_belongs_to_it():
    arms = [(f"{word}.{s}", parent.format(s=s), (sign * x, 0, 1), (sign * (x + 0.4), 0, 1), 0.04)
            for s, sign in (("L", 1), ("R", -1.2))
            for word, parent, x in (("near", "hub", 0.1), ("far", "near.{s}", 0.5))]  # fmt: skip
    body = read([("hub", "", (0, 0, 0.9), (0, 0, 1), 0), *arms]).body
    assert limb_names(body) == ("torso", "near.L")
    assert [part.name for part in body.parts if part.role == "spine"] == ["spine"]


def test_a_chain_is_a_trunk_with_one_limb():
    links = [(f"link{k}", f"link{k - 1}" if k else "", (0, 0, 0.3 * k), (0, 0, 0.3 * k + 0.3), 0.05)
             for k in range(4)]  # fmt: skip
    body = read(links).body
    assert [part.role for part in body.parts] == ["torso", "limb", "end"]
    assert body.joint_names == ("link0", "link1", "link2", "link3")


def test_a_free_bone_swings_and_twists_about_its_own_axes():
    armature = rigs.make_rig(rigs.RIGIFY)
    body = read_rig(armature, bpy.data.objects, 1.0).body
    kinds = [(kind, name) for kind, name, _ in rows_of(body, "thigh.L")]
    assert kinds == [("SWING", "swing_x"), ("SWING", "swing_z"), ("HINGE", "twist")]
    own = body.dofs.joints == body.joint_names.index("thigh.L")
    rest = np.array(armature.data.bones["thigh.L"].matrix_local)[:3, :3]
    assert np.allclose(body.dofs.axes[own], rest.T[[0, 2, 1]], atol=1e-6)


def test_locks_leave_hinges_or_nothing():
    armature = rigs.make_rig(rigs.RIGIFY)
    bones = armature.pose.bones
    bones["shin.L"].lock_ik_y = bones["shin.L"].lock_ik_z = True
    bones["shin.L"].use_ik_limit_x, bones["shin.L"].ik_min_x, bones["shin.L"].ik_max_x = (
        True,
        -0.1,
        2,
    )
    bones["forearm.L"].rotation_mode, bones["forearm.L"].lock_rotation = "ZYX", (False, True, False)
    bones["foot.L"].lock_rotation = (True, True, True)
    body = read_rig(armature, bpy.data.objects, 1.0).body
    assert rows_of(body, "shin.L") == [("HINGE", "turn_x", (-0.1, 2))]
    # ZYX: Z first, so X comes first in the product
    assert [row[:2] for row in rows_of(body, "forearm.L")] == [
        ("HINGE", "turn_x"),
        ("HINGE", "turn_z"),
    ]
    assert "foot.L" not in body.joint_names and "foot.R" in body.joint_names


def test_limits_come_from_ik_and_from_limit_rotation_and_the_narrower_one_counts():
    armature = rigs.make_rig(rigs.RIGIFY)
    thigh, arm = armature.pose.bones["thigh.L"], armature.pose.bones["upper_arm.L"]
    thigh.use_ik_limit_z, thigh.ik_min_z, thigh.ik_max_z = True, -0.3, 0.6
    rule = arm.constraints.new("LIMIT_ROTATION")
    rule.owner_space = "LOCAL"
    rule.use_limit_x, rule.min_x, rule.max_x = True, -0.5, 1.5
    arm.use_ik_limit_x, arm.ik_min_x, arm.ik_max_x = True, -1.0, 1.0
    ignored = thigh.constraints.new("LIMIT_ROTATION")  # in world space, which says nothing here
    ignored.use_limit_x, ignored.min_x, ignored.max_x = True, 0, 0
    body = read_rig(armature, bpy.data.objects, 1.0).body
    limits = {name: limits for _, name, limits in rows_of(body, "thigh.L")}
    assert limits["swing_z"] == (-0.3, 0.6) and limits["swing_x"][1] > 2
    assert rows_of(body, "upper_arm.L")[2][1:] == ("turn_x", (-0.5, 1.0))


def test_bones_that_do_not_deform_are_left_alone():
    bones = [("ground", "", (0, 0, 0), (0, 0.2, 0), 0),
             *((n, p or "ground", *rest) for n, p, *rest in rigs.RIGIFY),
             ("handle.L", "hand.L", (0.6, 0, 1.1), (0.6, 0.3, 1.1), 0)]  # fmt: skip
    armature = rigs.make_rig(bones)
    for name in ("ground", "handle.L", "spine.002"):
        armature.data.bones[name].use_deform = False
    rig = read_rig(armature, bpy.data.objects, 1.0)
    assert rig.body.joint_names[0] == "spine" and "ground" not in rig.carriers
    assert "spine.002" not in rig.body.joint_names and "handle.L" not in rig.body.joint_names
    assert rig.body.point_names == POINT_NAMES


def test_unit_scale_and_the_armature_s_place_make_no_difference():
    plain = read(rigs.RIGIFY).body
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    armature = rigs.make_rig(rigs.RIGIFY)
    armature.matrix_world = Matrix.Translation((70, -30, 12)) @ Matrix.Scale(100, 4)
    moved = read_rig(armature, bpy.data.objects, 0.01).body
    assert np.allclose(rest_joints(moved), rest_joints(plain), atol=1e-5)
    for body in (moved, plain):
        assert world_vertices(body, body.rest_pose)[:, 2].min() == pytest.approx(0, abs=1e-6)


def test_the_rest_pose_is_read_whatever_pose_the_file_is_in_and_nothing_is_changed():
    armature = rigs.make_rig(rigs.RIGIFY)
    plain = read_rig(armature, bpy.data.objects, 1.0).body
    armature.pose.bones["thigh.L"].rotation_quaternion = (0.7, 0.7, 0, 0)
    scenes, layer = len(bpy.data.scenes), bpy.context.view_layer
    posed = read_rig(armature, bpy.data.objects, 1.0).body
    assert np.allclose(
        world_vertices(posed, posed.rest_pose), world_vertices(plain, plain.rest_pose)
    )
    assert armature.data.pose_position == "POSE" and len(bpy.data.scenes) == scenes
    assert bpy.context.view_layer == layer and len(armature.users_collection) == 1
    assert armature.pose.bones["thigh.L"].rotation_quaternion.w == pytest.approx(0.7)


def test_a_mesh_parented_to_a_bone_is_rigid_and_hidden_ones_are_no_part():
    armature = rigs.make_rig(rigs.DOG)
    box = cube("collar", 0.1)
    box.parent, box.parent_type, box.parent_bone = armature, "BONE", "neck"
    box.matrix_world = Matrix.Translation((0, -0.42, 0.73))
    unseen = cube("bounds", 3.0)
    unseen.parent, unseen.hide_render = armature, True
    unseen.modifiers.new("Armature", "ARMATURE").object = armature
    skin = bpy.data.objects["Skin"]
    bpy.data.objects.remove(skin)
    body = read_rig(armature, bpy.data.objects, 1.0).body
    assert body.joint_names == ("neck",) and not skinned_segments(body, body.surfaces[0]).any()
    size = np.ptp(world_vertices(body, body.rest_pose), axis=0)
    assert np.allclose(size, 0.1, atol=1e-6)


def cube(name, side):
    corners = [[x, y, z] for x in (-side / 2, side / 2) for y in (-side / 2, side / 2)
               for z in (-side / 2, side / 2)]  # fmt: skip
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def test_modifiers_are_applied_with_the_weights_that_come_out_of_them():
    armature = rigs.make_rig(rigs.DOG)
    before = read_rig(armature, bpy.data.objects, 1.0).body
    skin = bpy.data.objects["Skin"]
    skin.modifiers.new("Subdivision", "SUBSURF").levels = 1
    body = read_rig(armature, bpy.data.objects, 1.0).body
    assert len(body.surfaces[0].triangles) > 3 * len(before.surfaces[0].triangles)
    assert body.segment_names == before.segment_names
    assert skinned_segments(body, body.surfaces[0]).any()


def test_of_several_trees_the_one_with_most_is_the_body_and_the_others_go_with_it():
    bones = [*rigs.DOG, ("ball", "", (0.5, 0, 0.1), (0.5, 0, 0.3), 0.1)]
    rig = read(bones)
    assert rig.body.joint_names[0] == "hips"
    assert rig.carriers["ball"] == 0 and "ball" not in rig.body.joint_names


def test_a_body_of_a_rig_comes_back_from_its_file(tmp_path):
    body = read(rigs.DOG).body
    write_body(tmp_path / "body.npz", body)
    back = read_body(tmp_path / "body.npz")
    assert back.joint_names == body.joint_names and back.point_names == body.point_names
    assert np.array_equal(back.surfaces[0].skin.weights, body.surfaces[0].skin.weights)


def test_an_armature_without_a_mesh_is_told():
    with pytest.raises(MocapError, match="no mesh follows the bones of 'Actor'"):
        read(rigs.DOG, skinned=False)


def test_a_stretched_armature_is_told():
    armature = rigs.make_rig(rigs.DOG)
    armature.scale = (1, 1, 1.2)
    with pytest.raises(MocapError, match=r"stretched or mirrored .*apply its scale"):
        read_rig(armature, bpy.data.objects, 1.0)


@pytest.mark.parametrize(
    ("name", "base", "side", "held", "ends"),
    [
        ("mixamorig:LeftForeArm", "forearm", "left", False, False),
        ("DEF-upper_arm.R.001", "upperarm", "right", True, False),
        ("spine.001", "spine001", "", False, False),
        ("arm.001.L", "arm001", "left", False, False),
        ("lowerarm_twist_01_l", "lowerarmtwist01", "left", True, False),
        ("CC_Base_L_Upperarm", "upperarm", "left", False, False),
        ("Bip01 R Thigh", "thigh", "right", False, False),
        ("ring", "ring", "", False, False),
        ("f_ring.01.L", "fring01", "left", False, True),
        ("LeftHandIndex1", "handindex1", "left", False, True),
        ("Leftover", "leftover", "", False, False),
    ],
)
def test_names_are_taken_apart(name, base, side, held, ends):
    known = BoneName.of(name)
    assert (known.base, known.side, known.held, known.ends) == (base, side, held, ends)


def test_our_own_export_s_bones_are_known():
    names = ("root", "neck", "head", *(f"{j}.{s}" for s in "LR" for j in (
        "clavicle", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "toes")))  # fmt: skip
    found = point_bones(names)
    assert set(found) == set(POINT_NAMES)
    assert found["left_shoulder"] == "shoulder.L" and found["right_hip"] == "hip.R"
