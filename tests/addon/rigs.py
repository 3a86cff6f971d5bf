"""Rigs made by code, with the bones of well-known ones, and a skin of tubes.

Bones are (name, parent, head, tail, thickness) in metres; people look along -Y, the left at +X.
"""

import bpy
import numpy as np

_SIDES = 8
_RINGS = np.array([0.0, 0.15, 0.5, 0.85, 1.0])
_GIRTHS = np.array([0.75, 1.0, 1.0, 0.9, 0.7])


def _both(rows):
    """The rows of the left, and their mirror images; parents without a side are shared."""
    found = []
    for side, sign in (("L", 1), ("R", -1)):
        for name, parent, head, tail, thick in rows:
            places = [(sign * x, y, z) for x, y, z in (head, tail)]
            found.append((name.format(s=side), parent.format(s=side), *places, thick))
    return found


RIGIFY = [
    ("spine", "", (0, 0.05, 1.0), (0, 0.02, 1.14), 0.14),
    ("spine.001", "spine", (0, 0.02, 1.14), (0, 0.0, 1.27), 0.12),
    ("spine.002", "spine.001", (0, 0.0, 1.27), (0, 0.0, 1.43), 0.14),
    ("spine.003", "spine.002", (0, 0.0, 1.43), (0, 0.01, 1.58), 0.13),
    ("spine.004", "spine.003", (0, 0.01, 1.58), (0, -0.01, 1.65), 0.05),
    ("spine.006", "spine.004", (0, -0.01, 1.65), (0, -0.02, 1.85), 0.085),
    *_both(
        [
            ("shoulder.{s}", "spine.003", (0.02, -0.03, 1.53), (0.17, 0.01, 1.53), 0.05),
            ("upper_arm.{s}", "shoulder.{s}", (0.19, 0.02, 1.51), (0.40, 0.05, 1.32), 0.05),
            ("forearm.{s}", "upper_arm.{s}", (0.40, 0.05, 1.32), (0.58, 0.01, 1.14), 0.04),
            ("hand.{s}", "forearm.{s}", (0.58, 0.01, 1.14), (0.65, 0.0, 1.06), 0.035),
            ("f_index.01.{s}", "hand.{s}", (0.65, 0.0, 1.06), (0.69, 0.0, 1.0), 0.015),
            ("breast.{s}", "spine.003", (0.1, 0.04, 1.42), (0.1, -0.1, 1.42), 0.04),
            ("pelvis.{s}", "spine", (0.0, 0.05, 1.0), (0.14, 0.02, 1.06), 0.06),
            ("thigh.{s}", "spine", (0.1, 0.02, 0.98), (0.11, 0.0, 0.53), 0.08),
            ("shin.{s}", "thigh.{s}", (0.11, 0.0, 0.53), (0.12, 0.03, 0.09), 0.055),
            ("foot.{s}", "shin.{s}", (0.12, 0.03, 0.09), (0.13, -0.1, 0.03), 0.04),
            ("toe.{s}", "foot.{s}", (0.13, -0.1, 0.03), (0.13, -0.17, 0.03), 0.03),
        ]
    ),
]
"""Names of Rigify's human metarig."""


def _renamed(names, further=(), without=()):
    rows = []
    for name, parent, *rest in RIGIFY:
        if name in without or name.partition(".")[0] in without:
            continue
        rows.append((names(name), names(parent) if parent else "", *rest))
    return rows + list(further)


def _game(name):
    base, _, side = name.rpartition(".") if name[-1] in "LR" else (name, "", "")
    table = {
        "spine": "pelvis", "spine.001": "spine_01", "spine.002": "spine_02",
        "spine.003": "spine_03", "spine.004": "neck_01", "spine.006": "head",
        "shoulder": "clavicle", "upper_arm": "upperarm", "forearm": "lowerarm", "hand": "hand",
        "f_index.01": "index_01", "thigh": "thigh", "shin": "calf", "foot": "foot", "toe": "ball",
    }  # fmt: skip
    return table[base] + (f"_{side.lower()}" if side else "")


def _mixamo(name):
    base, _, side = name.rpartition(".") if name[-1] in "LR" else (name, "", "")
    table = {
        "spine": "Hips", "spine.001": "Spine", "spine.002": "Spine1", "spine.003": "Spine2",
        "spine.004": "Neck", "spine.006": "Head", "shoulder": "Shoulder", "upper_arm": "Arm",
        "forearm": "ForeArm", "hand": "Hand", "f_index.01": "HandIndex1", "thigh": "UpLeg",
        "shin": "Leg", "foot": "Foot", "toe": "ToeBase",
    }  # fmt: skip
    return "mixamorig:" + {"L": "Left", "R": "Right", "": ""}[side] + table[base]


GAME_ENGINE = [
    ("Root", "", (0, 0, 0), (0, 0.1, 0), 0),
    *((n, p or "Root", *rest) for n, p, *rest in _renamed(_game, without=("breast", "pelvis"))),
    *_both([("upperarm_twist_01_{s}", "upperarm_{s}", (0.19, 0.02, 1.51), (0.3, 0.03, 1.41), 0.0)]),
]
"""MPFB's and MakeHuman's game engine rig, and Unreal's mannequin with its twist bones."""
GAME_ENGINE = [
    (n.replace("_L", "_l").replace("_R", "_r"), p.replace("_L", "_l").replace("_R", "_r"), *rest)
    for n, p, *rest in GAME_ENGINE
]
MIXAMO = _renamed(_mixamo, without=("breast", "pelvis"))


def _makehuman():
    rows = [
        ("root", "", (0, 0.05, 0.95), (0, 0.05, 1.0), 0.0),
        ("spine05", "root", (0, 0.05, 1.0), (0, 0.02, 1.1), 0.14),
        ("spine03", "spine05", (0, 0.02, 1.1), (0, 0.0, 1.3), 0.12),
        ("spine01", "spine03", (0, 0.0, 1.3), (0, 0.01, 1.58), 0.14),
        ("neck01", "spine01", (0, 0.01, 1.58), (0, -0.01, 1.65), 0.05),
        ("head", "neck01", (0, -0.01, 1.65), (0, -0.02, 1.85), 0.085),
        ("jaw", "head", (0, -0.03, 1.68), (0, -0.1, 1.66), 0.03),
    ]
    return rows + _both(
        [
            ("clavicle.{s}", "spine01", (0.02, -0.03, 1.53), (0.1, -0.01, 1.53), 0.05),
            ("shoulder01.{s}", "clavicle.{s}", (0.1, -0.01, 1.53), (0.19, 0.02, 1.51), 0.05),
            ("upperarm01.{s}", "shoulder01.{s}", (0.19, 0.02, 1.51), (0.3, 0.035, 1.41), 0.05),
            ("upperarm02.{s}", "upperarm01.{s}", (0.3, 0.035, 1.41), (0.4, 0.05, 1.32), 0.045),
            ("lowerarm01.{s}", "upperarm02.{s}", (0.4, 0.05, 1.32), (0.5, 0.03, 1.22), 0.04),
            ("lowerarm02.{s}", "lowerarm01.{s}", (0.5, 0.03, 1.22), (0.58, 0.01, 1.14), 0.035),
            ("wrist.{s}", "lowerarm02.{s}", (0.58, 0.01, 1.14), (0.65, 0.0, 1.06), 0.035),
            ("metacarpal1.{s}", "wrist.{s}", (0.63, 0.0, 1.08), (0.66, 0.0, 1.05), 0.02),
            ("finger2-1.{s}", "metacarpal1.{s}", (0.66, 0.0, 1.05), (0.7, 0.0, 1.0), 0.012),
            ("pelvis.{s}", "root", (0.0, 0.05, 0.95), (0.1, 0.02, 0.98), 0.07),
            ("upperleg01.{s}", "pelvis.{s}", (0.1, 0.02, 0.98), (0.105, 0.01, 0.75), 0.08),
            ("upperleg02.{s}", "upperleg01.{s}", (0.105, 0.01, 0.75), (0.11, 0, 0.53), 0.07),
            ("lowerleg01.{s}", "upperleg02.{s}", (0.11, 0.0, 0.53), (0.115, 0.02, 0.3), 0.055),
            ("lowerleg02.{s}", "lowerleg01.{s}", (0.115, 0.02, 0.3), (0.12, 0.03, 0.09), 0.05),
            ("foot.{s}", "lowerleg02.{s}", (0.12, 0.03, 0.09), (0.13, -0.1, 0.03), 0.04),
            ("toe1-1.{s}", "foot.{s}", (0.12, -0.1, 0.03), (0.12, -0.15, 0.03), 0.02),
        ]
    )


MAKEHUMAN = _makehuman()
"""MPFB's and MakeHuman's default rig."""


def _dog():
    rows = [
        ("hips", "", (0, 0.3, 0.6), (0, 0.1, 0.61), 0.11),
        ("belly", "hips", (0, 0.1, 0.61), (0, -0.12, 0.6), 0.12),
        ("ribs", "belly", (0, -0.12, 0.6), (0, -0.35, 0.62), 0.13),
        ("neck", "ribs", (0, -0.35, 0.64), (0, -0.5, 0.82), 0.06),
        ("head", "neck", (0, -0.5, 0.82), (0, -0.76, 0.78), 0.06),
        ("tail", "hips", (0, 0.33, 0.64), (0, 0.5, 0.7), 0.02),
        ("tail.001", "tail", (0, 0.5, 0.7), (0, 0.7, 0.8), 0.02),
    ]
    return rows + _both(
        [
            ("ear.{s}", "head", (0.04, -0.52, 0.86), (0.07, -0.52, 0.94), 0.015),
            ("front_thigh.{s}", "ribs", (0.1, -0.28, 0.56), (0.1, -0.24, 0.32), 0.05),
            ("front_shin.{s}", "front_thigh.{s}", (0.1, -0.24, 0.32), (0.1, -0.26, 0.07), 0.035),
            ("front_foot.{s}", "front_shin.{s}", (0.1, -0.26, 0.07), (0.1, -0.36, 0.03), 0.03),
            ("thigh.{s}", "hips", (0.1, 0.28, 0.56), (0.1, 0.22, 0.34), 0.06),
            ("shin.{s}", "thigh.{s}", (0.1, 0.22, 0.34), (0.1, 0.36, 0.16), 0.035),
            ("foot.{s}", "shin.{s}", (0.1, 0.36, 0.16), (0.1, 0.31, 0.03), 0.03),
        ]
    )


DOG = _dog()


def make_rig(bones, name="Actor", skinned=True):
    """An armature object of ``bones`` with a mesh, linked to the scene."""
    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for bone, parent, head, tail, _ in bones:
        made = armature.data.edit_bones.new(bone)
        made.head, made.tail = head, tail
        made.align_roll((0, -1, 0) if abs(tail[1] - head[1]) < 0.1 else (0, 0, 1))
        if parent:
            made.parent = armature.data.edit_bones[parent]
    bpy.ops.object.mode_set(mode="OBJECT")
    if skinned:
        skin(armature, [bone for bone in bones if bone[4]])
    return armature


def skin(armature, bones):
    """One mesh of tubes; near a bone's head its vertices follow the parent, too."""
    tubes = [_tube(np.array(head), np.array(tail), thick) for _, _, head, tail, thick in bones]
    vertices = np.concatenate([tube[0] for tube in tubes])
    count = len(tubes[0][0])
    faces = [[c + k * count for c in face] for k in range(len(tubes)) for face in tubes[k][1]]
    mesh = bpy.data.meshes.new("Skin")
    mesh.from_pydata(vertices.tolist(), [], faces)
    made = bpy.data.objects.new("Skin", mesh)
    bpy.context.scene.collection.objects.link(made)
    made.parent = armature
    made.modifiers.new("Armature", "ARMATURE").object = armature
    groups = {bone[0]: made.vertex_groups.new(name=bone[0]) for bone in bones}
    for k, (name, parent, *_) in enumerate(bones):
        for ring, share in enumerate((0.35, 0.1, 0.0, 0.0, 0.0)):
            own = [k * count + ring * _SIDES + side for side in range(_SIDES)]
            share = share if parent in groups else 0.0
            groups[name].add(own, 1.0 - share, "REPLACE")
            if share:
                groups[parent].add(own, share, "REPLACE")
        groups[name].add([k * count + len(_RINGS) * _SIDES + cap for cap in (0, 1)], 1, "REPLACE")
    return made


def _tube(head, tail, thick):
    """Vertices (n, 3) and faces of a closed tube along a bone."""
    along = (tail - head) / np.linalg.norm(tail - head)
    across = np.cross(along, [1.0, 0, 0] if abs(along[0]) < 0.7 else [0, 0, 1.0])
    across /= np.linalg.norm(across)
    turns = np.arange(_SIDES) * 2 * np.pi / _SIDES
    circle = np.outer(np.cos(turns), across) + np.outer(np.sin(turns), np.cross(along, across))
    rings = [
        head + share * (tail - head) + thick * girth * circle
        for share, girth in zip(_RINGS, _GIRTHS, strict=True)
    ]
    ends = [head - 0.4 * thick * along, tail + 0.4 * thick * along]
    faces, last = [], len(_RINGS) - 1
    for side in range(_SIDES):
        after = (side + 1) % _SIDES
        for ring in range(last):
            a, b = ring * _SIDES + side, ring * _SIDES + after
            faces.append([a, b, b + _SIDES, a + _SIDES])
        faces.append([after, side, (last + 1) * _SIDES])
        faces.append([last * _SIDES + side, last * _SIDES + after, (last + 1) * _SIDES + 1])
    return np.concatenate([*rings, ends]), faces
