import numpy as np
import pytest
from silhouette_mocap.core.optimisers.evolution import Evolution, evolved

SETTINGS = Evolution(population=40, generations=400, first_step=0.3, last_step=1e-7)
TRUTH = np.linspace(-1, 1, 8)


def turned_valley(ratio):
    """Points (N, 8) to the length of what is left, through a valley along no axis."""
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(8, 8)))[0]
    stretched = turn * np.geomspace(1, ratio, 8)

    return lambda points: np.linalg.norm((points - TRUTH) @ stretched, axis=1)


@pytest.mark.parametrize("ratio", [1.0, 100.0])
def test_the_bottom_of_a_cone_is_found_along_no_axis(ratio):
    rng = np.random.default_rng(4)
    found = evolved(turned_valley(ratio), np.zeros(8), np.eye(8), SETTINGS, rng)
    np.testing.assert_allclose(found, TRUTH, atol=1e-4)


def test_steps_as_of_counted_pixels_are_no_obstacle():
    cone = turned_valley(10.0)
    found = evolved(
        lambda points: np.floor(50 * cone(points)),
        np.zeros(8), np.eye(8), SETTINGS, np.random.default_rng(5),
    )  # fmt: skip
    # a step of the energy is 1 / 50 of what the steepest direction makes of 1
    assert cone(found[None])[0] < 0.03


def test_the_basis_undoes_the_valleys_shape():
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(8, 8)))[0]
    basis = turn / np.geomspace(1, 1e3, 8)
    short = Evolution(population=20, generations=100, first_step=100.0)
    distances = []
    for steps in (basis, np.eye(8)):
        found = evolved(turned_valley(1e3), np.zeros(8), steps, short, np.random.default_rng(6))
        distances.append(turned_valley(1e3)(found[None])[0])
    assert distances[0] < 1e-2 * distances[1]


def test_the_same_draws_give_the_same_bits_and_others_other_ones():
    few = Evolution(population=8, generations=5)
    one, again, other = (
        evolved(turned_valley(2.0), np.zeros(8), np.eye(8), few, np.random.default_rng(seed))
        for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(one, again)
    assert not np.array_equal(one, other)


def test_it_stops_at_its_last_step():
    calls = []

    def energy(points):
        calls.append(len(points))
        return np.linalg.norm(points, axis=1)

    settings = Evolution(population=12, generations=1000, first_step=1.0, last_step=0.5)
    evolved(energy, np.zeros(3), np.eye(3), settings, np.random.default_rng(0))
    assert set(calls) == {12}
    assert len(calls) < 30
