"""How cameras stand, and the studios of the seed papers."""

import numpy as np
import pytest
from silhouette_mocap.core.cameras.arrangement import millimetres_per_pixel, opposite_pairs
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.cameras.presets import Ring, look_at, ring, studio_m, studio_t


def test_looking_along_y_from_the_front_gives_the_hand_written_axes():
    # right +X, down -Z, forward +Y
    expected = [[1, 0, 0, 0], [0, 0, -1, 1], [0, 1, 0, 4]]
    np.testing.assert_allclose(look_at([0, -4, 1], [0, 0, 1]), expected, atol=1e-12)


def test_a_camera_that_looks_straight_down_has_no_upright():
    with pytest.raises(ValueError, match="straight up or down"):
        look_at([0, 0, 4], [0, 0, 0])


def test_level_cameras_face_to_face_are_opposite():
    cameras = ring(Ring(4))
    assert opposite_pairs(cameras) == [("cam_01", "cam_03"), ("cam_02", "cam_04")]


@pytest.mark.parametrize(("angle_deg", "found"), [(169.0, False), (171.0, True)])
def test_opposite_means_more_than_170_degrees(angle_deg, found):
    first = ring(Ring(1))[0]
    second = ring(Ring(1, first_angle_deg=angle_deg), first_number=2)[0]
    assert bool(opposite_pairs([first, second])) == found


def test_a_pixel_spans_depth_over_focal_length():
    camera = ring(Ring(1, radius=4.0, focal_px=500.0))[0]
    assert millimetres_per_pixel(camera, np.array([0.0, 0, 1])) == pytest.approx(8.0)
    step = camera.project(np.array([[0.0, 0, 1], [0.008, 0, 1]]))
    assert np.linalg.norm(step[1] - step[0]) == pytest.approx(1.0)


def test_a_point_behind_the_camera_has_no_scale():
    with pytest.raises(ValueError, match="in front of camera cam_01"):
        millimetres_per_pixel(ring(Ring(1))[0], np.array([0.0, -8, 1]))


@pytest.mark.parametrize(
    ("studio", "count", "size", "fps"),
    [(studio_t(), 8, (320, 240), 15.0), (studio_m(), 6, (640, 480), 60.0)],
)
def test_studios_are_as_in_print_and_hold_a_whole_performer(studio, count, size, fps):
    assert (len(studio.cameras), studio.fps) == (count, fps)
    box = np.array([[x, y, z] for x in (-0.7, 0.7) for y in (-0.7, 0.7) for z in (0, 2.0)])
    for camera in studio.cameras:
        assert camera.size == size
        pixels = camera.project(box)
        assert (pixels > 0).all()
        assert (pixels < np.array(size) - 1).all()
    assert opposite_pairs(studio.cameras) == []


def _azimuths_deg(cameras: tuple[Camera, ...]) -> np.ndarray:
    centres = np.array([camera.centre for camera in cameras])
    return np.degrees(np.arctan2(centres[:, 1], centres[:, 0])) % 360


def test_the_ring_of_studio_t_has_equal_angles():
    np.testing.assert_allclose(np.diff(np.sort(_azimuths_deg(studio_t().cameras))), 45.0)


def test_studio_m_turns_its_elevated_cameras_by_60_degrees():
    cameras = studio_m().cameras
    angles = _azimuths_deg(cameras)
    np.testing.assert_allclose(np.diff(np.sort(angles)), 60.0)
    elevations = [np.degrees(np.arcsin(-camera.rotation[2, 2])) for camera in cameras]
    np.testing.assert_allclose(elevations, [0, 0, 0, 45, 45, 45], atol=1e-9)
