"""The joints' degrees of freedom: axes, ranges and rest priors.

Ranges are those of SPEC section 4, given from the anatomical position (arms and legs hanging) and
turned here into values relative to the rest pose. The spine's range is shared between its joints
roughly as its vertebrae share it: the waist bends, the chest twists; of the neck's range the upper
two vertebrae do half of the turn and a good third of the nod (White and Panjabi, Clinical
Biomechanics of the Spine, chapter 2).
"""

import numpy as np

from ..body import DofKind
from .landmarks import ARM, FOOT, FORWARD, LEFT, LEG, PALM, UP
from .skeleton import FREE, Joint, Row, ellipse_cone, hanging_cone, swing_axes, turning

Range = tuple[float, float]
FREELY = np.inf


def root() -> Joint:
    """Six DOFs; yaw comes first, so that only a sideways roll by 90 degrees is singular."""
    shift = [
        Row(
            f"root_{x}",
            DofKind.TRANSLATION,
            axis,
            FREE,
            FREELY,
            f"moves along the world's +{x.upper()}",
        )
        for x, axis in (("x", LEFT), ("y", -FORWARD), ("z", UP))
    ]
    turn = [
        Row("root_yaw", DofKind.HINGE, UP, FREE, FREELY, "turns the performer to the left"),
        Row(
            "root_roll",
            DofKind.HINGE,
            -FORWARD,
            (-90, 90),
            FREELY,
            "tilts the performer to the left",
        ),
        Row("root_pitch", DofKind.HINGE, LEFT, FREE, FREELY, "tilts the performer forwards"),
    ]
    return Joint("root", "", "waist", (*shift, *turn))


def spine(
    name: str,
    parent: str,
    tail: str,
    ranges: tuple[Range, float, float],
    spreads: tuple[float, float, float],
) -> Joint:
    """A joint of the trunk or neck: swing (flexion, lateral) and twist; ranges in degrees."""
    flexion, lateral, twist = ranges
    rows = (
        Row(f"{name}_flexion", DofKind.SWING, LEFT, flexion, spreads[0], "bends forwards"),
        Row(
            f"{name}_lateral",
            DofKind.SWING,
            -FORWARD,
            (-lateral, lateral),
            spreads[1],
            "bends to the left",
        ),
        Row(f"{name}_twist", DofKind.HINGE, UP, (-twist, twist), spreads[2], "turns to the left"),
    )
    return Joint(name, parent, tail, rows, ellipse_cone(flexion, (-lateral, lateral)))


def head() -> Joint:
    """The skull on the upper two vertebrae: it turns, then nods."""
    rows = (
        Row("head_turn", DofKind.HINGE, UP, (-35, 35), 15, "turns the face to the left"),
        Row("head_nod", DofKind.HINGE, LEFT, (-20, 20), 15, "nods forwards"),
    )
    return Joint("head", "neck", "head_end", rows)


def clavicle(bone: np.ndarray) -> Joint:
    """The shoulder girdle on the breastbone; ``bone`` (3,) leads to the left shoulder."""
    up, forward = swing_axes(bone / np.linalg.norm(bone), UP, FORWARD)
    rows = (
        Row("left_clavicle_elevation", DofKind.SWING, up, (-10, 40), 8, "lifts the shoulder"),
        Row(
            "left_clavicle_protraction",
            DofKind.SWING,
            forward,
            (-25, 25),
            8,
            "moves the shoulder forwards",
        ),
    )
    return Joint(
        "left_clavicle", "chest", "left_shoulder", rows, ellipse_cone((-10, 40), (-25, 25))
    )


def shoulder(parent: str) -> Joint:
    """Swing and twist of the left upper arm."""
    ranges = ((-60, 180), (-30, 180), 90)
    return Joint("left_shoulder", parent, "left_elbow", *_ball("left_shoulder", ARM, ranges, "arm"))


def hip() -> Joint:
    """Swing and twist of the left thigh."""
    ranges = ((-30, 125), (-30, 45), 45)
    return Joint("left_hip", "root", "left_knee", *_ball("left_hip", LEG, ranges, "thigh"))


def _ball(
    name: str, bone: np.ndarray, ranges: tuple[Range, Range, float], limb: str
) -> tuple[tuple[Row, ...], np.ndarray]:
    """Rows and swing cone of a ball joint; flexion, abduction and twist in degrees."""
    axes = swing_axes(bone, FORWARD, LEFT)
    cone = hanging_cone(bone, axes, *ranges[:2])
    flexion, abduction = np.degrees([cone.min(axis=0), cone.max(axis=0)]).T
    twist = ranges[2]
    rows = (
        Row(
            f"{name}_flexion",
            DofKind.SWING,
            axes[0],
            tuple(flexion),
            FREELY,
            f"lifts the {limb} forwards",
        ),
        Row(
            f"{name}_abduction",
            DofKind.SWING,
            axes[1],
            tuple(abduction),
            FREELY,
            f"lifts the {limb} sideways",
        ),
        Row(
            f"{name}_twist",
            DofKind.HINGE,
            bone,
            (-twist, twist),
            FREELY,
            f"turns the {limb} inwards",
        ),
    )
    return rows, cone


def elbow() -> Joint:
    """The left elbow's hinge, across the arm; the thumb leads."""
    axis = turning(ARM, FORWARD)
    row = Row(
        "left_elbow_flexion", DofKind.HINGE, axis, (0, 150), FREELY, "bends the forearm forwards"
    )
    return Joint("left_elbow", "left_shoulder", "left_wrist", (row,))


def wrist() -> Joint:
    """The forearm's twist, which only the hand shows, and the left wrist's swing."""
    flex, deviate = swing_axes(ARM, PALM, -FORWARD)
    rows = (
        Row("left_forearm_twist", DofKind.HINGE, ARM, (-85, 85), 45, "turns the palm backwards"),
        Row(
            "left_wrist_flexion",
            DofKind.SWING,
            flex,
            (-80, 80),
            30,
            "bends the hand to the palm's side",
        ),
        Row(
            "left_wrist_deviation",
            DofKind.SWING,
            deviate,
            (-20, 30),
            15,
            "bends the hand to the little finger",
        ),
    )
    cone = ellipse_cone((-80, 80), (-20, 30))
    return Joint("left_wrist", "left_elbow", "left_fingertip", rows, cone)


def knee() -> Joint:
    """The left knee's hinge, across the leg."""
    axis = turning(LEG, -FORWARD)
    row = Row(
        "left_knee_flexion", DofKind.HINGE, axis, (0, 150), FREELY, "bends the shank backwards"
    )
    return Joint("left_knee", "left_hip", "left_ankle", (row,))


def ankle(tail: str) -> Joint:
    """The left foot: flexion across it, then inversion about its length."""
    rows = (
        Row(
            "left_ankle_flexion",
            DofKind.HINGE,
            turning(FOOT, UP),
            (-50, 25),
            25,
            "lifts the front of the foot",
        ),
        Row("left_ankle_inversion", DofKind.HINGE, -FOOT, (-25, 25), 10, "turns the sole inwards"),
    )
    return Joint("left_ankle", "left_knee", tail, rows)


def toes() -> Joint:
    """The left toes."""
    row = Row(
        "left_toes_extension", DofKind.HINGE, turning(FOOT, UP), (-40, 60), 10, "lifts the toes"
    )
    return Joint("left_toes", "left_ankle", "left_toe_tip", (row,))
