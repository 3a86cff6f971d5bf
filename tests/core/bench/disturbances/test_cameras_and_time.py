"""Disturbances of cameras and of time, against what they say of themselves."""

import numpy as np
import pytest
from known_recording import known_recording
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.bench.disturbances.failing_cameras import (
    CalibrationError,
    DeadCamera,
    FrozenCamera,
    Occluder,
)
from silhouette_mocap.core.bench.disturbances.less_footage import EveryKth, SomeCameras
from silhouette_mocap.core.bench.disturbances.recording import Only, disturbed
from silhouette_mocap.core.bench.disturbances.timing import OutOfStep

RECORDING = known_recording()


def same(one, other):
    return np.array_equal(one.foreground, other.foreground)


def test_a_dead_camera_sees_nobody_and_takes_that_for_true():
    seen = disturbed(RECORDING, 0, DeadCamera()).look(2, 1)
    assert not seen.foreground.any() and seen.observed.all()


def test_a_frozen_camera_shows_one_picture():
    frozen = disturbed(RECORDING, 0, FrozenCamera(4))
    assert all(same(frozen.look(frame, 2), RECORDING.look(4, 2)) for frame in RECORDING.frames)
    assert not same(RECORDING.look(9, 2), RECORDING.look(4, 2))


@pytest.mark.parametrize("told", [False, True])
def test_an_occluder_hides_a_pole_of_its_width(told):
    view, width = 1, 0.25
    hiding = disturbed(RECORDING, 0, Occluder(width, told))
    clean, found = RECORDING.look(5, view), hiding.look(5, view)
    hidden = np.flatnonzero((clean.foreground & ~found.foreground).any(axis=0))
    camera = RECORDING.cameras[view]
    centre = RECORDING.truth.points.mean(axis=(0, 1))
    px = width * camera.matrix[0, 0] / camera.depths(centre)
    assert len(hidden) == pytest.approx(px, abs=1.0)
    assert np.ptp(hidden) + 1 == len(hidden)
    assert not found.foreground[:, hidden].any()
    assert found.observed.all() != told
    if told:
        assert not found.observed[:, hidden].any()


def test_a_calibration_error_is_as_large_as_said_and_leaves_the_pictures():
    wrong = disturbed(RECORDING, 5, CalibrationError(0.3, 20.0))
    turns = set()
    for camera, found in zip(RECORDING.cameras, wrong.cameras, strict=True):
        turn = Rotation.from_matrix(found.rotation @ camera.rotation.T).magnitude()
        assert np.degrees(turn) == pytest.approx(0.3)
        assert np.linalg.norm(found.centre - camera.centre) == pytest.approx(0.020)
        turns.add(tuple(np.round(found.centre - camera.centre, 6)))
    assert len(turns) == len(RECORDING.cameras)
    assert same(wrong.look(3, 0), RECORDING.look(3, 0))


def test_a_camera_out_of_step_shows_another_moment():
    late, early = (disturbed(RECORDING, 0, OutOfStep(frames)) for frames in (-1, 2))
    assert same(late.look(5, 0), RECORDING.look(4, 0))
    assert same(early.look(5, 0), RECORDING.look(7, 0))
    assert same(late.look(0, 0), RECORDING.look(0, 0))
    assert same(early.look(9, 0), RECORDING.look(9, 0))


def test_half_a_frame_is_one_of_every_other_frame():
    half = disturbed(RECORDING, 0, Only(OutOfStep(1), None, (1,)), EveryKth(2))
    assert half.frames == (0, 2, 4, 6, 8)
    assert same(half.look(4, 1), RECORDING.look(5, 1))
    assert same(half.look(4, 0), RECORDING.look(4, 0))


def test_frames_are_left_out_everywhere_or_within_some():
    assert disturbed(RECORDING, 0, EveryKth(3)).frames == (0, 3, 6, 9)
    assert disturbed(RECORDING, 0, EveryKth(3, (2, 6))).frames == (0, 1, 2, 5, 7, 8, 9)
    with pytest.raises(ValueError, match="every 0th"):
        EveryKth(0)


def test_some_cameras_are_what_they_were():
    fewer = disturbed(RECORDING, 0, SomeCameras((3, 1)))
    assert fewer.cameras == (RECORDING.cameras[3], RECORDING.cameras[1])
    assert same(fewer.look(2, 0), RECORDING.look(2, 3))
    assert len(fewer.silhouettes(2)) == 2
