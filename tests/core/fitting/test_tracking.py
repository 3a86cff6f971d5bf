from types import SimpleNamespace

import numpy as np
from silhouette_mocap.core.fitting.hierarchical import FAITHFUL, HierarchicalTracker
from silhouette_mocap.core.fitting.tracker import PoseFit, Tally
from silhouette_mocap.core.fitting.tracking import History, track
from synthetic import dof_values, evaluator, filmed, point_errors, small_body, small_studio


def test_a_walk_is_tracked_frame_after_frame():
    body, cameras = small_body("sixteen_segment"), small_studio()
    poses = [
        dof_values(
            body,
            root_y=-0.05 * k,
            left_hip_flexion=0.12 * k,
            left_knee_flexion=0.15 * k,
            right_shoulder_flexion=0.12 * k,
        )
        for k in range(5)
    ]
    frames = ((10 + k, filmed(body, cameras, pose)) for k, pose in enumerate(poses))
    tracker = HierarchicalTracker(body, cameras, evaluator, FAITHFUL)
    fits = list(track(tracker, History(body, body.rest_pose), frames))
    assert [fit.frame for fit in fits] == [10, 11, 12, 13, 14]
    for fit, pose in zip(fits, poses, strict=True):
        # Half a pixel of the halved pictures (66 mm) on which the faithful setting moves the torso.
        assert np.mean(list(point_errors(body, fit.pose, pose).values())) < 0.033


def test_each_frame_starts_from_the_last_pose_and_a_damped_prediction():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    starts = []

    class Moving:
        evaluator = evaluator(body, cameras)

        def fit(self, silhouettes, past):
            starts.append((past.last[0], past.predicted[0]))
            return PoseFit(past.last + np.eye(len(past.last))[0], 0, Tally())

    frames = [(k, filmed(body, cameras, body.rest_pose)) for k in range(3)]
    list(track(Moving(), History(body, body.rest_pose), frames))
    assert np.allclose(starts, [(0, 0), (1, 1.7), (2, 2.7)])


def test_frames_are_read_one_at_a_time():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    read = []

    def frames():
        for number in range(100):
            read.append(number)
            yield number, filmed(body, cameras, body.rest_pose)

    still = SimpleNamespace(
        evaluator=evaluator(body, cameras), fit=lambda s, past: PoseFit(past.last, 0, Tally())
    )
    fits = track(still, History(body, body.rest_pose), frames())
    next(fits)
    assert read == [0]


def test_what_lumps_are_usual_is_what_a_third_of_the_frames_remembered_stay_below():
    body = small_body("sixteen_segment")
    history = History(body, body.rest_pose)
    assert np.isinf(history.past.usual).all()
    for amount in range(100):
        history.add(np.full(len(body.dofs), float(amount)), np.full(5, float(amount)))
    np.testing.assert_allclose(history.past.usual, 40 + 0.35 * 59)


def test_frames_that_are_not_explained_are_counted_until_one_is():
    body = small_body("sixteen_segment")
    history = History(body, body.rest_pose)
    counts = []
    for lumps in (0.0, 0.01, 0.1, 0.1, 0.0, 0.1):
        history.add(body.rest_pose, np.array([0.0, lumps, 0.0, 0.0, 0.0]))
        counts.append(history.past.amiss)
    history.add(body.rest_pose, np.full(5, 0.1), locked=True)
    assert counts == [0, 0, 1, 2, 0, 1]
    assert history.past.amiss == 0


def moved_on(history, body, angle, lumps):
    pose = dof_values(body, left_elbow_flexion=angle, right_elbow_flexion=angle)
    history.add(pose, np.array(lumps, float))
    names = list(body.dofs.names)
    past = history.past
    return [past.trusted[names.index(f"{side}_elbow_flexion")] for side in ("left", "right")], past


def test_a_limb_in_trouble_is_expected_where_it_was_before_but_not_for_ever():
    body = small_body("sixteen_segment")
    history = History(body, body.rest_pose)
    for _ in range(30):
        moved_on(history, body, 0.5, np.full(5, 0.01))
    lumps = [0.01, 0.3, 0.01, 0.01, 0.01]
    for frame in range(10):
        (left, right), past = moved_on(history, body, 1.0, lumps)
        assert left == 0.5
        assert right >= 1.0
        assert past.patient[1] == (frame < 9)
    (left, _), past = moved_on(history, body, 1.0, lumps)
    assert left == 1.0
    assert past.patient.tolist() == [True, False, True, True, True]
    # what is well again is trusted at once
    (left, _), past = moved_on(history, body, 0.9, np.full(5, 0.01))
    assert left == 0.9 - 0.7 * 0.1
    assert past.patient.all()
