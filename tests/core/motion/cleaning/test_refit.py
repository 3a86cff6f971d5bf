import numpy as np
import pytest
from silhouette_mocap.core.motion.cleaning.refit import Refit


def refit(count, rate=30.0, cut_off=6.0, **changes):
    values = {
        "weights": np.ones(count),
        "gaps": np.zeros(count, bool),
        "held": np.zeros(count, bool),
    }
    return Refit(rate, cut_off, **{**values, **changes})


def dense_curve(fit, values):
    """The minimum of the sum of squares in the module's head, by a dense solver."""
    second = np.diff(np.eye(len(values)), 2, axis=0)
    rows = np.vstack([np.diag(np.sqrt(fit.weights)), np.sqrt(fit.penalty) * second])
    right = np.concatenate([np.sqrt(fit.weights)[:, None] * values, np.zeros((len(second), 2))])
    free = ~fit.held
    right = right - rows[:, fit.held] @ values[fit.held]
    found = values.copy()
    found[free] = np.linalg.lstsq(rows[:, free], right, rcond=None)[0]
    return found


@pytest.mark.parametrize("held", [[], [0], [3, 4, 11]])
def test_the_curve_is_the_least_squares_solution(held):
    rng = np.random.default_rng(1)
    values = rng.normal(size=(12, 2))
    fit = refit(12, weights=rng.uniform(0.1, 1, 12), held=np.isin(np.arange(12), held))
    assert np.abs(fit.curve(values, np.inf) - dense_curve(fit, values)).max() < 1e-12


@pytest.mark.parametrize("rate", [15.0, 30.0, 120.0])
@pytest.mark.parametrize("share", [0.5, 1.0, 1.3])
def test_a_sine_keeps_the_share_of_the_formula_at_any_rate(rate, share):
    cut_off = 5.0
    frequency = share * cut_off
    time = np.arange(round(40 * rate)) / rate
    found = refit(len(time), rate, cut_off).curve(
        np.sin(2 * np.pi * frequency * time)[:, None], 1e9
    )
    sines = np.sin(np.pi * frequency / rate) / np.sin(np.pi * cut_off / rate)
    middle = slice(len(time) // 4, -len(time) // 4)
    amplitude = np.sqrt(2 * np.mean(found[middle] ** 2))
    assert amplitude == pytest.approx(1 / (1 + sines**4), rel=0.01)


def test_straight_lines_stay_as_they_are_to_the_ends():
    values = np.column_stack([np.arange(20.0), 3 - 2 * np.arange(20.0)])
    assert np.abs(refit(20).curve(values, np.inf) - values).max() < 1e-10


def test_what_is_held_stays_to_the_bit():
    values = np.random.default_rng(2).normal(size=(30, 3))
    held = np.arange(30) % 7 == 2
    assert np.array_equal(refit(30, held=held).curve(values, np.inf)[held], values[held])


def test_one_value_that_nobody_could_reach_hardly_pulls():
    time = np.arange(60) / 60
    truth = np.sin(2 * np.pi * time)[:, None]
    wrong = truth.copy()
    wrong[30] += 2.0
    off = np.abs(refit(60, 60.0).curve(wrong, 1000.0) - truth).max()
    believed = np.abs(refit(60, 60.0).curve(wrong, np.inf) - truth).max()
    assert off < 0.1 < 0.3 < believed


@pytest.mark.parametrize("seconds", [0.2, 0.5])
def test_gaps_are_bridged_whatever_they_hold(seconds):
    rate, time = 30.0, np.arange(90) / 30
    truth = np.sin(2 * np.pi * 0.4 * time)[:, None]
    gaps = np.abs(time - 1.5) < seconds / 2
    values = np.where(gaps[:, None], 77.0, truth)
    assert np.abs(refit(90, rate, gaps=gaps).curve(values, 1000.0) - truth).max() < 0.05


def test_a_long_gap_at_the_end_does_not_run_away():
    time = np.arange(120) / 30
    gaps = time > 1
    values = np.where(gaps, 0.0, 2 * time)[:, None]
    found = refit(120, gaps=gaps).curve(values, 1000.0)
    assert 2 < found[-1, 0] < 3


def test_what_is_pinned_goes_through_the_held_values_and_stays_elsewhere():
    values = np.zeros((60, 1))
    held = np.arange(60) == 30
    found = refit(60, held=held).pinned(values, values + 1.0)
    assert found[30, 0] == 1.0
    assert np.abs(np.diff(found[:, 0], 2)).max() < 1.2
    assert np.abs(found[:15]).max() < 0.01 and np.abs(found[45:]).max() < 0.01


@pytest.mark.parametrize("count", [3, 4, 5])
def test_few_frames_are_enough(count):
    values = np.random.default_rng(count).normal(size=(count, 2))
    assert np.isfinite(refit(count).curve(values, np.inf)).all()
