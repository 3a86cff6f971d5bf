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
    poses = turned(evaluator(body, cameras), pose)
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
