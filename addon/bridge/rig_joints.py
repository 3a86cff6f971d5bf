"""Which of an armature's bones move, and which joint carries each of the others.

The root is the lowest bone that carries all that follows the bones; where a rig has several trees,
of the one that carries most, and the others go with it. Of the bones below, those move that deform
a mesh or have such below them, but for those that names, locks or their size hold (`rig_names`).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from .rig_dofs import turns
from .rig_names import BoneName


@dataclass(frozen=True, eq=False)
class RigJoints:
    """J joints, the root first, parents before their children.

    Attributes:
        names: their bones.
        carriers: bone's name -> its joint, of all bones that go with the body.
    """

    names: tuple[str, ...]
    carriers: dict[str, int]


def rig_joints(
    armature: bpy.types.Object, weights: Mapping[str, np.ndarray], small: float
) -> RigJoints:
    """The joints of an ``armature`` whose bones carry vertices by ``weights``.

    Ends that reach less far than ``small``, in the armature's space, are held.
    """
    bones = list(armature.data.bones)
    carrying = {bone for bone in bones if bone.name in weights}
    live = carrying | {above for bone in carrying for above in bone.parent_recursive}
    root = _root(bones, live, weights)
    below = [bone for bone in bones if root in bone.parent_recursive]
    ends = {bone for bone in below if BoneName.of(bone.name).ends}
    moving = [
        bone
        for bone in below
        if bone in live and (bone.use_deform or bone in carrying)
        if ends.isdisjoint((bone, *bone.parent_recursive)) and not BoneName.of(bone.name).held
        if turns(armature.pose.bones[bone.name])
    ]
    moving = _without_small_ends(moving, small)
    names = (root.name, *(bone.name for bone in moving))
    carriers = {root.name: 0}
    for bone in below:
        own = names.index(bone.name) if bone in moving else None
        carriers[bone.name] = carriers[bone.parent.name] if own is None else own
    beside = (bone for bone in bones if bone in live and bone not in root.parent_recursive)
    return RigJoints(names, {bone.name: 0 for bone in beside} | carriers)


def _root(
    bones: list[bpy.types.Bone], live: set[bpy.types.Bone], weights: Mapping[str, np.ndarray]
) -> bpy.types.Bone:
    def carried(bone: bpy.types.Bone) -> float:
        own = (weights[b.name].sum() for b in (bone, *bone.children_recursive) if b.name in weights)
        return float(sum(own))

    root = max((bone for bone in bones if bone.parent is None and bone in live), key=carried)
    while root.name not in weights:
        onward = [child for child in root.children if child in live]
        if len(onward) != 1:
            break
        root = onward[0]
    return root


def _without_small_ends(moving: list[bpy.types.Bone], small: float) -> list[bpy.types.Bone]:
    """The bones without ends that reach less far, again and again."""
    while True:
        above = {parent for bone in moving for parent in bone.parent_recursive}
        kept = [bone for bone in moving if bone in above or _reach(bone) >= small]
        if len(kept) == len(moving):
            return moving
        moving = kept


def _reach(bone: bpy.types.Bone) -> float:
    tails = (b.tail_local for b in (bone, *bone.children_recursive))
    return max((tail - bone.head_local).length for tail in tails)
