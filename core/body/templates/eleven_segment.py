"""The body of seed M's Monte Carlo filter: 11 segments, 10 joints of three angles each, 36 DOFs.

Upper and lower half of the trunk meet at the waist; hands are fixed to the lower arms, feet to the
lower legs.
"""

from ..body import Body
from . import anatomy
from .assembly import Plan, Search, Segment, assembled
from .per_axis import elbow_with_forearm, knee_with_foot, per_axis
from .proportions import Proportions
from .skeleton import Joint
from .surfaces import LEVELS, Level

SEGMENTS = (
    Segment("waist", "root", ("pelvis",)),
    Segment("chest", "waist", ("abdomen", "chest", "clavicle")),
    Segment("head", "neck", ("neck", "skull", "jaw")),
    Segment("left_upper_arm", "left_shoulder", ("upper_arm",)),
    Segment("left_lower_arm", "left_elbow", ("forearm", "hand", "thumb")),
    Segment("left_upper_leg", "left_hip", ("thigh",)),
    Segment("left_lower_leg", "left_knee", ("shank", "foot", "toes")),
)

SEARCHES = (
    Search("torso", "torso", ("root",)),
    Search("waist", "spine", ("waist",)),
    Search(
        "left_arm",
        "limb",
        ("left_shoulder", "left_elbow"),
        ("left_shoulder", "left_elbow_flexion"),
    ),
    Search("left_leg", "limb", ("left_hip", "left_knee"), ("left_hip", "left_knee_flexion")),
    Search("head", "end", ("neck",)),
)

CARRIERS = {
    "head": "neck",
    "left_wrist": "left_elbow",
    "left_ankle": "left_knee",
}


def eleven_segment(
    proportions: Proportions | None = None, levels: tuple[Level, ...] = LEVELS
) -> Body:
    """The body ``eleven_segment``; None stands for the average adult of 1.75 m."""
    plan = Plan("eleven_segment", _joints(), SEGMENTS, SEARCHES, CARRIERS)
    return assembled(plan, proportions or Proportions(), levels)


def _joints() -> tuple[Joint, ...]:
    waist = anatomy.spine("waist", "root", "neck", ((-30, 80), 35, 45), (20, 12, 15))
    neck = anatomy.spine("neck", "waist", "skull", ((-55, 55), 45, 75), (20, 15, 20))
    return (
        anatomy.root(),
        per_axis(waist),
        per_axis(neck),
        per_axis(anatomy.shoulder("waist")),
        elbow_with_forearm(),
        per_axis(anatomy.hip()),
        knee_with_foot(),
    )
