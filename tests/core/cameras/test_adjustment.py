"""Footage that is not as it was when calibrated."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.cameras.adjustment import (
    adjusted,
    matched_to_footage,
    observed_pixels,
)
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.errors import MocapError

PORTRAIT = (1088, 1920)
POSE = np.array([[1.0, 0, 0, 0], [0, 0, -1, 1], [0, 1, 0, 4]])
POINTS = np.array([[0.3, 0.2, 1.5], [-0.6, 0.5, 0.1], [0.0, -0.5, 2.2]])


def camera(size=PORTRAIT, distortion=(-0.05, 0.14, 0.001, -0.002)) -> Camera:
    matrix = [[1681.2, 0, 533.0], [0, 1681.1, 948.1], [0, 0, 1]]
    return Camera("cam01", size, np.array(matrix), POSE, np.array(distortion))


def test_footage_pixels_are_scaled_and_shifted_calibrated_pixels_through_a_distorting_lens():
    footage = adjusted(camera(), 0.99265, (0.0, 7.06), (1080, 1920))
    u, v = camera().project(POINTS).T
    expected = np.column_stack([0.99265 * u, 0.99265 * v + 7.06])
    np.testing.assert_allclose(footage.project(POINTS), expected, atol=1e-9)
    assert footage.size == (1080, 1920)


def test_rows_that_the_adjustment_filled_are_unobserved():
    observed = observed_pixels(PORTRAIT, 0.99265, (0.0, 7.06), (1080, 1920))
    # the first source row's upper edge -0.5 lands at 6.56, the last one's lower edge 1919.5 at
    # 1912.45: rows 7 … 1912 have a source; of the columns all have
    assert observed.shape == (1920, 1080)
    assert np.flatnonzero(observed.all(axis=1)).tolist() == list(range(7, 1913))
    assert np.flatnonzero(observed.any(axis=1)).tolist() == list(range(7, 1913))


def test_columns_beyond_the_calibrated_picture_are_unobserved():
    observed = observed_pixels((4, 2), 1.0, (-1.0, 0.0), (4, 2))
    assert observed.tolist() == [[True, True, True, False]] * 2


def test_a_scale_must_be_positive():
    with pytest.raises(ValueError, match="positive scale"):
        adjusted(camera(), 0.0, (0, 0), PORTRAIT)


def test_footage_of_the_calibrated_size_keeps_the_camera():
    source = camera()
    assert matched_to_footage(source, PORTRAIT, "cam01.mp4") is source


def test_resized_footage_shows_a_spot_where_the_scaled_camera_projects_it():
    source = camera(size=(1280, 960), distortion=())
    pixel = source.project(POINTS[0])
    v, u = np.mgrid[:960, :1280]
    spot = np.exp(-((u - pixel[0]) ** 2 + (v - pixel[1]) ** 2) / (2 * 8.0**2))
    small = cv2.resize(spot, (320, 240), interpolation=cv2.INTER_AREA)
    rows, columns = np.mgrid[:240, :320]
    centre = [(small * columns).sum() / small.sum(), (small * rows).sum() / small.sum()]
    found = matched_to_footage(source, (320, 240), "cam01.mp4").project(POINTS[0])
    np.testing.assert_allclose(found, centre, atol=0.01)


def test_sizes_rounded_to_whole_pixels_still_agree_in_aspect():
    assert matched_to_footage(camera(size=(1920, 1080)), (853, 480), "cam01.mp4").size == (853, 480)


def test_another_aspect_names_both_sizes_and_the_remedy():
    with pytest.raises(MocapError) as caught:
        matched_to_footage(camera(), (1080, 1920), "cam01.mp4")
    for part in ("cam01", "1080 x 1920", "1088 x 1920", "another aspect", "adjust ="):
        assert part in str(caught.value)


def test_portrait_footage_of_a_landscape_calibration_is_named_as_such():
    with pytest.raises(MocapError, match="portrait and landscape are swapped"):
        matched_to_footage(camera(size=(1920, 1080)), (540, 960), "cam01.mp4")
