from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import within_limits
from silhouette_mocap.core.fitting.contour import ContourTracker
from silhouette_mocap.core.fitting.contour_search import ContourSettings
from silhouette_mocap.core.fitting.limb_search import LimbSettings
from silhouette_mocap.core.fitting.tracker import Past
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import dof_values, evaluator, filmed, point_errors, small_body, small_studio

PIXEL_M = 0.033


def mean_error(body, pose, truth):
    return np.mean(list(point_errors(body, pose, truth).values()))


def bent(body):
    return dof_values(
        body,
        root_x=0.03,
        root_y=-0.04,
        root_yaw=0.1,
        left_shoulder_flexion=0.3,
        left_elbow_flexion=0.5,
        right_elbow_flexion=0.4,
        left_hip_flexion=0.3,
        left_knee_flexion=0.4,
        right_knee_flexion=0.2,
    )


@pytest.mark.parametrize("name", ["performer", "sixteen_segment", "eleven_segment"])
def test_a_pose_nearby_is_found_to_a_fraction_of_a_pixel(name):
    body, cameras = small_body(name), small_studio()
    truth = bent(body)
    tracker = ContourTracker(body, cameras, evaluator)
    fit = tracker.fit(filmed(body, cameras, truth), Past.still(body.rest_pose))
    assert mean_error(body, fit.pose, truth) < 0.4 * PIXEL_M
    pixels = tracker.evaluator.silhouettes(fit.pose)
    differ = sum(
        np.count_nonzero(a ^ b.foreground)
        for a, b in zip(pixels, filmed(body, cameras, truth), strict=True)
    )
    assert fit.energy == differ


def test_a_body_without_legs_of_its_own_is_tracked_standing():
    body, cameras = small_body("nine_joint"), small_studio()
    truth = dof_values(
        body, root_x=0.04, root_yaw=0.1, left_shoulder_abduction=0.4, right_elbow_flexion=0.5
    )
    tracker = ContourTracker(body, cameras, evaluator)
    past = replace(Past.still(body.rest_pose), usual=np.zeros(5))
    fit = tracker.fit(filmed(body, cameras, truth), past)
    assert mean_error(body, fit.pose, truth) < 0.4 * PIXEL_M


def test_a_limb_that_jumps_is_sought_and_found():
    body, cameras = small_body("performer"), small_studio()
    start, truth = bent(body), bent(body)
    truth[body.dofs.names.index("left_hip_flexion")] = 1.9
    truth[body.dofs.names.index("left_knee_flexion")] = 1.5
    seen = filmed(body, cameras, truth)
    past = replace(Past.still(start), usual=np.zeros(5))
    ankles = []
    for limbs in (None, LimbSettings()):
        settings = replace(ContourSettings(), limbs=limbs)
        fit = ContourTracker(body, cameras, evaluator, settings).fit(seen, past)
        ankles.append(point_errors(body, fit.pose, truth)["left_ankle"])
    assert ankles[1] < PIXEL_M
    assert ankles[0] > 0.5


def test_no_pose_leaves_the_limits():
    body, cameras, rng = small_body("performer"), small_studio(), np.random.default_rng(4)
    tracker = ContourTracker(body, cameras, evaluator)
    for _ in range(4):
        beyond = bent(body) + rng.normal(0, 0.3, len(body.dofs))
        beyond[body.dofs.names.index("left_knee_flexion")] = -0.4
        fit = tracker.fit(filmed(body, cameras, beyond), Past.still(body.rest_pose))
        assert within_limits(body, fit.pose[None])[0]


def test_a_limit_that_stops_one_joint_leaves_the_others_free():
    body, cameras = small_body("performer"), small_studio()
    truth = dof_values(body, waist_flexion=-0.25, chest_flexion=-0.25, neck_flexion=-0.5)
    # the waist can bend back no more, so that the neck alone can follow
    start = dof_values(body, waist_flexion=-0.26, chest_flexion=-0.26, neck_flexion=0.3)
    settings = replace(ContourSettings(), limbs=None)
    tracker = ContourTracker(body, cameras, evaluator, settings)
    fit = tracker.fit(filmed(body, cameras, truth), Past.still(start))
    assert point_errors(body, fit.pose, truth)["head"] < PIXEL_M


def test_a_view_that_shows_nobody_is_left_out():
    body, cameras = small_body("performer"), small_studio()
    truth = bent(body)
    seen = list(filmed(body, cameras, truth))
    empty = np.zeros_like(seen[0].foreground)
    seen[0] = Silhouette(empty, ~empty)
    tracker = ContourTracker(body, cameras, evaluator)
    fit = tracker.fit(tuple(seen), Past.still(body.rest_pose))
    assert mean_error(body, fit.pose, truth) < 0.6 * PIXEL_M


def test_where_nobody_is_seen_the_last_pose_stays():
    body, cameras = small_body("performer"), small_studio()
    empty = np.zeros((120, 160), bool)
    seen = tuple(Silhouette(empty, ~empty) for _ in cameras)
    last, predicted = bent(body), body.rest_pose
    fit = ContourTracker(body, cameras, evaluator).fit(
        seen, replace(Past.still(last), predicted=predicted)
    )
    np.testing.assert_array_equal(fit.pose, last)


def test_any_number_of_threads_finds_the_same_pose_bit_by_bit():
    body, cameras = small_body("performer"), small_studio()
    seen = filmed(body, cameras, bent(body))
    poses = []
    for threads in (1, 2):
        tracker = ContourTracker(
            body, cameras, lambda b, c, threads=threads: NativeEvaluator(b, c, threads=threads)
        )
        poses.append(tracker.fit(seen, Past.still(body.rest_pose)).pose)
    np.testing.assert_array_equal(*poses)


def with_usual(pose, usual):
    return replace(Past.still(pose), usual=np.full(5, usual))


def test_an_arm_that_all_views_drop_is_held_where_it_was():
    body, cameras = small_body("performer"), small_studio()
    truth = dof_values(body, left_shoulder_abduction=0.9)
    arm = next(part for part in body.parts if part.name == "left_arm")
    others = [s for s in range(len(body.segment_names)) if s not in arm.segments]
    drawn = evaluator(body, cameras)
    bare = drawn.silhouettes(truth, others)
    seen = tuple(Silhouette(mask, np.ones_like(mask)) for mask in bare)
    fit = ContourTracker(body, cameras, evaluator).fit(seen, with_usual(truth, 0.0))
    assert point_errors(body, fit.pose, truth)["left_wrist"] < 2 * PIXEL_M
    impatient = replace(with_usual(truth, 0.0), patient=np.zeros(5, bool))
    fit = ContourTracker(body, cameras, evaluator).fit(seen, impatient)
    assert point_errors(body, fit.pose, truth)["left_wrist"] > 5 * PIXEL_M


def test_an_arm_hidden_before_the_body_is_found_when_it_shows_again():
    body, cameras = small_body("performer"), small_studio()
    truth = dof_values(body, left_shoulder_flexion=1.3, left_elbow_flexion=0.6)
    hidden = dof_values(body, left_shoulder_abduction=-1.2, left_elbow_flexion=1.0)
    fit = ContourTracker(body, cameras, evaluator).fit(
        filmed(body, cameras, truth), with_usual(hidden, 0.0)
    )
    assert point_errors(body, fit.pose, truth)["left_wrist"] < PIXEL_M


def test_a_view_of_another_moment_does_little_harm():
    body, cameras = small_body("performer"), small_studio()
    truth, other = bent(body), dof_values(body, root_x=0.4, root_y=0.3)
    seen = list(filmed(body, cameras, truth))
    seen[2] = filmed(body, cameras, other)[2]
    past = Past.still(body.rest_pose)
    errors = []
    for weighed in (True, False):
        settings = replace(ContourSettings(), views_weighed=weighed)
        fit = ContourTracker(body, cameras, evaluator, settings).fit(tuple(seen), past)
        errors.append(mean_error(body, fit.pose, truth))
    assert errors[0] < 0.5 * PIXEL_M
    assert errors[0] < 0.7 * errors[1]
