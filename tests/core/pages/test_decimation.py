"""Long series drawn with few points."""

import numpy as np
from silhouette_mocap.core.pages.decimation import decimated, runs


def slow_decimated(columns, values):
    kept = set()
    for column in set(columns.tolist()):
        inside = np.flatnonzero(columns == column)
        kept |= {inside[values[inside].argmin()], inside[values[inside].argmax()]}
    return sorted(kept)


def test_every_column_keeps_its_lowest_and_highest_value():
    rng = np.random.default_rng(0)
    columns = np.sort(rng.integers(0, 40, 1000))
    values = rng.standard_normal(1000)
    np.testing.assert_array_equal(decimated(columns, values), slow_decimated(columns, values))


def test_a_flat_column_keeps_one_or_two_points():
    kept = decimated(np.zeros(100, int), np.ones(100))
    assert 1 <= len(kept) <= 2


def test_short_series_stay_whole():
    np.testing.assert_array_equal(decimated(np.array([0, 0, 0, 1]), np.arange(4.0)), range(4))


def test_runs_end_at_gaps_of_values_and_of_frames():
    frames = np.array([3, 4, 5, 9, 10, 11])
    values = np.array([1.0, np.nan, 2.0, 3.0, 4.0, np.inf])
    assert runs(frames, values) == [slice(0, 1), slice(2, 3), slice(3, 5)]


def test_nothing_finite_has_no_runs():
    assert runs(np.arange(3), np.full(3, np.nan)) == []
