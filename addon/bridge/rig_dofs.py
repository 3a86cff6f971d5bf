"""From a bone's locks and limits to rows of the DOF table.

A bone that turns freely swings across itself (its X and Z) and twists about its length (Y), as
Blender's own IK takes it apart. One with locked axes, or with a Limit Rotation constraint, turns by
Euler angles in the order of its rotation mode: so a locked channel stays exactly 0, and limits mean
what they mean in Blender. What the rig does not limit gets the limits, and all DOFs the spread of
the rest prior, of `PLACES`.
"""

from dataclasses import dataclass

import bpy
import numpy as np

from ...core.body.body import DofKind

FREE, FREELY = (-np.inf, np.inf), np.inf


@dataclass(frozen=True)
class Place:
    """What joints usually do at a place of the body, in degrees.

    Attributes:
        swing: most, either way, where the rig does not limit it.
        swing_spread: of the rest prior.
        twist: likewise.
        twist_spread: likewise.
    """

    swing: float
    swing_spread: float
    twist: float
    twist_spread: float


PLACES = {
    "spine": Place(40, 10, 30, 8),
    "neck": Place(50, 15, 50, 15),
    "head": Place(35, 15, 40, 15),
    "clavicle": Place(30, 8, 10, 4),
    "shoulder": Place(150, FREELY, 90, 40),
    "elbow": Place(150, FREELY, 20, 5),
    "wrist": Place(80, 25, 60, 20),
    "hip": Place(130, FREELY, 45, 20),
    "knee": Place(150, FREELY, 15, 5),
    "ankle": Place(50, 20, 25, 8),
    "limb": Place(120, 60, 45, 15),
}
"""Joints of people by the point they are, of other limbs, and of whatever trunk."""


@dataclass(frozen=True, eq=False)
class Row:
    """One row of the DOF table to be.

    Attributes:
        name: what follows the bone's name.
        kind: the elementary motion.
        axis: (3,) unit axis.
        limits: rad or m.
        spread: rad or m.
        direction: what the positive direction does.
    """

    name: str
    kind: DofKind
    axis: np.ndarray
    limits: tuple[float, float]
    spread: float
    direction: str


def root_rows() -> list[Row]:
    """Six: along and about the world's axes; yaw comes first, as in all bodies."""
    shifts = [
        Row(x, DofKind.TRANSLATION, axis, FREE, FREELY, f"moves along the world's +{x.upper()}")
        for x, axis in zip("xyz", np.eye(3), strict=True)
    ]
    x, y, z = np.eye(3)
    side = (-np.pi / 2, np.pi / 2)
    return [
        *shifts,
        Row("yaw", DofKind.HINGE, z, FREE, FREELY, "turns to the left, seen from above"),
        Row("roll", DofKind.HINGE, y, side, FREELY, "tilts about the world's +Y"),
        Row("pitch", DofKind.HINGE, x, FREE, FREELY, "tilts about the world's +X"),
    ]


def bone_rows(bone: bpy.types.PoseBone, axes: np.ndarray, place: Place) -> list[Row]:
    """The rows of a bone that turns; none where all of it is locked.

    Args:
        bone: the bone.
        axes: (3, 3) its X, Y and Z at rest, in columns, in the body's space.
        place: where it is.
    """
    locks = (bone.lock_ik_x, bone.lock_ik_y, bone.lock_ik_z)
    locked = np.array(bone.lock_rotation) | np.array(locks)
    rule = _limit_rotation(bone)
    low, high = _limits(bone, rule, place)
    locked |= low == high
    spreads = np.radians([place.swing_spread, place.twist_spread, place.swing_spread])

    def row(axis: int, kind: DofKind, word: str) -> Row:
        letter = "xyz"[axis]
        name = "twist" if word == "twists" else f"{word.removesuffix('s')}_{letter}"
        limits = (float(low[axis]), float(high[axis]))
        told = f"{word} about the bone's +{letter.upper()}"
        return Row(name, kind, axes[:, axis], limits, float(spreads[axis]), told)

    if rule is None and not locked.any():
        swings = [row(axis, DofKind.SWING, "swings") for axis in (0, 2)]
        return [*swings, row(1, DofKind.HINGE, "twists")]
    order = ["XYZ".index(letter) for letter in reversed(_order(bone, rule))]
    return [row(axis, DofKind.HINGE, "turns") for axis in order if not locked[axis]]


def turns(bone: bpy.types.PoseBone) -> bool:
    """Whether locks and limits leave the bone any turn."""
    return bool(bone_rows(bone, np.eye(3), PLACES["limb"]))


def _limit_rotation(bone: bpy.types.PoseBone) -> bpy.types.Constraint | None:
    """The Limit Rotation constraint that holds in the bone's own space, if there is one."""
    limits = (rule for rule in bone.constraints if rule.type == "LIMIT_ROTATION")
    own = (rule for rule in limits if rule.owner_space == "LOCAL" and not rule.mute)
    return next((rule for rule in own if rule.influence > 0), None)


def _order(bone: bpy.types.PoseBone, rule: bpy.types.Constraint | None) -> str:
    """The order of Euler angles that locks and limits are about."""
    order = "AUTO" if rule is None else rule.euler_order
    order = bone.rotation_mode if order == "AUTO" else order
    return "XYZ" if order in ("QUATERNION", "AXIS_ANGLE") else order


def _limits(
    bone: bpy.types.PoseBone, rule: bpy.types.Constraint | None, place: Place
) -> tuple[np.ndarray, np.ndarray]:
    """(3,) lowest and highest angle about X, Y and Z, rad."""
    usual = np.radians([place.swing, place.twist, place.swing])
    low, high = -usual, usual.copy()
    for axis, letter in enumerate("xyz"):
        told = []
        if getattr(bone, f"use_ik_limit_{letter}"):
            told.append([getattr(bone, f"ik_{end}_{letter}") for end in ("min", "max")])
        if rule is not None and getattr(rule, f"use_limit_{letter}"):
            told.append(sorted(getattr(rule, f"{end}_{letter}") for end in ("min", "max")))
        if told:
            low[axis] = max(limits[0] for limits in told)
            high[axis] = max(low[axis], min(limits[1] for limits in told))
    return low, high
