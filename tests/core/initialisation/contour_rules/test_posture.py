"""What of a frame's joints cannot be the pose."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.initialisation.contour_rules.heading import Heading
from silhouette_mocap.core.initialisation.contour_rules.one_frame import FrameJoints
from silhouette_mocap.core.initialisation.contour_rules.posture import fault_of
from silhouette_mocap.core.initialisation.contour_rules.rays import Meeting
from silhouette_mocap.core.initialisation.contour_rules.skeleton import JOINT_NAMES

A_POSE = np.array([
    [0, 0, 0.95], [0, 0, 1.52], [0.18, 0, 1.43], [-0.18, 0, 1.43], [0.38, 0, 1.23],
    [-0.38, 0, 1.23], [0.57, 0, 1.04], [-0.57, 0, 1.04], [0, 0, 0.08],
])  # fmt: skip


def frame(points: np.ndarray) -> FrameJoints:
    return FrameJoints(
        joints=tuple(Meeting(point, 0.02, 0.2) for point in points),
        hips=np.zeros((2, 3)),
        ankles=np.array([[0.15, 0.0, 0.08], [-0.15, 0.0, 0.08]]),
        heading=Heading(np.array([1.0, 0.0, 0.0]), True, 0.0),
        used=np.ones(2, bool),
    )


def moved(name: str, by: tuple[float, float, float]) -> np.ndarray:
    points = A_POSE.copy()
    points[JOINT_NAMES.index(name)] += by
    return points


def test_an_a_pose_is_one():
    assert fault_of(frame(A_POSE), "A", 1.75) == ""


def test_a_trunk_that_leans_is_bent_over():
    points = A_POSE.copy()
    turn = Rotation.from_euler("x", 50, degrees=True)
    points[1:8] = turn.apply(points[1:8] - points[0]) + points[0]
    assert "bent over: the trunk lean by 50°" in fault_of(frame(points), "A", 1.75)


@pytest.mark.parametrize(
    ("points", "kind", "words"),
    [
        (moved("neck", (0, 0, 0.4)), "A", "the trunk would be 0.55"),
        (moved("virtual_foot", (0, 0, 0.5)), "A", "the legs would be 0.21"),
        (moved("left_elbow", (-0.15, 0, -0.1)), "A", "the left upper arm is 9° from hanging"),
        (A_POSE, "T", "upper arm is 45° from hanging, not 65 to 120"),
        (moved("right_wrist", (0, 0, 0.3)), "elbows", "right forearm is 120° from hanging down"),
        (moved("right_wrist", (0.15, 0, 0.17)), "A", "one arm would be 328 mm long"),
    ],
)
def test_what_cannot_be_is_told_in_words(points, kind, words):
    assert words in fault_of(frame(points), kind, 1.75)


@pytest.mark.parametrize(
    ("change", "words"),
    [({"gap": 0.2}, "disagree about the neck by 200 mm"), ({"depth": 0.001}, "too close together")],
)
def test_joints_that_are_badly_known_are_told(change, words):
    good = frame(A_POSE)
    joints = list(good.joints)
    joints[1] = replace(joints[1], **change)
    assert words in fault_of(replace(good, joints=tuple(joints)), "A", 1.75)
