import numpy as np
import pytest
from moving import motion_with, rms, swaying
from silhouette_mocap.core.body.kinematics import clamped, points, within_limits
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.cleaning.settings import FILTERS, CleanSettings
from silhouette_mocap.core.motion.cleaning.smoothing import frame_weights
from silhouette_mocap.core.motion.cleaning.smoothing import smoothed as smoothed_with
from silhouette_mocap.core.progress import SILENCE
from synthetic import dof_values, small_body

BODY = small_body("performer")
RATE = 30.0


def smoothed(body, motion, settings):
    return smoothed_with(body, motion, settings, SILENCE)


@pytest.fixture(scope="module")
def truth():
    return swaying(BODY, 3.0, RATE)


def noisy(truth, seed=0, spread=0.05):
    noise = np.random.default_rng(seed).normal(0, spread, truth.shape)
    noise[:, :3] *= 0.2
    return clamped(BODY, truth + noise)


def errors(poses, truth):
    return points(BODY, poses) - points(BODY, truth)


@pytest.mark.parametrize(("name", "left"), [("refit", 0.62), ("butterworth", 0.65)])
def test_noise_falls_to_the_share_that_the_cut_off_leaves(truth, name, left):
    """White noise below 5 of 15 Hz: the square root of a third, 0.58, and a little of sway."""
    raw = noisy(truth)
    found = smoothed(BODY, motion_with(BODY, raw), CleanSettings(name, smooth_hz=5.0))
    assert rms(errors(found, truth)) < left * rms(errors(raw, truth))
    assert rms(np.diff(errors(found, truth), 2, axis=0)) < 0.25 * rms(
        np.diff(errors(raw, truth), 2, axis=0)
    )


def test_one_euro_calms_what_stands_still(truth):
    still = np.repeat(truth[:1], 90, axis=0)
    raw = noisy(still)
    found = smoothed(BODY, motion_with(BODY, raw), CleanSettings("one-euro", smooth_hz=1.0))
    assert rms(np.diff(found[30:], axis=0)) < 0.35 * rms(np.diff(raw[30:], axis=0))


def test_a_punch_of_30_centimetres_in_a_sixth_of_a_second_loses_less_than_two_centimetres():
    time = np.arange(90) / RATE
    stroke = np.exp(-(((time - 1.5) / 0.1) ** 2))
    poses = np.repeat(dof_values(BODY, left_elbow_flexion=1.8)[None], 90, axis=0)
    index = BODY.dofs.names.index
    poses[:, index("left_elbow_flexion")] -= 1.6 * stroke
    poses[:, index("left_shoulder_flexion")] += 1.2 * stroke
    found = smoothed(BODY, motion_with(BODY, poses), CleanSettings())
    assert np.linalg.norm(np.ptp(points(BODY, poses), axis=0), axis=1).max() > 0.3
    assert np.linalg.norm(errors(found, poses), axis=2).max() < 0.02


@pytest.mark.parametrize("name", FILTERS)
def test_locked_frames_are_untouched_and_limits_hold(truth, name):
    raw, locked = noisy(truth, 1, 0.3), np.arange(90) % 20 == 7
    found = smoothed(BODY, motion_with(BODY, raw, locked=locked), CleanSettings(name))
    assert np.array_equal(found[locked], raw[locked])
    assert within_limits(BODY, found).all()
    assert rms(np.diff(found, 2, axis=0)) < 0.7 * rms(np.diff(raw, 2, axis=0))


@pytest.mark.parametrize("name", FILTERS)
def test_lost_frames_are_filled_whatever_they_hold(truth, name):
    lost = np.abs(np.arange(90) - 50) <= 3
    spoilt = truth.copy()
    spoilt[lost] = clamped(BODY, np.random.default_rng(2).normal(0, 2, (7, len(BODY.dofs))))
    found = smoothed(BODY, motion_with(BODY, spoilt, lost=lost), CleanSettings(name))
    plain = smoothed(BODY, motion_with(BODY, truth), CleanSettings(name))
    assert np.linalg.norm(errors(found, plain), axis=2).max() < 0.03


def test_a_single_wrong_frame_hardly_pulls(truth):
    rate = 60
    calm = swaying(BODY, 2.0, rate, 0.4)
    wrong = calm.copy()
    wrong[60] = clamped(BODY, wrong[60:61] + 1.0)[0]
    found = smoothed(BODY, motion_with(BODY, wrong, fps=(rate, 1)), CleanSettings())
    assert np.linalg.norm(errors(found, calm), axis=2).max() < 0.05
    assert np.linalg.norm(errors(wrong, calm), axis=2).max() > 1.0


def test_the_frame_rate_changes_nothing():
    slow, fast = (swaying(BODY, 2.0, rate, 2.0) for rate in (30, 120))
    settings = CleanSettings(smooth_hz=4.0)
    found = [
        smoothed(BODY, motion_with(BODY, poses, fps=(rate, 1)), settings)
        for poses, rate in ((slow, 30), (fast, 120))
    ]
    middle = slice(15, -15)
    assert np.abs(found[0] - found[1][::4])[middle].max() < 0.02
    assert np.abs(found[0] - slow)[middle].max() > 0.02


def test_doubt_is_answered_with_stronger_smoothing(truth):
    raw = noisy(truth)
    sure, doubtful = (
        smoothed(BODY, motion_with(BODY, raw, confidence_raw=np.full((90, 14), c)), CleanSettings())
        for c in (0.9999, 0.5)
    )
    assert rms(np.diff(doubtful, 2, axis=0)) < 0.6 * rms(np.diff(sure, 2, axis=0))


def test_weights_fall_with_the_square_of_the_spread():
    spreads = np.array([0.01, 0.02, 0.04, 0.08])
    confidence = 1 - np.exp(-(0.05**2) / (2 * spreads**2))
    weights = frame_weights(np.repeat(confidence[:, None], 14, axis=1))
    assert np.allclose(weights, [1, 1, 1 / 4, 1 / 16])
    assert frame_weights(np.zeros((1, 14))) > 0


@pytest.mark.parametrize("count", [1, 2, 3])
def test_very_short_motions_pass(truth, count):
    found = smoothed(BODY, motion_with(BODY, truth[:count]), CleanSettings("butterworth"))
    assert found.shape == (count, len(BODY.dofs)) and np.isfinite(found).all()


def test_a_cut_off_at_half_the_rate_is_refused(truth):
    with pytest.raises(MocapError, match=r"15 Hz is not below 15 Hz, half .* 30 .* such as 6"):
        smoothed(BODY, motion_with(BODY, truth), CleanSettings(smooth_hz=15.0))


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"filter": "median"}, "no filter 'median'; use refit"),
        ({"smooth_hz": 0.0}, "a cut-off of 0 is none; .*--smooth 6"),
        ({"smooth_hz": float("nan")}, "a cut-off of nan is none"),
        ({"keys_mm": -1.0}, "a tolerance of keys of -1 is none; .*--keys 5"),
    ],
)
def test_settings_that_mean_nothing_are_refused(changes, told):
    with pytest.raises(MocapError, match=told):
        CleanSettings(**changes)
