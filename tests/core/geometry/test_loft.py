import numpy as np
import pytest

from silhouette_mocap.core.geometry.loft import Profile, lofted, rings

FRONT = np.array([0.0, -1.0, 0.0])
ORIGIN = np.zeros(3)
DOWN = np.array([0.0, 0.0, -1.0])


def volume(vertices, triangles):
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def capsule(radius=0.1, exponent=2.0):
    return Profile((-0.1, 1.1), [0.0, 1.0], np.full((2, 4), radius), exponent)


def test_the_mesh_is_closed_and_every_edge_runs_once_each_way():
    _, triangles = lofted(capsule(), ORIGIN, DOWN, FRONT, (8, 5))
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    there = {tuple(edge) for edge in edges.tolist()}
    assert len(there) == len(edges)
    assert there == {(b, a) for a, b in there}


def test_a_capsule_has_the_volume_of_a_cylinder_and_a_ball():
    vertices, triangles = lofted(capsule(), ORIGIN, DOWN, FRONT, (48, 40))
    assert volume(vertices, triangles) == pytest.approx(np.pi * 0.01 * (1 + 4 / 3 * 0.1), rel=0.01)


def test_outer_is_left_and_front_is_forward_for_a_hanging_bone():
    radii = np.array([[0.1, 0.2, 0.3, 0.4]] * 2)
    profile = Profile((-0.01, 1.01), [0.0, 1.0], radii)
    vertices, _ = lofted(profile, ORIGIN, DOWN, FRONT, (64, 12))
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    assert high[0] == pytest.approx(0.1, rel=0.02)
    assert low[0] == pytest.approx(-0.2, rel=0.02)
    assert low[1] == pytest.approx(-0.3, rel=0.02)
    assert high[1] == pytest.approx(0.4, rel=0.02)


def test_the_surface_closes_at_its_ends():
    vertices, _ = lofted(capsule(), ORIGIN, DOWN, FRONT, (8, 5))
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
    coarse, fine = (volume(*lofted(profile, ORIGIN, DOWN, FRONT, (32, n))) for n in (5, 40))
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
