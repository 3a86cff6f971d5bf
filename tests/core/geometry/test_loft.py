import numpy as np
import pytest
from silhouette_mocap.core.geometry.loft import Axis, Profile, lofted, rings
from silhouette_mocap.core.geometry.ring_choice import chosen_samples

FRONT = np.array([0.0, -1.0, 0.0])
ORIGIN = np.zeros(3)
DOWN = np.array([0.0, 0.0, -1.0])


def hanging(profile, sides, count):
    """The mesh of a profile along a bone of one metre that hangs down from the origin."""
    picked = chosen_samples(*profile.sampled(), count + 2)
    return lofted(profile, Axis(ORIGIN, DOWN, FRONT), sides, picked)


def volume(vertices, triangles):
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def capsule(radius=0.1, exponent=2.0):
    return Profile((-0.1, 1.1), [0.0, 1.0], np.full((2, 4), radius), exponent)


def test_the_mesh_is_closed_and_every_edge_runs_once_each_way():
    _, triangles = hanging(capsule(), 8, 5)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    there = {tuple(edge) for edge in edges.tolist()}
    assert len(there) == len(edges)
    assert there == {(b, a) for a, b in there}


def test_a_capsule_has_the_volume_of_a_cylinder_and_a_ball():
    vertices, triangles = hanging(capsule(), 48, 40)
    assert volume(vertices, triangles) == pytest.approx(np.pi * 0.01 * (1 + 4 / 3 * 0.1), rel=0.015)


def test_outer_is_left_and_front_is_forward_for_a_hanging_bone():
    radii = np.array([[0.1, 0.2, 0.3, 0.4]] * 2)
    profile = Profile((-0.01, 1.01), [0.0, 1.0], radii)
    vertices, _ = hanging(profile, 64, 12)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    assert high[0] == pytest.approx(0.1, rel=0.02)
    assert low[0] == pytest.approx(-0.2, rel=0.02)
    assert low[1] == pytest.approx(-0.3, rel=0.02)
    assert high[1] == pytest.approx(0.4, rel=0.02)


def test_the_surface_closes_at_its_ends():
    vertices, _ = hanging(capsule(), 8, 5)
    assert vertices[:, 2].max() == pytest.approx(0.1)
    assert vertices[:, 2].min() == pytest.approx(-1.1)


@pytest.mark.parametrize("sides", [6, 8, 14])
def test_a_ring_is_as_wide_on_average_as_the_circle_it_stands_for(sides):
    ring = rings(np.ones((1, 4)), 2.0, sides)[0]
    angles = np.linspace(0, np.pi, 2000, endpoint=False)
    along = ring @ np.stack([np.cos(angles), np.sin(angles)])
    assert (along.max(axis=0) - along.min(axis=0)).mean() == pytest.approx(2.0, rel=1e-4)


def test_a_boxier_exponent_fills_the_corners():
    diagonal = [np.abs(rings(np.ones((1, 4)), n, 8)[0][1]).min() for n in (2.0, 4.0)]
    assert diagonal[1] > 1.15 * diagonal[0]


def test_few_rings_keep_the_volume_of_many():
    radii = np.array([[0.05] * 4, [0.12] * 4, [0.06] * 4])
    profile = Profile((-0.1, 1.1), [0.0, 0.4, 1.0], radii)
    coarse, fine = (volume(*hanging(profile, 32, n)) for n in (5, 40))
    assert coarse == pytest.approx(fine, rel=0.02)


@pytest.mark.parametrize(
    ("ends", "stations", "radii", "message"),
    [
        ((0.1, 1.1), [0.0, 1.0], 0.1, "rising"),
        ((-0.1, 1.1), [0.5, 0.5], 0.1, "rising"),
        ((-0.1, 1.1), [0.0, 1.0], -0.1, "at least 0"),
    ],
)
def test_impossible_profiles_are_refused(ends, stations, radii, message):
    with pytest.raises(ValueError, match=message):
        Profile(ends, stations, np.full((2, 4), radii))


@pytest.mark.parametrize("middle", [0.3, 0.5])
def test_rings_stay_at_their_samples_when_the_shape_is_scaled(middle):
    radii = np.outer([0.05, 0.12, 0.05], np.ones(4))
    stations, radii = Profile((-0.1, 1.1), [0.0, middle, 1.0], radii).sampled()
    first = chosen_samples(stations, radii, 9)
    for factor in np.linspace(1.01, 1.3, 30):
        np.testing.assert_array_equal(chosen_samples(stations, factor * radii, 9), first)
