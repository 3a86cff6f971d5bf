"""The skeleton of bodies whose joints are known."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.cameras.presets import Ring, ring
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.initialisation.contour_rules.from_frames import (
    ContourSettings,
    contour_skeleton,
)
from silhouette_mocap.core.initialisation.contour_rules.skeleton import (
    HAND_TIP,
    JOINT_NAMES,
    SKIN,
    ContourSkeleton,
)
from silhouette_mocap.core.initialisation.pose_kinds import pose_of_kind
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import dof_values, filmed, small_body

KNOWN_HEIGHT = ContourSettings(height_m=1.75)


@cache
def studio(count: int = 8, first_angle_deg: float = 22.5) -> tuple[Camera, ...]:
    """Cameras of 320 x 240 px, 16 mm per px at the performer."""
    return ring(
        Ring(count, heights=(1.0, 1.6), first_angle_deg=first_angle_deg, size=(320, 240),
             focal_px=250.0)
    )  # fmt: skip


def standing(kind: str) -> np.ndarray:
    return pose_of_kind(small_body("performer"), kind)


@cache
def seen(kind: str, cameras: tuple[Camera, ...]) -> tuple[Silhouette, ...]:
    return filmed(small_body("performer"), cameras, standing(kind))


def truth(pose: np.ndarray) -> np.ndarray:
    """(9, 3) of `JOINT_NAMES`."""
    body = small_body("performer")
    known = dict(zip(POINT_NAMES, points(body, pose[None])[0], strict=True))
    known["back"] = (known["left_hip"] + known["right_hip"]) / 2
    known["virtual_foot"] = (known["left_ankle"] + known["right_ankle"]) / 2
    return np.array([known[name] for name in JOINT_NAMES])


def errors(found: ContourSkeleton, pose: np.ndarray, frame: int = 0) -> dict[str, float]:
    apart = np.linalg.norm(found.joints[frame] - truth(pose), axis=1)
    return dict(zip(JOINT_NAMES, apart, strict=True))


@pytest.mark.parametrize("kind", ["A", "T", "elbows"])
def test_the_joints_of_a_known_body_are_found(kind):
    found = contour_skeleton(studio(), (seen(kind, studio()),), kind)
    apart = errors(found, standing(kind))
    # two pixels of 16 mm: creases are rounded over 2 % of the height, 35 mm
    assert max(apart.values()) < 0.035, apart
    assert found.gaps_mm.max() < 50
    assert found.elbow_observed == (kind == "elbows")
    assert found.wrist_source == (HAND_TIP, HAND_TIP)
    assert found.left[0] == pytest.approx([1, 0, 0], abs=0.1)


def test_hips_and_ankles_of_both_sides_and_the_measures_are_told():
    found = contour_skeleton(studio(), (seen("A", studio()),) * 2, "A")
    known = dict(
        zip(POINT_NAMES, points(small_body("performer"), standing("A")[None])[0], strict=True)
    )
    for name, places in (("hip", found.hips), ("ankle", found.ankles)):
        for side, which in enumerate(("left", "right")):
            assert np.linalg.norm(places[0, side] - known[f"{which}_{name}"]) < 0.05
    # the mean of both sides, of joints within the 35 mm above
    upper = np.linalg.norm(known["left_elbow"] - known["left_shoulder"])
    assert found.measures["arm"].mean == pytest.approx(upper, abs=0.05)
    assert found.measures["arm"].spread == pytest.approx(0.0, abs=1e-9)
    assert found.shown.all() and found.views.shape == (2, 8)


def test_literal_extremes_find_the_neck_and_the_back_of_a_clean_outline():
    literal = ContourSettings(mode="literal")
    found = contour_skeleton(studio(), (seen("elbows", studio()),), "elbows", settings=literal)
    apart = errors(found, standing("elbows"))
    assert max(apart[name] for name in ("back", "neck", "virtual_foot")) < 0.05, apart


def test_two_cameras_in_front_are_enough():
    pair = ring(Ring(12, heights=(1.0,), first_angle_deg=-15.0, size=(320, 240), focal_px=250.0))
    found = contour_skeleton(pair[:2], (seen("elbows", pair[:2]),), "elbows", settings=KNOWN_HEIGHT)
    # an angle of 30° leaves depth four times as unsure as the rest
    assert max(errors(found, standing("elbows")).values()) < 0.1


def test_two_cameras_behind_see_the_left_side_on_the_left():
    pair = ring(Ring(8, heights=(1.0,), first_angle_deg=157.5, size=(320, 240), focal_px=250.0))
    found = contour_skeleton(pair[:2], (seen("T", pair[:2]),), "T", settings=KNOWN_HEIGHT)
    assert max(errors(found, standing("T")).values()) < 0.1
    assert not any("face" in note for note in found.notes)


def test_where_no_view_tells_front_from_back_the_performer_faces_the_cameras():
    low, high = (
        ring(Ring(1, heights=(height,), size=(320, 240), focal_px=250.0))[0]
        for height in (0.8, 2.6)
    )
    above = low, replace(high, name="cam_02")
    found = contour_skeleton(above, (seen("A", above),), "A", settings=KNOWN_HEIGHT)
    assert found.left[0] == pytest.approx([1, 0, 0], abs=0.05)
    assert any("taken to face most of the cameras" in note for note in found.notes)


def test_views_from_the_side_tell_the_depth_that_cameras_face_to_face_cannot():
    four = ring(Ring(4, heights=(1.0,), size=(320, 240), focal_px=250.0))
    found = contour_skeleton(four, (seen("A", four),), "A")
    assert found.views[0].tolist() == [True, False, True, False]
    assert max(errors(found, standing("A")).values()) < 0.06
    facing = four[0], four[2]
    with pytest.raises(MocapError, match="face each other or stand too close"):
        contour_skeleton(facing, (seen("A", facing),), "A", settings=KNOWN_HEIGHT)


@pytest.mark.parametrize("degrees", [50.0, 180.0, 300.0])
def test_left_and_right_do_not_depend_on_which_way_the_performer_looks(degrees):
    turned = standing("A")
    turned[small_body("performer").dofs.names.index("root_yaw")] = np.radians(degrees)
    found = contour_skeleton(studio(), (filmed(small_body("performer"), studio(), turned),), "A")
    assert max(errors(found, turned).values()) < 0.06


def test_a_frame_that_seems_to_show_the_back_is_told_apart():
    cameras, body = studio(), small_body("performer")
    behind = standing("A")
    behind[body.dofs.names.index("root_yaw")] = np.pi
    frames = (seen("A", cameras), filmed(body, cameras, behind), seen("A", cameras))
    found = contour_skeleton(cameras, frames, "A")
    assert found.shown.tolist() == [True, False, True]
    assert "the other way" in found.faults[1]


def test_a_camera_on_its_side_changes_nothing():
    upright = studio()
    quarter = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    rolled = tuple(
        replace(
            camera,
            size=(240, 320),
            matrix=np.array([[250.0, 0, 119.5], [0, 250.0, 159.5], [0, 0, 1.0]]),
            camera_from_world=quarter @ camera.camera_from_world,
        )
        for camera in upright
    )
    silhouettes = tuple(
        Silhouette(np.rot90(s.foreground, -1), np.rot90(s.observed, -1)) for s in seen("A", upright)
    )
    known = contour_skeleton(upright, (seen("A", upright),), "A", settings=KNOWN_HEIGHT)
    found = contour_skeleton(rolled, (silhouettes,), "A", settings=KNOWN_HEIGHT)
    # the pixels' grid is the same, its rounding is not
    assert found.joints == pytest.approx(known.joints, abs=0.01)


def test_a_camera_that_shows_something_else_is_outvoted():
    cameras = studio()
    silhouettes = list(seen("A", cameras))
    wrong = np.roll(silhouettes[0].foreground, 12, axis=1)
    silhouettes[0] = Silhouette(wrong, silhouettes[0].observed)
    found = contour_skeleton(cameras, (tuple(silhouettes),), "A")
    # half of the 190 mm, 12 px, that one of the four frontal cameras is off
    assert max(errors(found, standing("A")).values()) < 0.095


@pytest.mark.parametrize(
    ("wrong", "asked", "words"),
    [("A", "T", "not 65 to 120"), ("T", "A", "not 20 to 72"), ("T", "elbows", "0 of 8 views")],
)
def test_another_pose_than_the_one_asked_for_is_refused(wrong, asked, words):
    with pytest.raises(MocapError, match=words) as refused:
        contour_skeleton(studio(), (seen(wrong, studio()),), asked)
    assert "legs apart" in str(refused.value)


@pytest.mark.parametrize(
    "values",
    [
        {"left_shoulder_abduction": -0.75, "right_shoulder_abduction": -0.75},
        {"left_shoulder_abduction": -0.75},
        {"left_hip_abduction": -0.1, "right_hip_abduction": -0.1},
        {"waist_flexion": 1.3},
        {"left_shoulder_flexion": 1.5, "right_shoulder_flexion": 1.5},
    ],
    ids=["arms down", "one arm down", "legs together", "bent over", "arms forwards"],
)
def test_a_frame_that_does_not_show_the_pose_is_told_apart(values):
    cameras = studio()
    other = filmed(small_body("performer"), cameras, dof_values(small_body("performer"), **values))
    found = contour_skeleton(cameras, (seen("A", cameras), other), "A")
    assert found.shown.tolist() == [True, False]
    assert np.isnan(found.joints[1]).all() and np.isfinite(found.joints[0]).all()
    assert found.faults[1] and "1 of 2 frames do not show the pose" in found.notes[0]
    assert found.measures["trunk"].spread == 0


@pytest.mark.parametrize("hidden", ["beyond the picture", "under an ignore mask"])
def test_a_performer_whose_feet_are_not_seen_is_not_labelled_there(hidden):
    cameras = studio()
    silhouettes = list(seen("A", cameras))
    for view in (0, 3):
        foreground = silhouettes[view].foreground.copy()
        observed = np.ones_like(foreground)
        lowest = int(np.flatnonzero(foreground.any(axis=1))[-1])
        if hidden == "beyond the picture":
            down = len(foreground) - lowest + 3
            foreground[down:], foreground[:down] = foreground[:-down].copy(), False
        else:
            observed[lowest - 4 :] = False
        silhouettes[view] = Silhouette(foreground & observed, observed)
    found = contour_skeleton(cameras, (tuple(silhouettes),), "A", settings=KNOWN_HEIGHT)
    assert not found.views[0, [0, 3]].any() and found.views[0].sum() == 2


def test_wrists_come_from_the_colour_of_the_hands_where_there_is_colour():
    cameras = ring(Ring(6, heights=(1.0, 1.6), size=(640, 480), focal_px=500.0))
    body, pose = small_body("performer"), standing("elbows")
    silhouettes = seen("elbows", cameras)
    evaluator = NativeEvaluator(body, cameras)
    hands = [k for k, name in enumerate(body.segment_names) if "hand" in name]
    pictures = []
    for hand, silhouette in zip(evaluator.silhouettes(pose, hands), silhouettes, strict=True):
        picture = np.full((*hand.shape, 3), (140, 90, 60), np.uint8)
        picture[hand & silhouette.foreground] = (120, 150, 205)
        pictures.append(picture)
    found = contour_skeleton(cameras, (silhouettes,), "elbows", colours=(tuple(pictures),))
    assert found.wrist_source == (SKIN, SKIN)
    assert not any("wrist" in note for note in found.notes)
    apart = errors(found, pose)
    # the ellipse is shorter than the hand
    assert max(apart["left_wrist"], apart["right_wrist"]) < 0.04


def test_an_empty_scene_an_unknown_kind_and_an_unknown_mode_are_refused():
    cameras = studio()
    nobody = tuple(Silhouette(np.zeros_like(s.foreground), s.observed) for s in seen("A", cameras))
    with pytest.raises(MocapError, match="fewer than two views show anybody"):
        contour_skeleton(cameras, (nobody,), "A")
    with pytest.raises(MocapError, match='kind "Y" is unknown'):
        contour_skeleton(cameras, (nobody,), "Y")
    with pytest.raises(ValueError, match="mode"):
        ContourSettings(mode="free")
