"""Weight maps against energies counted pixel by pixel."""

import numpy as np
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.energy.evaluator import WeightMaps
from silhouette_mocap.core.energy.weight_maps import halved, halved_camera, xor_weight_maps
from silhouette_mocap.core.silhouettes.silhouette import Silhouette


def test_constant_plus_weights_under_a_rendering_count_the_differing_observed_pixels():
    rng = np.random.default_rng(0)
    foreground, observed, rendered = rng.random((3, 12, 17)) > 0.4
    maps = xor_weight_maps([Silhouette(foreground, observed)])
    energy = maps.constants[0] + maps.maps[0][rendered].sum()
    assert energy == np.count_nonzero((foreground ^ rendered) & observed)


def test_halved_weights_give_the_same_energy_to_renderings_made_of_two_by_two_blocks():
    rng = np.random.default_rng(1)
    full = rng.integers(-1, 2, (7, 9)).astype(np.int16)
    half = halved(WeightMaps((full,), np.array([5])))
    rendered = rng.random((4, 5)) > 0.5
    big = np.kron(rendered, np.ones((2, 2), bool))[:7, :9]
    assert half.maps[0].shape == (4, 5) and half.maps[0].dtype == np.int16
    assert half.maps[0][rendered].sum() == full[big].sum()
    assert half.constants[0] == 5


def test_halved_camera_sees_a_point_at_the_middle_of_its_four_pixels():
    matrix = [[50, 0, 4], [0, 50, 3], [0, 0, 1]]
    camera = Camera("odd", (9, 7), matrix, np.eye(3, 4))
    half = halved_camera(camera)
    assert half.size == (5, 4)
    point = np.array([0.5 / 50 - 4 / 50, 0.5 / 50 - 3 / 50, 1.0])  # px (0.5, 0.5)
    np.testing.assert_allclose(half.project(point), [0.0, 0.0], atol=1e-12)
