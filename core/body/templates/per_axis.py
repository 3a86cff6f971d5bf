"""Joints of three angles each, about one axis after the other, as seeds M and J count them.

The Monte Carlo filter of seed M holds each joint as three angles with an interval each, without
cones. Elbows and knees get the two they lack: their lateral play, and the turn of what they carry.
Their ranges are those that ligaments leave (our resolution, as the seeds name none).
"""

from dataclasses import replace

from ..body import DofKind
from . import anatomy
from .landmarks import ARM, FORWARD, LEG, UP
from .skeleton import Joint, Row, swing_axes

_PLAY, _PLAY_SPREAD = (-5, 5), 3


def per_axis(joint: Joint) -> Joint:
    """The joint with a hinge for each half of its swing, limited by intervals alone.

    It turns about its first axis, then about the second and the third where the turns before have
    brought them.
    """
    rows = tuple(replace(row, kind=DofKind.HINGE) for row in joint.rows)
    return replace(joint, rows=rows, cone=None)


def elbow_with_forearm() -> Joint:
    """The left elbow: flexion, play, and the forearm's twist, which only the hand shows."""
    twist, *_ = anatomy.wrist().rows
    return _with(anatomy.elbow(), _elbow_play(), twist)


def elbow_with_play() -> Joint:
    """The left elbow above a wrist that twists the forearm: flexion, and play about two axes."""
    twist = Row(
        "left_elbow_twist", DofKind.HINGE, ARM, _PLAY, _PLAY_SPREAD, "turns the forearm inwards"
    )
    return _with(anatomy.elbow(), _elbow_play(), twist)


def knee_with_foot() -> Joint:
    """The left knee of a shank that holds the foot: flexion, play, and the turn of the foot."""
    _, sideways = swing_axes(LEG, -FORWARD, UP)
    play = Row(
        "left_knee_lateral",
        DofKind.HINGE,
        sideways,
        _PLAY,
        _PLAY_SPREAD,
        "bends the shank outwards",
    )
    twist = Row("left_knee_twist", DofKind.HINGE, LEG, (-30, 30), 10, "turns the toes inwards")
    return _with(anatomy.knee(), play, twist)


def _elbow_play() -> Row:
    _, sideways = swing_axes(ARM, FORWARD, UP)
    words = "bends the forearm outwards"
    return Row("left_elbow_lateral", DofKind.HINGE, sideways, _PLAY, _PLAY_SPREAD, words)


def _with(joint: Joint, *rows: Row) -> Joint:
    return replace(joint, rows=(*joint.rows, *rows))
