from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import joint_positions, within_limits
from silhouette_mocap.core.fitting.contour import ContourTracker
from silhouette_mocap.core.fitting.tracker import Past
from silhouette_mocap.core.fitting.turns import heading_dof, turned
from synthetic import dof_values, evaluator, filmed, point_errors, small_body, small_studio

LEGS = [f"{side}_{joint}" for side in ("left", "right") for joint in ("knee", "ankle")]


@pytest.fixture(scope="module")
def scene():
    return small_body("performer"), small_studio(4)


def test_the_trunk_turns_while_the_feet_stay_and_the_arms_are_as_they_were_or_rest(scene):
    body, cameras = scene
    bent = {"left_elbow_flexion": 1.2, "left_knee_flexion": 0.5, "left_hip_flexion": 0.4}
    pose = dof_values(body, root_yaw=0.3, **bent)
    poses = turned(evaluator(body, cameras), pose)[:-2]
    turns = poses[:, heading_dof(body)] - 0.3
    assert turns.min() < -1.0
    assert turns.max() > 1.0
    assert within_limits(body, poses).all()
    legs = [body.joint_names.index(name) for name in LEGS]
    whole = np.repeat(pose[None], len(turns), axis=0)
    whole[:, heading_dof(body)] += turns
    own, held, carried = (joint_positions(body, p)[:, legs] for p in (pose[None], poses, whole))
    moved, unheld = (np.linalg.norm(places - own, axis=2).max() for places in (held, carried))
    assert moved < 0.5 * unheld
    elbow = body.dofs.names.index("left_elbow_flexion")
    assert set(np.round(poses[:, elbow], 6)) == {0.0, 1.2}


def test_the_pose_itself_is_none_of_them(scene):
    body, cameras = scene
    pose = dof_values(body, left_elbow_flexion=1.2)
    apart = np.abs(turned(evaluator(body, cameras), pose) - pose).max(axis=1)
    assert apart.min() > 0.1


def test_a_trunk_that_faces_elsewhere_is_turned_back_once_frames_stay_unexplained(scene):
    body, cameras = scene
    bent = {"left_elbow_flexion": 1.6, "right_elbow_flexion": 1.9}
    raised = {"left_shoulder_flexion": 1.2, "right_shoulder_flexion": 1.0}
    truth = dof_values(body, root_yaw=0.6, **raised, **bent)
    lowered = {"left_shoulder_abduction": -0.8, "right_shoulder_abduction": -0.8}
    lost = dof_values(body, root_yaw=-0.4, **lowered, **bent)
    seen = filmed(body, cameras, truth)
    tracker = ContourTracker(body, cameras, evaluator)
    errors = {}
    for amiss in (0, 3):
        past = replace(Past.still(lost), usual=np.zeros(5), amiss=amiss)
        errors[amiss] = point_errors(body, tracker.fit(seen, past).pose, truth)
    assert np.mean(list(errors[0].values())) > 0.1
    assert np.mean(list(errors[3].values())) < 0.05
    assert max(errors[3][name] for name in ("left_shoulder", "right_shoulder")) < 0.08


def test_the_body_about_and_its_legs_exchanged_are_tried_too(scene):
    body, cameras = scene
    pose = dof_values(body, root_yaw=0.3, left_knee_flexion=0.5, right_elbow_flexion=1.2)
    about, legs = turned(evaluator(body, cameras), pose)[-2:]
    bent = {"right_knee_flexion": 0.5, "left_elbow_flexion": 1.2}
    np.testing.assert_allclose(about, dof_values(body, root_yaw=0.3 - np.pi, **bent))
    exchanged = {"right_knee_flexion": 0.5, "right_elbow_flexion": 1.2}
    np.testing.assert_allclose(legs, dof_values(body, root_yaw=0.3, **exchanged))


@pytest.mark.parametrize(
    ("truth", "lost"),
    [
        (
            {
                "root_yaw": 3.0,
                "left_shoulder_flexion": 1.3,
                "right_shoulder_flexion": 0.9,
                "left_elbow_flexion": 1.2,
                "right_elbow_flexion": 0.9,
                "left_hip_flexion": 0.9,
                "left_knee_flexion": 1.2,
            },
            {"root_yaw": -0.1},
        ),
        (
            {"left_hip_flexion": 0.6, "right_hip_flexion": -0.3, "left_knee_flexion": 0.3},
            {"right_hip_flexion": 0.6, "left_hip_flexion": -0.3, "right_knee_flexion": 0.3},
        ),
    ],
    ids=["faces the other way", "legs exchanged"],
)
def test_left_and_right_are_set_right_once_frames_stay_unexplained(truth, lost):
    body, cameras = small_body("performer"), small_studio()
    seen = filmed(body, cameras, dof_values(body, **truth))
    tracker = ContourTracker(body, cameras, evaluator)
    errors = []
    for amiss in (0, 3):
        past = replace(Past.still(dof_values(body, **lost)), usual=np.zeros(5), amiss=amiss)
        found = point_errors(body, tracker.fit(seen, past).pose, dof_values(body, **truth))
        errors.append(np.mean(list(found.values())))
    assert errors[0] > 0.1
    assert errors[1] < 0.02
