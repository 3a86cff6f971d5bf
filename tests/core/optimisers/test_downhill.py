import numpy as np
import pytest
from silhouette_mocap.core.optimisers.downhill import Effort, downhill
from silhouette_mocap.core.optimisers.grid import grid_points, lowest
from silhouette_mocap.core.optimisers.line_energies import SAMPLES, LineEnergies


def bowl(centre, scales):
    return lambda points: (((points - centre) * scales) ** 2).sum(axis=1)


def test_downhill_finds_the_bottom_of_a_tilted_bowl():
    centre = np.array([0.3, -0.2, 0.1])
    mix = np.array([[1.0, 0.6, 0.0], [0.0, 1.0, 0.5], [0.0, 0.0, 1.0]])
    found = downhill(
        lambda p: (((p - centre) @ mix.T) ** 2).sum(axis=1),
        np.zeros(3),
        np.full(3, 0.05),
        Effort(8, 1e-4),
    )
    # Samples lie an eighth of a step apart near the start of a line.
    assert np.abs(found.point - centre).max() < 0.05
    assert found.energy == pytest.approx((((found.point - centre) @ mix.T) ** 2).sum(), abs=1e-6)


def test_downhill_crosses_the_flat_steps_of_a_pixel_count():
    centre = np.array([2.2, -1.4])

    def pixels(points):
        return np.floor(np.abs(points - centre) * 4).sum(axis=1)

    found = downhill(pixels, np.zeros(2), np.ones(2), Effort(5))
    assert found.energy == 0


def test_downhill_never_returns_worse_than_the_start():
    rng = np.random.default_rng(3)
    noise = lambda points: 1.0 + rng.random(len(points))  # noqa: E731
    found = downhill(noise, np.zeros(4), np.ones(4), Effort(2))
    assert found.energy < 1.5


def test_a_line_is_evaluated_in_one_batch_and_interpolated():
    batches = []

    def energies(points):
        batches.append(len(points))
        return np.abs(points[:, 0] - 1.3)

    line = LineEnergies(energies, np.zeros(2))
    assert line(np.array([1.0, 0.0])) == pytest.approx(0.3)
    assert line(np.array([1.6, 0.0])) == pytest.approx(0.3, abs=0.1)
    assert batches == [1, len(SAMPLES)]
    assert line(np.array([9.0, 0.0])) == pytest.approx(7.7)
    assert batches == [1, len(SAMPLES), 1]


def test_an_unbatched_energy_gives_the_same_minimum_as_a_batched_one():
    batched = bowl(np.array([0.4, 0.7]), np.array([1.0, 3.0]))
    single = lambda points: np.array([batched(p[None])[0] for p in points])  # noqa: E731
    both = [downhill(f, np.zeros(2), np.ones(2), Effort(4, 1e-3)) for f in (batched, single)]
    assert np.array_equal(both[0].point, both[1].point)


def test_grid_points_vary_only_the_given_axes_and_hold_the_centre():
    centre = np.array([1.0, 2.0, 3.0])
    points = grid_points(centre, 0.5, 5, np.array([0, 2]))
    assert points.shape == (25, 3)
    assert (points[:, 1] == 2.0).all()
    assert (points == centre).all(axis=1).any()
    assert points[:, 0].min() == 0.5
    assert points[:, 2].max() == 3.5


def test_the_lowest_grid_point_is_found():
    points = grid_points(np.zeros(2), 1.0, 9, np.array([0, 1]))
    found = lowest(bowl(np.array([0.5, -0.25]), np.ones(2)), points)
    assert np.allclose(found.point, [0.5, -0.25])


def test_point_by_point_needs_fewer_evaluations_and_never_repeats_one():
    asked = []

    def energies(points):
        asked.extend(map(tuple, points))
        return np.floor(np.abs(points - np.array([2.2, -1.4])) * 4).sum(axis=1)

    found = downhill(energies, np.zeros(2), np.ones(2), Effort(5, whole_lines=False))
    assert found.energy <= 1
    assert len(set(asked)) == len(asked)
    single = len(asked)
    downhill(energies, np.zeros(2), np.ones(2), Effort(5))
    assert single < (len(asked) - single) / 2
