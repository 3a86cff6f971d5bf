import numpy as np
import pytest
from silhouette_mocap.core.body.templates.profiles import default_profiles
from silhouette_mocap.core.geometry.ring_choice import (
    chosen_samples,
    fitted_sections,
    sample_weights,
)


def left_over(stations, radii, picked):
    """Weighted squared distances from the outline that straight pieces leave."""
    sections = fitted_sections(stations, radii, picked)
    drawn = np.array([np.interp(stations, stations[picked], r) for r in sections.T]).T
    return (sample_weights(stations)[:, None] * (drawn - radii) ** 2).sum()


@pytest.mark.parametrize("piece", ["thigh", "skull", "hand"])
def test_hardly_any_of_many_other_choices_is_better(piece):
    stations, radii = default_profiles()[piece].sampled()
    ours = left_over(stations, radii, chosen_samples(stations, radii, 7))
    rng, last = np.random.default_rng(1), len(stations) - 1
    others = [
        np.r_[0, np.sort(rng.choice(np.arange(1, last), 5, replace=False)), last]
        for _ in range(500)
    ]
    assert np.mean([left_over(stations, radii, other) < ours for other in others]) <= 0.01


def test_a_bend_gets_a_ring_and_straight_pieces_get_none():
    stations = np.linspace(0, 1, 41)
    radii = np.interp(stations, [0, 0.2, 0.7, 1], [0, 0.1, 0.06, 0])[:, None].repeat(4, axis=1)
    picked = chosen_samples(stations, radii, 4)
    np.testing.assert_allclose(stations[picked], [0, 0.2, 0.7, 1], atol=0.026)


def test_more_rings_than_samples_are_all_samples():
    stations, radii = np.linspace(0, 1, 5), np.ones((5, 4))
    np.testing.assert_array_equal(chosen_samples(stations, radii, 99), np.arange(5))


def test_what_lies_beyond_the_axis_counts_a_quarter():
    weights = sample_weights(np.linspace(-1, 2, 31))
    assert weights[5] == pytest.approx(0.25 * weights[15])
