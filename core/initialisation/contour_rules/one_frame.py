"""The joints of one frame: labelled views, a heading, rays, and whether the result can be."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .corrections import HIP_HALF_WIDTH, shift
from .depth import met
from .heading import LEAST_FRONTAL, Heading, frontal_rays
from .rays import Meeting
from .seen_view import SeenView


@dataclass(frozen=True, eq=False)
class Performer:
    """What is known of the performer before the rules.

    Attributes:
        centre: (3,) the middle of the body, world metres.
        height: metres.
    """

    centre: np.ndarray
    height: float


@dataclass(frozen=True, eq=False)
class FrameJoints:
    """The joints of one frame, in the world.

    Attributes:
        joints: where each of the nine is, in the order of `JOINT_NAMES`, and how well known.
        hips: (2, 3) left and right.
        ankles: (2, 3) left and right.
        heading: how the performer stands.
        used: (V,) bool, the views that they come from.
    """

    joints: tuple[Meeting, ...]
    hips: np.ndarray
    ankles: np.ndarray
    heading: Heading
    used: np.ndarray

    @property
    def points(self) -> np.ndarray:
        """(9, 3) world metres."""
        return np.array([joint.point for joint in self.joints])

    @property
    def left(self) -> np.ndarray:
        """(3,) horizontal unit direction from the right joints to the left ones."""
        points = self.points
        across = (points[[2, 4]] - points[[3, 5]]).sum(axis=0)
        across += self.ankles[0] - self.ankles[1]
        across[2] = 0.0
        return across / np.linalg.norm(across)


def frame_joints(
    views: Sequence[SeenView], heading: Heading, performer: Performer, bent: bool
) -> FrameJoints:
    """The joints that the frontal ones of ``views`` show; ``bent``: elbows were seen."""
    used = np.array([is_frontal(view, heading, performer.centre) for view in views])
    width = _neck_half_width([view for view, use in zip(views, used, strict=True) if use])

    def found(name: str, side: int | None) -> Meeting:
        rays = frontal_rays(views, heading, performer.centre, name, side)
        meeting = met(views, heading, performer.centre, rays)
        if name == "elbows" and not bent:
            return meeting
        outwards = np.zeros(3) if side is None else (heading.left, -heading.left)[side]
        centre = meeting.point + shift(name, outwards, performer.height, width)
        return replace(meeting, point=centre)

    back, neck = found("back", None), found("neck", None)
    arms = [found(name, side) for name in ("shoulders", "elbows", "wrists") for side in (0, 1)]
    feet = [found("ankles", side) for side in (0, 1)]
    half = HIP_HALF_WIDTH * performer.height * heading.left
    foot = Meeting(
        (feet[0].point + feet[1].point) / 2,
        max(foot.gap for foot in feet),
        min(foot.depth for foot in feet),
    )
    return FrameJoints(
        joints=tuple([back, neck, *arms, foot]),
        hips=np.array([back.point + half, back.point - half]),
        ankles=np.array([foot.point for foot in feet]),
        heading=heading,
        used=used,
    )


def is_frontal(view: SeenView, heading: Heading, centre: np.ndarray) -> bool:
    """Whether a view's labels are used."""
    return view.joints is not None and heading.frontality(view, centre) >= LEAST_FRONTAL


def _neck_half_width(views: Sequence[SeenView]) -> float:
    return float(np.mean([v.joints.cuts["neck"].length for v in views if v.joints])) / 2
