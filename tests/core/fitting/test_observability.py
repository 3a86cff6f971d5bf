from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.fitting.observability import UNOBSERVED, Observability, _point_moves
from silhouette_mocap.core.fitting.scores import metres_at
from silhouette_mocap.core.fitting.twists import Twists
from synthetic import dof_values, evaluator, filmed, small_body, small_studio

WRIST = POINT_NAMES.index("left_wrist")


@pytest.fixture(scope="module")
def scene():
    body, cameras = small_body("performer"), small_studio()
    return body, cameras, evaluator(body, cameras)


def seen(scene, pose, silhouettes, weights=None):
    _, cameras, drawn = scene
    weights = np.ones(len(cameras)) if weights is None else weights
    return Observability.of(drawn, pose, silhouettes, weights, metres_at(drawn, pose))


def test_how_points_move_is_the_difference_quotient_of_where_they_are(scene):
    body, step = scene[0], 1e-6
    pose = np.random.default_rng(3).normal(0, 0.3, len(body.dofs))
    moves = _point_moves(body, *Twists(body).at(pose))
    for dof in range(len(pose)):
        ahead, behind = pose.copy(), pose.copy()
        ahead[dof] += step
        behind[dof] -= step
        difference = np.diff(points(body, np.stack([behind, ahead])), axis=0)[0] / (2 * step)
        np.testing.assert_allclose(moves[:, :, dof], difference, atol=1e-8)


def test_an_arm_away_from_the_body_is_better_known_than_one_before_it(scene):
    body, cameras, _ = scene
    out = dof_values(body, left_shoulder_abduction=1.3)
    before = dof_values(body, left_shoulder_abduction=-0.9, left_elbow_flexion=1.6)
    spreads = [
        seen(scene, pose, filmed(body, cameras, pose)).point_spreads[WRIST]
        for pose in (out, before)
    ]
    assert spreads[0] < 0.05
    assert spreads[1] > 2 * spreads[0]


def test_a_limb_off_every_contour_is_not_known(scene):
    body, cameras, _ = scene
    out = dof_values(body, left_shoulder_abduction=1.3)
    well = seen(scene, out, filmed(body, cameras, out))
    off = seen(scene, out, filmed(body, cameras, body.rest_pose))
    assert off.point_spreads[WRIST] > 3 * well.point_spreads[WRIST]
    right = POINT_NAMES.index("right_knee")
    assert off.point_spreads[right] < 1.5 * well.point_spreads[right]


def test_the_turn_of_a_straight_limb_is_told_by_nothing(scene):
    body, cameras, _ = scene
    pose = dof_values(body, left_shoulder_abduction=1.3)
    found = seen(scene, pose, filmed(body, cameras, pose)).dof_spreads
    spreads = dict(zip(body.dofs.names, found, strict=True))
    assert spreads["left_shoulder_twist"] > UNOBSERVED
    assert spreads["left_shoulder_abduction"] < 0.1
    bent = dof_values(body, left_shoulder_abduction=1.3, left_elbow_flexion=1.3)
    found = seen(scene, bent, filmed(body, cameras, bent)).dof_spreads
    twist = body.dofs.names.index("left_shoulder_twist")
    assert found[twist] < 0.7 * spreads["left_shoulder_twist"]


def test_views_that_are_not_trusted_tell_nothing(scene):
    body, cameras, _ = scene
    silhouettes = filmed(body, cameras, body.rest_pose)
    whole = seen(scene, body.rest_pose, silhouettes)
    few = seen(
        scene, body.rest_pose, silhouettes, np.array([1.0, 1.0, *[0.0] * (len(cameras) - 2)])
    )
    assert (few.point_spreads > whole.point_spreads).all()
    blank = tuple(replace(s, foreground=np.zeros_like(s.foreground)) for s in silhouettes)
    none = seen(scene, body.rest_pose, blank)
    free = np.minimum(np.where(body.dofs.kinds == 0, 0.3, 1.0), body.dofs.rest_spread)
    np.testing.assert_allclose(none.dof_spreads, free)
