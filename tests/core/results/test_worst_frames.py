"""The frames that fit worst, and why."""

import numpy as np
import pytest
from motion_made_up import motion_of
from silhouette_mocap.core.results.worst_frames import mean_iou, worst_frames


def test_worst_frames_come_worst_first_and_are_no_neighbours():
    iou = np.full((100, 2), 0.9)
    iou[40:50] = [[0.3 + 0.01 * k] * 2 for k in range(10)]
    iou[80] = 0.5
    found = worst_frames(motion_of(iou), 3)
    assert [bad.frame for bad in found[:2]] == [40, 44]
    frames = sorted(bad.frame for bad in worst_frames(motion_of(iou), 6))
    assert np.diff(frames).min() >= 4 and 80 in frames


def test_lost_frames_come_before_all_others():
    iou = np.full((50, 2), 0.9)
    iou[10] = 0.2
    lost = np.arange(50) == 30
    found = worst_frames(motion_of(iou, lost=lost), 2)
    assert [(bad.frame, bad.lost) for bad in found] == [(30, True), (10, False)]


def test_the_camera_and_limb_named_fall_furthest_below_their_usual():
    iou = np.tile([0.6, 0.9, 0.9], (20, 1))
    iou[7] = [0.58, 0.9, 0.7]
    residual = np.tile([3.0, 1.0, 1.0, 1.0, 1.0], (20, 1))
    residual[7] = [3.1, 1.0, 2.5, 1.0, np.nan]
    (bad,) = worst_frames(motion_of(iou, limb_residual=residual), 1)
    assert (bad.camera, bad.limb, bad.hidden) == ("cam_3", "right_arm", ("right_leg",))
    assert bad.camera_iou == pytest.approx((0.7, 0.9)) and bad.limb_px == (2.5, 1.0)


def test_a_frame_that_nobody_observed_is_the_worst_and_names_no_camera():
    iou = np.full((30, 2), 0.5)
    iou[12] = np.nan
    motion = motion_of(iou, limb_residual=np.full((30, 5), np.nan))
    (bad,) = worst_frames(motion, 1)
    assert (bad.frame, bad.camera, bad.limb) == (12, None, None)
    assert bad.unseen == ("cam_1", "cam_2") and len(bad.hidden) == 5


def test_a_short_motion_has_few_worst_frames():
    assert [bad.frame for bad in worst_frames(motion_of([[0.5, 0.5]]), 6)] == [0]


def test_the_mean_leaves_out_cameras_that_observed_nothing():
    found = mean_iou(motion_of([[0.5, np.nan], [np.nan, np.nan], [0.25, 0.75]]))
    np.testing.assert_array_equal(found, [0.5, np.nan, 0.5])
