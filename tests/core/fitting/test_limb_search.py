import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import within_limits
from silhouette_mocap.core.energy.weight_maps import drawing_weight_maps, xor_weight_maps
from silhouette_mocap.core.fitting.limb_search import (
    LimbCost,
    LimbSettings,
    better_limbs,
    limbs_elsewhere,
)
from silhouette_mocap.core.fitting.tracker import Tally
from synthetic import dof_values, evaluator, filmed, point_errors, small_body, small_studio

PIXEL_M = 0.033


@pytest.fixture(scope="module")
def scene():
    body, cameras = small_body("performer"), small_studio()
    return body, cameras, evaluator(body, cameras)


def arm_cost(scene, truth, pose, expected=None, tally=None):
    body, cameras, drawn = scene
    part = next(part for part in body.parts if part.name == "left_arm")
    weights = drawn.prepared(xor_weight_maps(filmed(body, cameras, truth)))
    masked = drawn.masked(weights, pose, part.segments)

    def pixels(poses):
        return drawn.energies(masked, poses, part.segments).sum(axis=1)

    expected = pose if expected is None else expected
    return LimbCost(body, part, pose, expected, pixels, 1.0, 0.5, tally or Tally())


def test_a_limb_far_away_is_found_where_it_is_doubted(scene):
    body = scene[0]
    truth = dof_values(body, left_shoulder_flexion=1.7, left_elbow_flexion=1.2)
    cost = arm_cost(scene, truth, body.rest_pose)
    found = limbs_elsewhere(cost, cost, body.rest_pose[None], LimbSettings())
    assert point_errors(body, found[0], truth)["left_elbow"] < 5 * PIXEL_M
    assert (cost(found) < cost(body.rest_pose[None])).all()
    assert within_limits(body, found).all()


def test_foreground_left_uncovered_draws_a_limb_from_afar(scene):
    body, cameras, drawn = scene
    truth = dof_values(body, left_shoulder_flexion=1.2)
    near = dof_values(body, left_shoulder_flexion=0.9, left_shoulder_abduction=0.3)
    away = dof_values(body, left_shoulder_flexion=-0.9, left_shoulder_abduction=0.3)
    seen, part = filmed(body, cameras, truth), arm_cost(scene, truth, body.rest_pose).part
    others = [s for s in range(len(body.segment_names)) if s not in part.segments]
    covered = drawn.silhouettes(body.rest_pose, others)
    maps = drawing_weight_maps(seen, covered, [6.0] * len(cameras))
    masked = drawn.masked(drawn.prepared(maps), body.rest_pose, part.segments)
    poses = np.stack([truth, near, away])
    energies = drawn.energies(masked, poses, part.segments).sum(axis=1)
    assert energies[0] < energies[1] < energies[2]


def test_only_the_limb_moves(scene):
    body = scene[0]
    truth = dof_values(body, left_shoulder_flexion=0.4)
    cost = arm_cost(scene, truth, body.rest_pose)
    found = better_limbs(cost, body.rest_pose[None], LimbSettings())
    assert len(found)
    others = np.setdiff1d(np.arange(len(body.dofs)), cost.part.dofs)
    np.testing.assert_array_equal(found[:, others], 0)


def test_a_limb_that_stands_well_is_left_alone(scene):
    body = scene[0]
    tally = Tally()
    cost = arm_cost(scene, body.rest_pose, body.rest_pose, tally=tally)
    settings = LimbSettings()
    assert len(better_limbs(cost, body.rest_pose[None], settings)) == 0
    # itself, the start, and one generation
    assert tally.evaluated == 2 + settings.near
    assert settings.near < settings.everywhere


def test_what_silhouettes_do_not_tell_stays_near_what_is_expected(scene):
    body = scene[0]
    pose, expected = dof_values(body), dof_values(body, left_shoulder_twist=0.5)
    free, pulled = arm_cost(scene, pose, pose), arm_cost(scene, pose, pose, expected)
    there = pulled.moved(expected[None])
    assert pulled(pose[None])[0] - free(pose[None])[0] == pytest.approx(1.0)
    assert free(there)[0] - pulled(there)[0] == pytest.approx(1.0)
