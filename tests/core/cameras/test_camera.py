"""Signs and directions of a camera, by hand."""

from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.cameras.camera import Camera

MATRIX = np.array([[100.0, 0, 50], [0, 200, 40], [0, 0, 1]])
# stands at (0, -4, 1), looks along world +Y: right is +X, down is -Z, forward is +Y
LOOKING_ALONG_Y = np.array([[1.0, 0, 0, 0], [0, 0, -1, 1], [0, 1, 0, 4]])


def camera(**changes) -> Camera:
    return replace(Camera("front", (101, 81), MATRIX, LOOKING_ALONG_Y), **changes)


def test_a_point_on_the_axis_lands_on_the_principal_point():
    np.testing.assert_allclose(camera().project(np.array([0.0, 0, 1])), [50, 40])


@pytest.mark.parametrize(
    ("point", "pixel"),
    [
        ([1.0, 0, 1], [75, 40]),  # a metre to the right, 4 m away: 100 / 4 px to the right
        ([0.0, 0, 2], [50, -10]),  # a metre up: 200 / 4 px up, where v falls
        ([1.0, 4, 1], [62.5, 40]),  # twice as far: half the shift
    ],
)
def test_right_is_greater_u_and_up_is_smaller_v(point, pixel):
    np.testing.assert_allclose(camera().project(np.array(point)), pixel)


def test_the_centre_is_where_the_camera_stands():
    np.testing.assert_allclose(camera().centre, [0, -4, 1])


def test_depth_is_measured_along_the_optical_axis():
    np.testing.assert_allclose(camera().depths(np.array([[5.0, 0, 3], [0, -6, 1]])), [4, -2])


def test_points_behind_the_camera_have_no_pixel():
    pixels = camera().project(np.array([[0.0, -6, 1], [0.0, 0, 1]]))
    assert np.isnan(pixels[0]).all()
    np.testing.assert_allclose(pixels[1], [50, 40])


def test_any_leading_shape_is_kept():
    assert camera().project(np.zeros((2, 3, 4, 3))).shape == (2, 3, 4, 2)


def test_radial_distortion_follows_the_polynomial():
    # x = 0.25 at depth 1, so r² = 1/16 and x_distorted = 0.25 (1 + 0.4 / 16)
    pixel = camera(distortion=[0.4, 0, 0, 0]).project(np.array([1.0, 0, 1]))
    np.testing.assert_allclose(pixel, [50 + 100 * 0.25 * 1.025, 40])


def test_a_fisheye_without_coefficients_maps_angles_to_pixels():
    pixel = camera(distortion=np.zeros(4), fisheye=True).project(np.array([4.0, 0, 1]))
    np.testing.assert_allclose(pixel, [50 + 100 * np.pi / 4, 40])


def test_projection_is_the_matrix_of_the_pinhole():
    homogeneous = camera().projection @ [1.0, 0, 1, 1]
    np.testing.assert_allclose(homogeneous[:2] / homogeneous[2], [75, 40])


def test_halving_a_picture_keeps_its_corners_in_place():
    half = camera(size=(100, 80)).scaled(0.5, (50, 40))
    # the picture's upper left corner (-0.5, -0.5) stays there, the lower right is halved
    ray = np.linalg.inv(MATRIX) @ [-0.5, -0.5, 1]
    np.testing.assert_allclose((half.matrix @ ray)[:2], [-0.5, -0.5])
    ray = np.linalg.inv(MATRIX) @ [99.5, 79.5, 1]
    np.testing.assert_allclose((half.matrix @ ray)[:2], [49.5, 39.5])


@pytest.mark.parametrize(
    "changes",
    [
        {"camera_from_world": LOOKING_ALONG_Y * [[1], [1], [-1]]},
        {"camera_from_world": LOOKING_ALONG_Y * 1.1},
        {"matrix": MATRIX + np.diag([3.0, 0.0], k=1)},
        {"matrix": np.diag([-100.0, 100, 1])},
        {"matrix": MATRIX * np.nan},
        {"distortion": [0.1, 0.2, 0.3]},
        {"distortion": np.zeros(5), "fisheye": True},
        {"size": (0, 81)},
    ],
)
def test_impossible_cameras_are_refused(changes):
    with pytest.raises(ValueError, match="expected"):
        camera(**changes)
