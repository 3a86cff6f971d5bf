"""The spline through a contour, its curvature and its creases, against shapes that are known."""

import numpy as np
import pytest
from polygons import polygon
from silhouette_mocap.core.initialisation.contour_rules.outline import (
    Outline,
    curvature,
    traced_contour,
)
from silhouette_mocap.core.initialisation.contour_rules.upright import Upright
from silhouette_mocap.core.silhouettes.silhouette import Silhouette

DOWNWARDS = np.array([0.0, -1.0])


def silhouette(mask: np.ndarray) -> Silhouette:
    return Silhouette(mask, np.ones_like(mask))


def test_the_curvature_of_an_ellipse_is_the_formulas():
    a, b = 0.5, 0.3
    angles = np.linspace(0, 2 * np.pi, 3000, endpoint=False)
    outline = Outline.of(np.stack([a * np.cos(angles), b * np.sin(angles)], axis=1))
    places = np.linspace(0.0, 1.0, 40)
    x, y = outline.spline(places).T
    # of x²/a² + y²/b² = 1 at (x, y)
    expected = (x**2 / a**4 + y**2 / b**4) ** -1.5 / (a * b) ** 2
    assert curvature(outline.spline, places) == pytest.approx(expected, rel=0.01)


def test_a_round_shape_has_no_crease():
    angles = np.linspace(0, 2 * np.pi, 3000, endpoint=False)
    outline = Outline.of(0.4 * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    assert not len(outline.creases)
    assert outline.curvature == pytest.approx(1 / 0.4, rel=0.01)


def test_an_l_is_creased_in_its_corner_and_bulges_at_its_other_five():
    corners = ((0, 0), (0.6, 0), (0.6, 0.3), (0.3, 0.3), (0.3, 1.0), (0, 1.0))
    outline = Outline.of(polygon(*corners))
    assert len(outline.creases) == 1
    assert outline.points[outline.creases[0]] == pytest.approx([0.3, 0.3], abs=0.02)
    bulges = outline.points[outline.bulges]
    for corner in (0, 1, 2, 4, 5):
        assert np.linalg.norm(bulges - corners[corner], axis=1).min() < 0.02


def test_a_dent_of_one_contour_point_does_not_persist():
    smooth = Outline.of(polygon((0, 0), (0.6, 0), (0.6, 1.0), (0, 1.0)))
    # a hundredth of the height wide and deep
    dent = ((0.6, 0.495), (0.59, 0.5), (0.6, 0.505))
    dented = Outline.of(polygon((0, 0), (0.6, 0), *dent, (0.6, 1.0), (0, 1.0)))
    deep = ((0.6, 0.45), (0.5, 0.5), (0.6, 0.55))
    notched = Outline.of(polygon((0, 0), (0.6, 0), *deep, (0.6, 1.0), (0, 1.0)))
    assert len(smooth.creases) == len(dented.creases) == 0
    assert len(notched.creases) == 1


def test_a_disc_of_pixels_is_traced_between_its_pixels():
    rows, columns = np.mgrid[:120, :160]
    mask = np.hypot(columns - 80.3, rows - 60.2) <= 40
    upright = Upright(np.array([80.3, 60.2]), DOWNWARDS, 1.0)
    contour = traced_contour(silhouette(mask), upright)
    # the pixels' steps stay within half of one
    assert np.linalg.norm(contour, axis=1) == pytest.approx(40.0, abs=0.5)
    assert np.linalg.norm(contour, axis=1).mean() == pytest.approx(40.0, abs=0.15)


@pytest.mark.parametrize("quarter_turns", range(4))
def test_a_turned_picture_gives_the_same_upright_contour(quarter_turns):
    mask = np.zeros((100, 80), bool)
    mask[20:80, 30:40] = mask[70:80, 30:60] = True
    up = DOWNWARDS
    for _ in range(quarter_turns):
        mask, up = np.rot90(mask), np.array([up[1], -up[0]])
    upright = Upright.of(silhouette(mask), up)
    contour = traced_contour(silhouette(mask), upright)
    assert upright.height_px == 60
    assert contour[:, 1].min() == pytest.approx(0.0, abs=0.01)
    assert contour[:, 1].max() == pytest.approx(1.0, abs=0.01)
    # the foot of the L points to the right
    low = contour[contour[:, 1] < 0.1, 0]
    high = contour[contour[:, 1] > 0.5, 0]
    assert high.mean() == pytest.approx(0.0, abs=0.05)
    assert np.ptp(low) == pytest.approx(0.5, abs=0.02)
    assert low.max() - high.max() == pytest.approx(1 / 3, abs=0.02)


def test_px_and_heights_are_each_others_inverses():
    upright = Upright(np.array([31.0, 77.0]), np.array([0.3, -0.9]), 55.0)
    places = np.random.default_rng(1).normal(size=(20, 2))
    assert upright.from_px(upright.to_px(places)) == pytest.approx(places)
