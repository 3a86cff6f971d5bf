"""The names of Blender's bones, and which bone of which body carries each of the 14 points.

An armature has one bone per joint: the bone's head is the joint, its tail the end that the body
names for it.
"""

from collections.abc import Sequence

import numpy as np

from .body import POINT_NAMES, Body

_SIDES = {"left_": ".L", "right_": ".R"}


def bone_names(body: Body) -> tuple[str, ...]:
    """J names in Blender's style: ``left_elbow`` becomes ``elbow.L``."""
    return tuple(_bone_name(name) for name in body.joint_names)


def _bone_name(joint: str) -> str:
    for prefix, suffix in _SIDES.items():
        if joint.startswith(prefix):
            return joint.removeprefix(prefix) + suffix
    return joint


def point_table(bodies: Sequence[Body]) -> str:
    """Markdown for the documentation: a line per point, a column per body, bones in the cells.

    ``elbow.L, head`` stands where the bone begins, ``elbow.L, tail`` where it ends; else there are
    centimetres from its head, along the axes of the rest pose.
    """
    header = ("point", *(body.name for body in bodies))
    rows = [
        (name, *(_place(body, index) for body in bodies)) for index, name in enumerate(POINT_NAMES)
    ]
    lines = [header, ("---",) * len(header), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines) + "\n"


def _place(body: Body, point: int) -> str:
    joint, offset = int(body.point_joints[point]), body.point_offsets[point]
    bone = bone_names(body)[joint]
    if np.allclose(offset, 0):
        return f"{bone}, head"
    if np.allclose(offset, body.tails[joint]):
        return f"{bone}, tail"
    return f"{bone}, head + ({', '.join(f'{100 * x + 0.0:.1f}' for x in offset)}) cm"
