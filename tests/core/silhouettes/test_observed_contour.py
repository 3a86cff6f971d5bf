import numpy as np
from silhouette_mocap.core.silhouettes.silhouette import Silhouette

CENTRE, RADIUS = np.array([40.3, 30.8]), 14.2


def disc(height=64, width=80):
    y, x = np.mgrid[:height, :width]
    return np.hypot(x - CENTRE[0], y - CENTRE[1]) < RADIUS


def everywhere(mask):
    return np.ones(mask.shape, bool)


def test_points_lie_on_the_contour_and_normals_point_away():
    contour = Silhouette(disc(), everywhere(disc())).contour
    away = contour.px - CENTRE
    distances = np.linalg.norm(away, axis=1)
    assert np.abs(distances - RADIUS).max() < 0.5
    assert abs(distances.mean() - RADIUS) < 0.1
    assert ((contour.normals * away).sum(axis=1) / distances > 0.95).all()
    np.testing.assert_allclose(np.linalg.norm(contour.normals, axis=1), 1, atol=1e-5)


def test_the_field_is_the_distance_to_the_contour():
    field = Silhouette(disc(), everywhere(disc())).contour.field
    y, x = np.mgrid[:64, :80]
    wanted = np.hypot(x - CENTRE[0], y - CENTRE[1]) - RADIUS
    near = np.abs(wanted) < 8
    assert np.abs(field - wanted)[near].max() < 0.8


def test_wider_spacing_leaves_fewer_points():
    counts = [
        len(Silhouette(disc(), everywhere(disc())).contour.thinned(spacing).px)
        for spacing in (1.0, 2.0, 4.0)
    ]
    around = 2 * np.pi * RADIUS
    assert counts[0] > around * 0.8
    assert counts[1] < 0.75 * counts[0]
    assert counts[2] < 0.6 * counts[1]


def test_what_was_not_observed_has_no_distance_and_no_points():
    observed = everywhere(disc())
    observed[:, 40:] = False
    contour = Silhouette(disc(), observed).contour
    assert np.isnan(contour.field[:, 40:]).all()
    assert not np.isnan(contour.field[:, :40]).any()
    assert contour.px[:, 0].max() < 40
    assert len(contour.px) > 20


def test_the_edge_of_the_picture_is_no_contour():
    mask = np.zeros((40, 60), bool)
    mask[10:30, 20:] = True
    contour = Silhouette(mask, everywhere(mask)).contour
    assert (np.abs(contour.normals[contour.px[:, 0] > 50, 0]) < 0.1).all()
    straight = (contour.px[:, 0] > 25) & (contour.px[:, 0] < 55)
    assert np.isin(contour.px[straight, 1].round(1), [9.5, 29.5]).all()


def test_nobody_and_nothing_else_have_no_contour():
    for mask in (np.zeros((20, 30), bool), np.ones((20, 30), bool)):
        contour = Silhouette(mask, everywhere(mask)).contour
        assert contour.px.shape == contour.normals.shape == (0, 2)
        assert np.isnan(contour.field).all()


def test_a_picture_of_nothing_but_noise_has_its_contour_too():
    noise = np.random.default_rng(0).random((240, 320)) < 0.5
    found = Silhouette(noise, everywhere(noise)).contour
    crossings = sum(np.count_nonzero(np.diff(noise, axis=axis)) for axis in (0, 1))
    assert len(found.px) == crossings > 1 << 15
    np.testing.assert_allclose(np.linalg.norm(found.normals, axis=1), 1.0, atol=1e-5)
