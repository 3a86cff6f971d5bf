from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import within_limits
from silhouette_mocap.core.fitting import hierarchical
from silhouette_mocap.core.fitting.hierarchical import (
    FAITHFUL,
    ROBUST,
    SETTINGS,
    HierarchicalSettings,
    HierarchicalTracker,
)
from silhouette_mocap.core.fitting.tracker import Past
from synthetic import dof_values, evaluator, filmed, point_errors, small_body, small_studio

# One px of the small studio is 33 mm at the performer. Six views find joints to a fraction of it on
# average; those that only turn a thin segment (shoulders, wrists) to about two.
MEAN_TOLERANCE, LARGEST_TOLERANCE = 0.75 * 0.033, 2 * 0.033
STEP = {
    "root_y": -0.06,
    "root_yaw": 0.1,
    "left_shoulder_flexion": 0.25,
    "right_elbow_flexion": 0.3,
    "left_hip_flexion": 0.3,
    "left_knee_flexion": 0.4,
}


class Counting:
    """An evaluator that remembers the poses it was asked to render."""

    def __init__(self, body, cameras):
        self.inner = evaluator(body, cameras)
        self.poses = []

    def __getattr__(self, name):
        return getattr(self.inner, name)

    def energies(self, weights, poses, segments=None):
        self.poses.append(poses.copy())
        return self.inner.energies(weights, poses, segments)


@pytest.mark.parametrize("name", ["performer", "sixteen_segment", "eleven_segment"])
def test_a_step_is_followed_to_a_fraction_of_a_pixel(name):
    body, cameras = small_body(name), small_studio()
    truth = dof_values(body, **STEP)
    tracker = HierarchicalTracker(body, cameras, evaluator)
    fit = tracker.fit(filmed(body, cameras, truth), Past.still(body.rest_pose))
    errors = point_errors(body, fit.pose, truth)
    assert np.mean(list(errors.values())) < MEAN_TOLERANCE
    assert max(errors.values()) < LARGEST_TOLERANCE


def test_an_arm_that_jumped_is_found_by_the_grid_and_missed_without_it():
    body, cameras = small_body("sixteen_segment"), small_studio()
    # both within the grid's half width
    truth = dof_values(body, left_shoulder_flexion=0.8, left_shoulder_abduction=0.5)
    silhouettes = filmed(body, cameras, truth)
    settings = HierarchicalSettings(grid_steps=5, grid_half_width=0.8, rounds=2)
    wrists = []
    for chosen in (settings, replace(settings, grid_half_width=0.0)):
        tracker = HierarchicalTracker(body, cameras, evaluator, chosen)
        pose = tracker.fit(silhouettes, Past.still(body.rest_pose)).pose
        wrists.append(point_errors(body, pose, truth)["left_wrist"])
    # A jump of half a metre, found again to three px.
    assert wrists[0] < 3 * 0.033
    assert wrists[1] > 0.2


def test_the_prediction_is_searched_as_well_as_the_last_pose():
    body, cameras = small_body("sixteen_segment"), small_studio()
    truth = dof_values(body, right_shoulder_flexion=1.4, right_elbow_flexion=0.8)
    tracker = HierarchicalTracker(body, cameras, evaluator)
    fit = tracker.fit(
        filmed(body, cameras, truth), replace(Past.still(body.rest_pose), predicted=truth + 0.05)
    )
    assert max(point_errors(body, fit.pose, truth).values()) < LARGEST_TOLERANCE


def test_a_fit_is_never_worse_than_where_it_started():
    body, cameras = small_body("sixteen_segment"), small_studio(4)
    silhouettes = filmed(body, cameras, dof_values(body, left_hip_flexion=0.4))
    start = dof_values(body, right_shoulder_twist=0.3)
    tracker = HierarchicalTracker(body, cameras, evaluator, FAITHFUL)
    fit = tracker.fit(silhouettes, Past.still(start))
    rendered = tracker.evaluator.silhouettes(start)
    energy = sum((s.foreground ^ r).sum() for s, r in zip(silhouettes, rendered, strict=True))
    assert fit.energy < energy
    rendered = tracker.evaluator.silhouettes(fit.pose)
    assert fit.energy == sum(
        (s.foreground ^ r).sum() for s, r in zip(silhouettes, rendered, strict=True)
    )


def test_no_candidate_beyond_the_limits_is_rendered():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    cone = body.cones[body.joint_names.index("left_shoulder")]
    raised = cone[np.argmax(cone[:, 0])]
    truth = dof_values(
        body,
        left_elbow_flexion=0.05,
        left_shoulder_flexion=raised[0] - 0.05,
        left_shoulder_abduction=raised[1],
    )
    tracker = HierarchicalTracker(body, cameras, Counting, replace(ROBUST, rounds=1))
    tracker.fit(filmed(body, cameras, truth), Past.still(truth))
    poses = np.concatenate(tracker.evaluator.poses + tracker.half_evaluator.poses)
    assert len(poses) > 1000
    assert within_limits(body, poses).all()


def test_what_is_rendered_is_counted_and_nothing_else():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    tracker = HierarchicalTracker(body, cameras, Counting, replace(FAITHFUL, rounds=1))
    fit = tracker.fit(filmed(body, cameras, body.rest_pose), Past.still(body.rest_pose))
    rendered = sum(map(len, tracker.evaluator.poses + tracker.half_evaluator.poses))
    assert fit.tally.evaluated == rendered


def test_the_grids_are_those_of_the_specification():
    slow, fast = SETTINGS["faithful"]
    assert (slow.grid_steps, slow.grid_half_width) == (3, pytest.approx(np.radians(12)))
    assert (fast.grid_steps, fast.grid_half_width) == (4, pytest.approx(np.radians(35)))
    plain, wide = SETTINGS["robust"]
    assert (plain.grid_steps, plain.grid_half_width) == (5, pytest.approx(np.radians(20)))
    assert (wide.grid_steps, wide.grid_half_width) == (7, pytest.approx(np.radians(45)))


def test_the_faithful_setting_knows_no_prediction():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    truth = dof_values(body, left_hip_flexion=0.5)
    silhouettes = filmed(body, cameras, truth)
    for settings, start in ((FAITHFUL, body.rest_pose), (ROBUST, truth)):
        still = replace(settings, rounds=0)
        fit = HierarchicalTracker(body, cameras, evaluator, still).fit(
            silhouettes, replace(Past.still(body.rest_pose), predicted=truth)
        )
        assert np.array_equal(fit.pose, start)


def test_frames_that_show_nobody_keep_the_last_pose():
    body, cameras = small_body("sixteen_segment"), small_studio(3)
    seen = filmed(body, cameras, body.rest_pose)
    blank = tuple(replace(s, foreground=np.zeros_like(s.foreground)) for s in seen)
    tracker = HierarchicalTracker(body, cameras, evaluator)
    predicted = dof_values(body, root_x=0.3)
    fit = tracker.fit(blank, replace(Past.still(body.rest_pose), predicted=predicted))
    assert np.array_equal(fit.pose, body.rest_pose)
    assert fit.energy == sum(p.sum() for p in tracker.evaluator.silhouettes(body.rest_pose))


def test_candidates_out_of_their_window_are_counted(monkeypatch):
    body, cameras = small_body("sixteen_segment"), small_studio(3)
    silhouettes = filmed(body, cameras, body.rest_pose)
    counts = []
    for side in (128, 40):
        monkeypatch.setitem(hierarchical._WINDOW_SIDES, "limb", side)
        settings = replace(FAITHFUL, rounds=1, grid_half_width=0.6)
        tracker = HierarchicalTracker(body, cameras, evaluator, settings)
        counts.append(tracker.fit(silhouettes, Past.still(body.rest_pose)).tally)
    assert counts[0].outside_windows == 0
    assert 0 < counts[1].outside_windows < counts[1].evaluated


def test_the_same_frame_gives_bit_identical_poses_twice():
    body, cameras = small_body("sixteen_segment"), small_studio(3)
    silhouettes = filmed(body, cameras, dof_values(body, left_knee_flexion=0.5))
    tracker = HierarchicalTracker(body, cameras, evaluator, replace(ROBUST, rounds=1))
    poses = [tracker.fit(silhouettes, Past.still(body.rest_pose)).pose for _ in range(2)]
    assert np.array_equal(poses[0], poses[1])
