"""From silhouettes to a skeleton: the whole method on one screen."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...cameras.camera import Camera
from ...errors import MocapError
from ...silhouettes.place import performer_centre
from ...silhouettes.silhouette import Silhouette
from ..pose_kinds import POSE_KINDS
from ..standing import standing_height
from .heading import Heading, heading_of
from .labelling import MODES, ORDER
from .one_frame import FrameJoints, Performer, frame_joints
from .posture import fault_of
from .rays import Meeting
from .seen_view import SeenView, reasons, seen_view
from .skeleton import HAND_TIP, JOINT_NAMES, SKIN, ContourSkeleton, measured
from .wrists import skin_of, skin_wrist

BENT = "elbows"
"""The kind of pose that shows the elbows."""
_ASKED = {
    "A": "legs apart and straight arms 45° out",
    "T": "legs apart and straight arms level",
    "elbows": "legs apart, upper arms lifted and forearms hanging free",
}
Colours = tuple[np.ndarray, ...]


@dataclass(frozen=True)
class ContourSettings:
    """How the rules are read, and what is known.

    Attributes:
        mode: of labelling, one of `MODES`.
        floor: height of the floor in the world, metres.
        height_m: the performer's; None to measure it.
    """

    mode: str = ORDER
    floor: float = 0.0
    height_m: float | None = None

    def __post_init__(self):
        if self.mode not in MODES:
            raise ValueError(f"expected a mode of {MODES}, got {self.mode}")


DEFAULT = ContourSettings()


@dataclass(frozen=True, eq=False)
class _Shown:
    """What became of one frame: joints, or a fault."""

    joints: FrameJoints | None
    wrist_source: tuple[str, str]
    fault: str


def contour_skeleton(
    cameras: tuple[Camera, ...],
    frames: tuple[tuple[Silhouette, ...], ...],
    kind: str,
    colours: tuple[Colours, ...] | None = None,
    settings: ContourSettings = DEFAULT,
) -> ContourSkeleton:
    """The nine joints and five measures that the contours of ``frames`` show.

    Args:
        cameras: V pinhole cameras.
        frames: of each, V silhouettes of the performer in the initial pose.
        kind: "A", "T" or "elbows".
        colours: of each frame, V pictures (H, W, 3) uint8 BGR as the cameras see it, for the
            wrists; None without.
        settings: how the rules are read.

    Raises:
        MocapError: an unknown kind, or no frame that shows the pose in two views.
    """
    check_kind(kind)
    pictures = colours or (None,) * len(frames)
    shown = [
        _shown(cameras, silhouettes, kind, picture, settings)
        for silhouettes, picture in zip(frames, pictures, strict=True)
    ]
    shown = _facing_alike(shown)
    if not any(one.joints for one in shown):
        raise MocapError(
            f'the contours do not show the initial pose "{kind}": {shown[0].fault}',
            f"let two cameras see the performer from the front, with {_ASKED[kind]}; or give "
            "other initial_pose frames or another kind",
        )
    return _skeleton(shown, len(cameras), kind)


def _facing_alike(shown: list[_Shown]) -> list[_Shown]:
    """Without the joints of frames in which the performer seems to look the other way."""
    lefts = [one.joints.heading.left for one in shown if one.joints]
    usual = np.sum(lefts, axis=0)

    def kept(one: _Shown) -> _Shown:
        if one.joints is None or one.joints.heading.left @ usual > 0:
            return one
        return replace(one, joints=None, fault="the performer seems to look the other way")

    return [kept(one) for one in shown]


def check_kind(kind: str) -> None:
    """Refuses a pose that is not one of `POSE_KINDS`.

    Raises:
        MocapError: it is not.
    """
    if kind not in POSE_KINDS:
        raise MocapError(
            f'initial_pose kind "{kind}" is unknown', f"use one of {', '.join(POSE_KINDS)}"
        )


def performer_in(
    cameras: tuple[Camera, ...], silhouettes: tuple[Silhouette, ...], settings: ContourSettings
) -> Performer | None:
    """Where the performer is, and how tall; None where fewer than two views show anybody."""
    centre = performer_centre(cameras, silhouettes)
    if centre is None:
        return None
    height = settings.height_m
    if height is None:
        height = standing_height(cameras, silhouettes, centre, settings.floor)
    return Performer(centre, height)


def seen_views(
    cameras: tuple[Camera, ...],
    silhouettes: tuple[Silhouette, ...],
    performer: Performer,
    rules: tuple[str, str],
) -> tuple[SeenView, ...]:
    """What each view shows by ``rules``: the kind of the pose and the mode of labelling."""
    return tuple(
        seen_view(camera, silhouette, performer.centre, rules)
        for camera, silhouette in zip(cameras, silhouettes, strict=True)
    )


def _shown(
    cameras: tuple[Camera, ...],
    silhouettes: tuple[Silhouette, ...],
    kind: str,
    pictures: Colours | None,
    settings: ContourSettings,
) -> _Shown:
    nowhere = (HAND_TIP, HAND_TIP)
    performer = performer_in(cameras, silhouettes, settings)
    if performer is None:
        return _Shown(None, nowhere, "fewer than two views show anybody")
    views = seen_views(cameras, silhouettes, performer, (kind, settings.mode))
    heading = heading_of(views, performer.centre)
    if heading is None:
        labelled = sum(view.joints is not None for view in views)
        fault = f"{labelled} of {len(views)} views show it, and no two agree; {reasons(views)}"
        return _Shown(None, nowhere, fault.removesuffix("; "))
    bent = kind == BENT
    joints = frame_joints(views, heading, performer, bent)
    # once more along the line of the joints themselves, which know of the views from the side, too
    joints = frame_joints(views, replace(heading, left=joints.left), performer, bent)
    source = nowhere
    if pictures is not None:
        joints, source = _with_skin_wrists(joints, views, pictures, performer)
    fault = fault_of(joints, kind, performer.height)
    return _Shown(None if fault else joints, source, fault)


def _with_skin_wrists(
    joints: FrameJoints, views: Sequence[SeenView], pictures: Colours, performer: Performer
) -> tuple[FrameJoints, tuple[str, str]]:
    """The joints with the wrists that colour shows, and where each comes from."""
    skins = [
        skin_of(picture, view.silhouette.foreground)
        for view, picture in zip(views, pictures, strict=True)
    ]
    found: list[Meeting] = list(joints.joints)
    sources = [HAND_TIP, HAND_TIP]
    for side in (0, 1):
        wrist = skin_wrist(views, skins, joints, performer, side)
        if wrist is not None:
            found[JOINT_NAMES.index("left_wrist") + side] = wrist
            sources[side] = SKIN
    return replace(joints, joints=tuple(found)), (sources[0], sources[1])


def _skeleton(shown: Sequence[_Shown], view_count: int, kind: str) -> ContourSkeleton:
    def stacked(values, shape: tuple[int, ...], missing: float) -> np.ndarray:
        """(F, …) of every frame; ``missing`` where it shows no pose."""
        empty = np.full(shape, missing)
        return np.array([empty if one.joints is None else values(one.joints) for one in shown])

    joints = stacked(lambda j: j.points, (9, 3), np.nan)
    usable = [one for one in shown if one.joints is not None]
    sources = [sorted(one.wrist_source[side] for one in usable) for side in (0, 1)]
    return ContourSkeleton(
        joint_names=JOINT_NAMES,
        joints=joints,
        gaps_mm=stacked(lambda j: [1000 * joint.gap for joint in j.joints], (9,), np.nan),
        hips=stacked(lambda j: j.hips, (2, 3), np.nan),
        ankles=stacked(lambda j: j.ankles, (2, 3), np.nan),
        left=stacked(lambda j: j.heading.left, (3,), np.nan),
        views=stacked(lambda j: j.used, (view_count,), 0.0).astype(bool),
        elbow_observed=kind == BENT,
        wrist_source=(sources[0][len(usable) // 2], sources[1][len(usable) // 2]),
        measures=measured(joints),
        faults=tuple(one.fault for one in shown),
        notes=tuple(_notes(shown, usable, kind)),
    )


def _notes(shown: Sequence[_Shown], usable: Sequence[_Shown], kind: str) -> list[str]:
    notes = []
    if len(usable) < len(shown):
        fault = next(one.fault for one in shown if one.fault)
        notes.append(
            f"{len(shown) - len(usable)} of {len(shown)} frames do not show the pose: {fault}"
        )
    headings: list[Heading] = [one.joints.heading for one in usable if one.joints]
    if not all(heading.told_by_toes for heading in headings):
        notes.append(
            "no view tells front from back by the feet: the performer is taken to face most of the "
            "cameras that show the pose"
        )
    if kind != BENT:
        notes.append(
            "straight arms show no elbow: elbows are shares of the arm's length until frames "
            "with bent arms tell more"
        )
    for side, name in enumerate(("left", "right")):
        if any(one.wrist_source[side] == HAND_TIP for one in usable):
            notes.append(f"the {name} wrist is a {HAND_TIP}, as no skin showed where the hand ends")
    return notes
