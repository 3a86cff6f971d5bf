"""Rotations over time, filtered."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.motion.cleaning.joint_rotations import JointRotation
from silhouette_mocap.core.motion.cleaning.paths import smoothed_rotations
from silhouette_mocap.core.motion.cleaning.refit import Refit
from synthetic import small_body

COUNT, RATE = 90, 30.0
NONE = np.zeros(COUNT, bool)


def smoother(gaps=NONE):
    refit = Refit(RATE, 4.0, np.ones(COUNT), gaps, NONE)
    return lambda values: refit.curve(values, np.inf)


def tumbling():
    """(T, 3, 3) rotations that leave no axis alone."""
    time = np.arange(COUNT)[:, None] / RATE
    vectors = np.array([2.0, 1.0, 3.0]) * np.sin([0.9, 1.3, 0.6] * time * 2)
    return (
        Rotation.from_rotvec(vectors[:, :2] @ np.eye(2, 3)) * Rotation.from_rotvec(vectors)
    ).as_matrix()


def degrees_between(a, b):
    return np.degrees(Rotation.from_matrix(a.transpose(0, 2, 1) @ b).magnitude())


def test_a_smooth_path_stays_and_a_noisy_one_comes_back_to_it():
    truth = tumbling()
    assert degrees_between(smoothed_rotations(truth, NONE, smoother()), truth).max() < 2.0
    noise = Rotation.from_rotvec(np.random.default_rng(0).normal(0, 0.05, (COUNT, 3))).as_matrix()
    found = smoothed_rotations(truth @ noise, NONE, smoother())
    assert (
        degrees_between(found, truth).mean() < 0.55 * degrees_between(truth @ noise, truth).mean()
    )


def test_how_the_world_is_turned_does_not_matter():
    turn = Rotation.from_rotvec([1.0, -2.0, 0.5]).as_matrix()
    noisy = (
        tumbling()
        @ Rotation.from_rotvec(np.random.default_rng(1).normal(0, 0.1, (COUNT, 3))).as_matrix()
    )
    found = smoothed_rotations(turn @ noisy, NONE, smoother())
    assert degrees_between(turn @ smoothed_rotations(noisy, NONE, smoother()), found).max() < 1e-6


def test_a_gap_that_holds_nonsense_is_bridged():
    truth = tumbling()
    gaps = np.abs(np.arange(COUNT) - 40) < 3
    spoilt = truth.copy()
    spoilt[gaps] = Rotation.random(gaps.sum(), random_state=2).as_matrix()
    assert degrees_between(smoothed_rotations(spoilt, gaps, smoother(gaps)), truth).max() < 6.0


def test_turning_on_the_spot_goes_through_whole_turns_without_a_jump():
    yaw = np.linspace(0, 15, COUNT)
    turning = Rotation.from_rotvec(yaw[:, None] * [0, 0, 1]).as_matrix()
    assert degrees_between(smoothed_rotations(turning, NONE, smoother()), turning).max() < 1e-6


@pytest.mark.parametrize("joint", ["root", "left_shoulder", "left_wrist", "head", "left_knee"])
def test_values_come_back_from_the_rotation_they_make(joint):
    body = small_body("performer")
    rotation = JointRotation.of(body, body.joint_names.index(joint))
    low, high = body.dofs.limits[rotation.rows].clip(-1.4, 1.4).T
    values = np.random.default_rng(3).uniform(low, high, (50, len(rotation.rows)))
    near = values + np.random.default_rng(4).normal(0, 0.1, values.shape)
    assert np.abs(rotation.nearest(rotation.rotations(values), near) - values).max() < 1e-8


def test_whole_turns_of_yaw_stay_whole_turns():
    body = small_body("performer")
    rotation = JointRotation.of(body, 0)
    values = np.array([[7.0, 0.2, -0.3], [-20.0, 0.1, 0.1]])
    assert np.allclose(rotation.nearest(rotation.rotations(values), values + 0.2), values)


def test_a_joint_of_two_degrees_comes_as_near_as_it_can():
    body = small_body("performer")
    rotation = JointRotation.of(body, body.joint_names.index("head"))
    wanted = Rotation.from_rotvec([[0.1, 0.2, 0.3]]).as_matrix()
    found = rotation.nearest(wanted, np.zeros((1, 2)))
    best = degrees_between(rotation.rotations(found), wanted)
    for step in 1e-3 * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]]):
        assert degrees_between(rotation.rotations(found + step), wanted) > best
