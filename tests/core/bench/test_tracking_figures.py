"""What is made of tracks: recovery, reliability, cameras chosen, time told."""

from types import SimpleNamespace

import numpy as np
import pytest
from known_recording import known_recording
from silhouette_mocap.core.bench import stopwatch
from silhouette_mocap.core.bench.disturbances.less_footage import EveryKth
from silhouette_mocap.core.bench.disturbances.recording import disturbed
from silhouette_mocap.core.bench.panels import Panel, panels_picture
from silhouette_mocap.core.bench.stopwatch import Stopwatch
from silhouette_mocap.core.bench.tracking_confidence import reliability
from silhouette_mocap.core.bench.tracking_takes import spread_views, truth_of
from silhouette_mocap.core.bench.tracking_torments import recovery
from silhouette_mocap.core.body.body import POINT_NAMES

LEFT_WRIST = POINT_NAMES.index("left_wrist")


def track_of(errors, frames=None, confidence=None):
    frames = np.arange(len(errors)) if frames is None else np.array(frames)
    motion = SimpleNamespace(frames=frames, confidence=confidence)
    return SimpleNamespace(errors=np.array(errors, float), motion=motion)


def wrist_off_in(frames, count=12, mm=300.0):
    errors = np.full((count, 14), 10.0)
    errors[list(frames), LEFT_WRIST] = mm
    return track_of(errors)


CLEAN = wrist_off_in([])


def test_a_limb_that_is_back_at_once_is_back_in_the_first_frame():
    found = recovery(wrist_off_in([4, 5]), CLEAN, (4, 5))
    assert found.back == 1 and found.before == found.undisturbed == 10
    assert found.during == pytest.approx(10 + 290 / 14)
    assert found.after == (10, 10, 10) and found.worst_mm == 10


def test_the_course_is_told_from_the_last_frame_of_the_torment():
    found = recovery(wrist_off_in([10, 11], count=30), wrist_off_in([], count=30), (10, 11))
    assert found.course[:, 0].tolist() == list(range(-9, 9))
    assert found.course[found.course[:, 0] > 0, 1] == pytest.approx(10)
    assert found.course[8:10, 1] == pytest.approx(10 + 290 / 14)


def test_a_limb_is_back_only_where_it_stays():
    found = recovery(wrist_off_in([4, 5, 7]), CLEAN, (4, 5))
    assert found.back == 3
    assert (found.worst_limb, found.worst_mm) == ("left arm", 300)
    assert found.after[1] == pytest.approx(10 + 290 / 14)


def test_a_limb_may_never_be_back():
    assert recovery(wrist_off_in(range(4, 12)), CLEAN, (4, 5)).back is None


def test_a_limb_that_is_off_without_the_torment_as_well_is_back():
    off = wrist_off_in(range(12))
    assert recovery(off, off, (4, 5)).back == 1


def test_frames_left_out_are_matched_by_their_numbers():
    kept = [0, 1, 2, 5, 8, 9, 10, 11]
    errors = wrist_off_in([9]).errors[kept]
    found = recovery(track_of(errors, kept), wrist_off_in([9]), (3, 8))
    assert found.back == 1 and found.worst_mm == 300


def test_reliability_counts_points_by_their_confidence():
    errors = np.array([[10.0, 40, 60, 200], [10, 160, 170, np.nan]])
    confidence = np.array([[0.95, 0.25, 0.95, 0.1], [0.95, 0.2, 0.9, 0.9]])
    found = reliability([track_of(errors, confidence=confidence)])
    assert found.counts.tolist() == [0, 1, 2, 0, 0, 0, 0, 0, 0, 4]
    assert found.good[9] == pytest.approx(2 / 4) and found.confidence[9] == pytest.approx(0.9375)
    assert found.doubted_of_bad == pytest.approx(2 / 3)
    assert found.doubted_of_good == pytest.approx(1 / 3)
    assert np.isnan(found.good[0])


def test_few_cameras_look_from_different_sides():
    recording = known_recording(8)
    centre = recording.truth.points.mean(axis=(0, 1))
    two = [recording.cameras[view].centre - centre for view in spread_views(recording, 2)]
    angle = np.degrees(np.arctan2(*np.array(two)[:, 1::-1].T))
    assert abs(np.diff(angle)[0]) % 180 == pytest.approx(90, abs=8)
    assert np.ptp(np.diff(spread_views(recording, 4))) == 0
    assert spread_views(recording, 8) == tuple(range(8))


def test_the_truth_of_fewer_frames_has_their_rate():
    truth = truth_of(disturbed(known_recording(fps=30), 0, EveryKth(3)))
    assert truth.frames.tolist() == [0, 3, 6, 9]
    assert truth.fps == pytest.approx(10)


def test_inner_stages_keep_their_time_to_themselves(monkeypatch):
    clock = iter([0.0, 1.0, 3.0, 10.0])
    monkeypatch.setattr(stopwatch.time, "process_time", lambda: next(clock))
    watch = Stopwatch()
    inner = watch.timed("inner", lambda: None)
    watch.timed("outer", inner)()
    assert watch.seconds == {"outer": 8.0, "inner": 2.0}


def test_a_watched_thing_is_as_it_was_but_for_its_watched_methods():
    watch = Stopwatch()
    watched = watch.watched([3, 1, 2], {"sort": "sorting"})
    watched.sort()
    assert watched.index(1) == 0 and list(watch.seconds) == ["sorting"]


def test_panels_draw_each_figure_in_its_place():
    lines = {"a": [(0.0, 0.0), (2.0, 50.0)], "b": [(1.0, 100.0)]}
    picture = panels_picture("t", "u", [Panel("p", lines, high=100.0)])
    dots = [line for line in picture.split("<") if line.startswith("circle")]
    rows = [float(dot.split('cy="')[1].split('"')[0]) for dot in dots]
    assert len(dots) == 3
    assert rows[1] == pytest.approx((rows[0] + rows[2]) / 2)
