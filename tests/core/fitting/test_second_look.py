from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.fitting.contour import ContourTracker
from silhouette_mocap.core.fitting.scores import frame_scores
from silhouette_mocap.core.fitting.second_look import Course, looked_again
from silhouette_mocap.core.fitting.tracker import Tally
from silhouette_mocap.core.fitting.tracking import FrameFit, History, track
from synthetic import dof_values, evaluator, filmed, point_errors, small_body, small_studio

PIXEL_M = 0.033
FRAMES = 12


@pytest.fixture(scope="module")
def scene():
    """An arm that rises, twelve frames of it, and the tracker."""
    body, cameras = small_body("performer"), small_studio()
    truth = [dof_values(body, left_shoulder_abduction=0.12 * k) for k in range(FRAMES)]
    seen = [filmed(body, cameras, pose) for pose in truth]
    tracker = ContourTracker(body, cameras, evaluator)
    return body, tracker, truth, seen


def reader(seen):
    return lambda frames: ((frame, seen[frame]) for frame in frames)


def changed_by(tracker, course, seen):
    stretches = looked_again(tracker, course, reader(seen))
    return {fit.frame: fit for changed in stretches for fit in changed}


def fit_of(scene, frame, pose, locked=False):
    _, tracker, _, seen = scene
    scores = frame_scores(tracker.evaluator, pose, seen[frame])
    return FrameFit(frame, pose, scores, Tally(), 0.0, locked)


def with_poses(scene, poses):
    return {frame: fit_of(scene, frame, pose) for frame, pose in enumerate(poses)}


def course_of(fits):
    return Course(fits, range(FRAMES), 15.0, small_body("performer"))


def test_what_nobody_doubts_is_not_looked_at_again(scene):
    course = course_of(with_poses(scene, scene[2]))
    assert not course.doubtful().any()
    assert course.stretches() == []


def test_a_stretch_runs_from_before_the_doubt_to_the_first_calm_frame(scene):
    fits = with_poses(scene, scene[2])
    lumpy = replace(fits[0].scores, lumps=np.full(5, 0.05))
    for frame in (4, 6):
        fits[frame] = replace(fits[frame], scores=lumpy)
    assert course_of(fits).stretches() == [(0, 7, 4, ())]
    # doubt that lasts to the end has no frame to come back from
    fits[11] = replace(fits[11], scores=lumpy)
    assert course_of(fits).stretches() == [(0, 7, 4, ()), (0, FRAMES, 11, ())]


def test_where_the_pose_leaps_within_a_doubtful_stretch_is_told(scene):
    body, _, truth, _ = scene
    away = truth[6] + dof_values(body, root_x=1.0)
    fits = with_poses(scene, [*truth[:6], away, *truth[7:]])
    lumpy = replace(fits[0].scores, lumps=np.full(5, 0.05))
    for frame in range(4, 8):
        fits[frame] = replace(fits[frame], scores=lumpy)
    assert course_of(fits).stretches() == [(0, 8, 4, (6, 7))]


def test_an_arm_lost_for_a_while_is_found_from_the_other_end(scene):
    body, tracker, truth, seen = scene
    lost = [truth[0] if 5 <= k <= 8 else pose for k, pose in enumerate(truth)]
    course = course_of(with_poses(scene, lost))
    assert course.doubtful()[6:9].all()
    changed = {
        fit.frame: fit for fits in looked_again(tracker, course, reader(seen)) for fit in fits
    }
    for frame in range(5, 9):
        error = point_errors(body, changed[frame].pose, truth[frame])["left_wrist"]
        assert error < PIXEL_M
    assert not set(changed) & {0, 1, 2, 9, 10, 11}


def test_an_arm_lost_to_the_end_is_found_by_a_rival_of_the_pose_where_doubt_begins(scene):
    body, tracker, truth, seen = scene
    lost = [truth[0] if k >= 5 else pose for k, pose in enumerate(truth)]
    course = course_of(with_poses(scene, lost))
    (stretch,) = course.stretches()
    assert stretch.end == FRAMES
    changed = changed_by(tracker, course, seen)
    for frame in range(stretch.doubt, FRAMES):
        error = point_errors(body, changed[frame].pose, truth[frame])["left_wrist"]
        assert error < PIXEL_M


def test_a_locked_pose_leads_back_to_where_both_passes_agree(scene):
    body, tracker, truth, seen = scene
    wrong = dof_values(body, left_shoulder_abduction=0.6, right_shoulder_abduction=0.9)
    poses = [wrong if 3 <= k <= 8 else pose for k, pose in enumerate(truth)]
    fits = with_poses(scene, poses)
    fits[9] = fit_of(scene, 9, truth[9], locked=True)
    course = course_of(fits)
    assert any(stretch.end == 9 for stretch in course.stretches())
    changed = {
        fit.frame: fit for fits in looked_again(tracker, course, reader(seen)) for fit in fits
    }
    assert 9 not in changed
    for frame in range(4, 9):
        assert np.mean(list(point_errors(body, changed[frame].pose, truth[frame]).values())) < (
            0.5 * PIXEL_M
        )


def test_a_locked_pose_bounds_what_later_locks_change(scene):
    fits = with_poses(scene, scene[2])
    for frame in (4, 9):
        fits[frame] = replace(fits[frame], locked=True)
    assert course_of(fits).stretches() == [(0, 4, None, ()), (5, 9, None, ())]


def test_a_locked_pose_leads_back_as_far_where_doubt_lies_before_it(scene):
    lumpy = replace(fit_of(scene, 0, scene[2][0]).scores, lumps=np.full(5, 0.05))
    fits = {frame: fit_of(scene, 0, scene[2][0], frame == 22) for frame in range(24)}
    fits[21] = replace(fits[21], scores=lumpy)
    course = Course(fits, range(24), 15.0, small_body("performer"))
    assert course.stretches() == [(0, 22, 21, ())]


def test_doubt_on_both_sides_of_a_locked_pose_is_two_stretches(scene):
    fits = with_poses(scene, scene[2])
    lumpy = replace(fits[0].scores, lumps=np.full(5, 0.05))
    for frame in (3, 5):
        fits[frame] = replace(fits[frame], scores=lumpy)
    fits[4] = replace(fits[4], locked=True)
    assert course_of(fits).stretches() == [(0, 4, 3, ()), (5, 6, 5, ())]


def test_frames_with_locks_have_that_pose_and_the_next_starts_from_it(scene):
    body, tracker, truth, seen = scene
    lock = dof_values(body, left_shoulder_abduction=0.3)
    history = History(body, body.rest_pose)
    fits = list(track(tracker, history, reader(seen)(range(4)), {2: lock}))
    np.testing.assert_array_equal(fits[2].pose, lock)
    assert [fit.locked for fit in fits] == [False, False, True, False]
    history = History(body, body.rest_pose)
    history.add(truth[0], np.zeros(5))
    history.add(lock, np.zeros(5), locked=True)
    np.testing.assert_array_equal(history.past.predicted, lock)
