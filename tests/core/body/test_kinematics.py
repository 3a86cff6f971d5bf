import numpy as np
import pytest
from silhouette_mocap.core.body.body import POINT_NAMES, Body, DofKind, Dofs, Surface
from silhouette_mocap.core.body.kinematics import (
    clamped,
    joint_positions,
    joint_transforms,
    points,
    swing_rows,
    within_limits,
)


def turn(axis, angle):
    """Rodrigues' formula, independent of the product's rotations."""
    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def chain():
    """A root that slides along x and yaws, then a joint with a swing and a twist, one metre up."""
    translation, hinge, swing = DofKind.TRANSLATION, DofKind.HINGE, DofKind.SWING
    dofs = Dofs(
        names=("x", "yaw", "swing_x", "swing_y", "twist"),
        joints=[0, 0, 1, 1, 1],
        kinds=[translation, hinge, swing, swing, hinge],
        axes=[(1, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
        limits=[(-np.inf, np.inf), (-np.inf, np.inf), (-1, 1), (-1, 1), (-0.5, 0.5)],
        rest_spread=[np.inf] * 5,
        directions=("",) * 5,
    )
    count = len(POINT_NAMES)
    return Body(
        name="chain",
        joint_names=("root", "tip"),
        parents=[-1, 0],
        offsets=[(0, 0, 1), (0, 0, 1)],
        tails=[(0, 0, 1), (0, 0, 1)],
        dofs=dofs,
        cones={1: np.array([(1, 0), (0, 1), (-1, 0), (0, -1)], float)},
        segment_names=("all",),
        segment_joints=[0],
        surfaces=(Surface(np.eye(3), [(0, 1, 2)], [0, 3], [0, 1]),),
        point_joints=[1] * count,
        point_offsets=[(0.5, 0, 0)] * count,
        parts=(),
    )


def test_a_chain_is_where_rodrigues_by_hand_puts_it():
    pose = np.array([0.3, 0.7, 0.4, -0.2, 0.25])
    angle = np.hypot(0.4, 0.2)
    root = turn((0, 0, 1), 0.7)
    tip = root @ turn((0.4 / angle, -0.2 / angle, 0), angle) @ turn((0, 0, 1), 0.25)
    transforms = joint_transforms(chain(), pose[None])[0]
    np.testing.assert_allclose(transforms[0], np.c_[root, (0.3, 0, 1)], atol=1e-12)
    np.testing.assert_allclose(transforms[1], np.c_[tip, (0.3, 0, 2)], atol=1e-12)
    expected = tip @ (0.5, 0, 0) + (0.3, 0, 2)
    np.testing.assert_allclose(points(chain(), pose[None])[0, 3], expected, atol=1e-12)


def test_a_quarter_turn_is_what_anyone_sees():
    pose = np.array([[0.0, np.pi / 2, 0.0, 0.0, 0.0]])
    np.testing.assert_allclose(points(chain(), pose)[0, 0], (0, 0.5, 2), atol=1e-12)


def test_a_batch_is_the_same_as_one_pose_at_a_time(body):
    poses = 0.3 * np.random.default_rng(1).standard_normal((4, len(body.dofs)))
    batch = joint_transforms(body, poses)
    for pose, transforms in zip(poses, batch, strict=True):
        np.testing.assert_array_equal(joint_transforms(body, pose[None])[0], transforms)


def test_in_the_rest_pose_joints_are_where_the_offsets_add_up(body):
    expected = np.zeros((len(body.joint_names), 3))
    for joint, parent in enumerate(body.parents):
        expected[joint] = body.offsets[joint] + (expected[parent] if parent >= 0 else 0)
    np.testing.assert_allclose(joint_positions(body, body.rest_pose[None])[0], expected)


def test_moving_the_root_moves_everything_rigidly(body):
    rng = np.random.default_rng(2)
    pose = 0.2 * rng.standard_normal(len(body.dofs))
    moved = pose.copy()
    moved[:3] += (1, 2, 3)
    a, b = points(body, np.stack([pose, moved]))
    np.testing.assert_allclose(b - a, np.broadcast_to((1, 2, 3), (14, 3)), atol=1e-12)


def test_a_pose_of_a_wrong_length_is_refused(body):
    with pytest.raises(ValueError, match="expected poses of shape"):
        joint_transforms(body, np.zeros((1, 3)))


def test_limits_hold_for_intervals_and_for_the_cone():
    poses = np.zeros((5, 5))
    poses[1, 4] = 0.6  # beyond the twist's interval
    poses[2, 2:4] = 0.7, 0.7  # within both intervals of the swing, beyond its polygon
    poses[3, 2:4] = 0.4, 0.4
    poses[4, 2:4] = 1.0, 0.0  # on a corner
    np.testing.assert_array_equal(within_limits(chain(), poses), [True, False, False, True, True])


def test_clamping_goes_to_the_nearest_allowed_swing():
    pose = np.array([[0.0, 0.0, 0.8, 0.8, 2.0]])
    np.testing.assert_allclose(clamped(chain(), pose), [[0, 0, 0.5, 0.5, 0.5]])


def test_clamping_keeps_what_is_allowed_and_makes_the_rest_allowed(body):
    rng = np.random.default_rng(3)
    poses = rng.standard_normal((50, len(body.dofs)))
    fixed = clamped(body, poses)
    assert not within_limits(body, poses).any()
    assert within_limits(body, fixed).all()
    np.testing.assert_allclose(clamped(body, fixed), fixed, atol=1e-12)


def test_a_joint_without_a_swing_has_no_swing_rows(body):
    with pytest.raises(ValueError, match=f"expected a swing in joint {body.joint_names[0]}"):
        swing_rows(body, 0)
