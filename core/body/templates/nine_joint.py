"""The body of Jaume-i-Capó et al. 2012: nine joints of three DOFs, 30 DOFs in all.

The joints are those that a silhouette's contour tells in the initial pose: back, neck, shoulders,
elbows, wrists, and the virtual foot, midpoint of the feet. It carries the virtual leg, both legs as
one rigid segment, and is the root; the back, between the hips, bends the trunk over it. It is a
body to be measured (`measures`) and tracked standing: it cannot walk.
"""

from dataclasses import replace

import numpy as np

from ..body import Body
from ..kinematics import rest_joints
from . import anatomy
from .assembly import Plan, Search, Segment, assembled
from .per_axis import elbow_with_play
from .proportions import Proportions
from .skeleton import Joint
from .surfaces import LEVELS, Level

SEGMENTS = (
    Segment("virtual_leg", "virtual_foot", ("thigh", "shank", "foot", "toes")),
    Segment("trunk", "back", ("pelvis", "abdomen", "chest", "clavicle")),
    Segment("head", "neck", ("neck", "skull", "jaw")),
    Segment("left_arm", "left_shoulder", ("upper_arm",)),
    Segment("left_forearm", "left_elbow", ("forearm",)),
    Segment("left_hand", "left_wrist", ("hand", "thumb")),
)

SEARCHES = (
    Search("torso", "torso", ("virtual_foot",)),
    Search("back", "spine", ("back",)),
    Search(
        "left_arm",
        "limb",
        ("left_shoulder", "left_elbow"),
        ("left_shoulder", "left_elbow_flexion"),
    ),
    Search("head", "end", ("neck",)),
    Search("left_hand", "end", ("left_wrist",)),
)

CARRIERS = {
    "head": "neck",
    "left_hip": "virtual_foot",
    "left_knee": "virtual_foot",
    "left_ankle": "virtual_foot",
}

MEASURES = {
    "forearm": ("left_wrist", "left_elbow"),
    "arm": ("left_shoulder", "left_elbow"),
    "trunk": ("back", "neck"),
    "upper back": ("back", "left_shoulder"),
    "virtual leg": ("virtual_foot", "back"),
}
"""What the paper measures, as distances of joints; both sides are alike."""


def nine_joint(proportions: Proportions | None = None, levels: tuple[Level, ...] = LEVELS) -> Body:
    """The body ``nine_joint``; None stands for the average adult of 1.75 m."""
    plan = Plan("nine_joint", _joints(), SEGMENTS, SEARCHES, CARRIERS)
    return assembled(plan, proportions or Proportions(), levels)


def _joints() -> tuple[Joint, ...]:
    return (
        replace(anatomy.root(), name="virtual_foot", tail="back"),
        # it does what hips and waist do in other bodies
        anatomy.spine("back", "virtual_foot", "neck", ((-30, 125), 45, 45), (20, 12, 15)),
        anatomy.spine("neck", "back", "skull", ((-55, 55), 45, 75), (20, 15, 20)),
        anatomy.shoulder("back"),
        elbow_with_play(),
        anatomy.wrist(),
    )


def measures(body: Body) -> dict[str, float]:
    """The `MEASURES` of a body ``nine_joint``, metres."""
    places = dict(zip(body.joint_names, rest_joints(body), strict=True))
    return {name: float(np.linalg.norm(places[a] - places[b])) for name, (a, b) in MEASURES.items()}
