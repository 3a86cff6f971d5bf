"""The default body: 49 DOFs, a moving spine, shoulder girdle, head on a neck, toes."""

from ..body import Body
from . import anatomy
from .assembly import Plan, Search, Segment, assembled
from .landmarks import landmarks
from .proportions import Proportions
from .skeleton import Joint
from .surfaces import LEVELS, Level

SEGMENTS = (
    Segment("pelvis", "root", ("pelvis",)),
    Segment("abdomen", "waist", ("abdomen",)),
    Segment("chest", "chest", ("chest",)),
    Segment("neck", "neck", ("neck",)),
    Segment("head", "head", ("skull", "jaw")),
    Segment("left_clavicle", "left_clavicle", ("clavicle",)),
    Segment("left_upper_arm", "left_shoulder", ("upper_arm",)),
    Segment("left_forearm", "left_elbow", ("forearm",)),
    Segment("left_hand", "left_wrist", ("hand", "thumb")),
    Segment("left_thigh", "left_hip", ("thigh",)),
    Segment("left_shank", "left_knee", ("shank",)),
    Segment("left_foot", "left_ankle", ("foot",)),
    Segment("left_toes", "left_toes", ("toes",)),
)

SEARCHES = (
    Search("torso", "torso", ("root",)),
    Search("spine", "spine", ("waist", "chest")),
    Search(
        "left_arm",
        "limb",
        ("left_clavicle", "left_shoulder", "left_elbow"),
        ("left_shoulder", "left_elbow"),
    ),
    Search("left_leg", "limb", ("left_hip", "left_knee"), ("left_hip", "left_knee")),
    Search("head", "end", ("neck", "head")),
    Search("left_hand", "end", ("left_wrist",)),
    Search("left_foot", "end", ("left_ankle", "left_toes")),
)


def performer(proportions: Proportions | None = None, levels: tuple[Level, ...] = LEVELS) -> Body:
    """The body ``performer``; None stands for the average adult of 1.75 m."""
    proportions = proportions or Proportions()
    plan = Plan("performer", _joints(proportions), SEGMENTS, SEARCHES)
    return assembled(plan, proportions, levels)


def _joints(proportions: Proportions) -> tuple[Joint, ...]:
    places = landmarks(proportions)
    girdle = places["left_shoulder"] - places["left_clavicle"]
    return (
        anatomy.root(),
        anatomy.spine("waist", "root", "chest", ((-15, 45), 20, 15), (12, 8, 8)),
        anatomy.spine("chest", "waist", "neck", ((-15, 35), 15, 30), (10, 8, 10)),
        anatomy.spine("neck", "chest", "head", ((-35, 35), 45, 40), (15, 15, 15)),
        anatomy.head(),
        anatomy.clavicle(girdle),
        anatomy.shoulder("left_clavicle"),
        anatomy.elbow(),
        anatomy.wrist(),
        anatomy.hip(),
        anatomy.knee(),
        anatomy.ankle("left_toes"),
        anatomy.toes(),
    )
