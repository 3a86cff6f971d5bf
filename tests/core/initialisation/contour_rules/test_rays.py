"""Where rays meet, against cases worked out by hand."""

import numpy as np
import pytest
from silhouette_mocap.core.initialisation.contour_rules.rays import Planes, Rays, meeting


def rays(*lines: tuple[tuple, tuple], weights: tuple[float, ...] | None = None) -> Rays:
    centres, ways = (np.array(column, float) for column in zip(*lines, strict=True))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    return Rays(centres, ways, np.array(weights or [1.0] * len(lines)))


def through(point: tuple, *centres: tuple) -> list[tuple[tuple, tuple]]:
    return [(centre, tuple(np.subtract(point, centre))) for centre in centres]


def test_two_skew_rays_meet_in_the_middle_of_the_shortest_line_between_them():
    # along x at z = 1, along y at z = 1.03
    found = meeting(rays(((-4, 0.5, 1), (1, 0, 0)), ((0.2, -4, 1.03), (0, 1, 0))))
    assert found.point == pytest.approx([0.2, 0.5, 1.015], abs=1e-6)
    assert found.gap == pytest.approx(0.03)
    assert found.depth == pytest.approx(0.5)


@pytest.mark.parametrize("degrees", [30, 60, 150, 180])
def test_the_depth_of_two_rays_is_what_their_angle_leaves(degrees):
    angle = np.radians(degrees)
    centres = (0.0, -4.0, 1.0), (4 * np.sin(angle), -4 * np.cos(angle), 1.0)
    found = meeting(rays(*through((0, 0, 1), *centres)))
    assert found.depth == pytest.approx((1 - abs(np.cos(angle))) / 2, abs=1e-9)


def test_more_rays_meet_where_the_squares_are_least():
    lines = ((-4, 0, 0), (1, 0, 0)), ((-4, 0.03, 0), (1, 0, 0)), ((0, -4, 0), (0, 1, 0))
    found = meeting(rays(*lines))
    assert found.point == pytest.approx([0, 0.015, 0], abs=1e-6)


def test_a_bad_ray_is_outvoted():
    point = (0.3, -0.2, 1.4)
    good = through(point, (4, 0, 1), (0, -4, 1.5), (-4, 1, 1), (1, 4, 2))
    bad = through((0.3, 0.3, 1.1), (3, -3, 1))
    found = meeting(rays(*good, *bad))
    assert np.linalg.norm(found.point - point) < 0.005


def test_a_plane_says_where_along_rays_that_face_each_other():
    facing = rays(*through((0.1, 0.2, 1.0), (0.1, -4, 1.0), (0.1, 4, 1.0)))
    assert meeting(facing).depth == pytest.approx(0.0, abs=1e-9)
    known = meeting(facing, Planes(np.array([[0.0, 1.0, 0.0]]), np.array([0.2])))
    assert known.point == pytest.approx([0.1, 0.2, 1.0])
    assert known.depth > 0.3


def test_two_bad_rays_of_six_count_the_less_the_further_off_they_are():
    point = (0.3, -0.2, 1.4)
    good = through(point, (4, 0, 1), (0, -4, 1.5), (-4, 1, 1), (1, 4, 2))
    bad = (*through((0.3, 0.3, 1.1), (3, -3, 1)), *through((0.3, 0.1, 1.6), (-3, -3, 1)))
    found = meeting(rays(*good, *bad))
    assert np.linalg.norm(found.point - point) < 0.005


def test_planes_say_which_of_two_rays_is_wrong_where_the_others_face_each_other():
    point = (0.0, 0.0, 1.0)
    facing = through(point, (0.0, -4, 1), (0.0, 4, 1))
    # the one crosses them at the point, the other 0.2 m behind it
    across = (*through(point, (3, -3, 1)), *through((0.0, 0.2, 1.0), (-3, 3, 1)))
    for behind in (0.0, 0.2):
        sides = Planes(np.array([[0.0, 1.0, 0.0]]), np.array([behind]), 0.1)
        found = meeting(rays(*facing, *across), sides)
        assert found.point == pytest.approx([0.0, behind, 1.0], abs=0.02)
