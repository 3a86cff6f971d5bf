"""The body of Theobalt et al. 2003: 16 segments, 17 joints, 35 DOFs, a rigid trunk."""

from ..body import Body
from . import anatomy
from .assembly import Plan, Search, Segment, assembled
from .proportions import Proportions
from .skeleton import Joint
from .surfaces import LEVELS, Level

SEGMENTS = (
    Segment("pelvis", "root", ("pelvis",)),
    Segment("abdomen", "waist", ("abdomen",)),
    Segment("chest", "chest", ("chest", "clavicle")),
    Segment("head", "neck", ("neck", "skull", "jaw")),
    Segment("left_upper_arm", "left_shoulder", ("upper_arm",)),
    Segment("left_forearm", "left_elbow", ("forearm",)),
    Segment("left_hand", "left_wrist", ("hand", "thumb")),
    Segment("left_thigh", "left_hip", ("thigh",)),
    Segment("left_shank", "left_knee", ("shank",)),
    Segment("left_foot", "left_ankle", ("foot", "toes")),
)

SEARCHES = (
    Search("torso", "torso", ("root",)),
    Search("left_arm", "limb", ("left_shoulder", "left_elbow"), ("left_shoulder", "left_elbow")),
    Search("left_leg", "limb", ("left_hip", "left_knee"), ("left_hip", "left_knee")),
    Search("head", "end", ("neck",)),
    Search("left_hand", "end", ("left_wrist",)),
    Search("left_foot", "end", ("left_ankle",)),
)


def sixteen_segment(
    proportions: Proportions | None = None, levels: tuple[Level, ...] = LEVELS
) -> Body:
    """The body ``sixteen_segment``; None stands for the average adult of 1.75 m."""
    plan = Plan("sixteen_segment", _joints(), SEGMENTS, SEARCHES, {"head": "neck"})
    return assembled(plan, proportions or Proportions(), levels)


def _joints() -> tuple[Joint, ...]:
    return (
        anatomy.root(),
        Joint("waist", "root", "chest"),
        Joint("chest", "waist", "neck"),
        anatomy.spine("neck", "chest", "skull", ((-55, 55), 45, 75), (20, 15, 20)),
        Joint("head_end", "neck", "head_end"),
        anatomy.shoulder("chest"),
        anatomy.elbow(),
        anatomy.wrist(),
        anatomy.hip(),
        anatomy.knee(),
        anatomy.ankle("left_toe_tip"),
    )
