"""Pictures of distorting lenses, turned into those of a pinhole."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.cameras.undistortion import Undistortion, view_angles_deg
from silhouette_mocap.core.errors import MocapError

LENSES = {
    "barrel": (640.0, [-0.3, 0.1, 0.001, -0.002], False),
    "pincushion": (640.0, [0.2, 0.05, 0.0, 0.0], False),
    "rational": (640.0, [-0.2, 0.05, 0.0, 0.0, 0.01, 0.05, 0.01, 0.0], False),
    "fisheye": (700.0, [-0.02, 0.01, 0.0, 0.0], True),
}


def camera(focal_px: float, distortion, fisheye: bool = False, size=(1280, 720)) -> Camera:
    matrix = np.array([[focal_px, 0, 650.3], [0, focal_px * 1.01, 352.8], [0, 0, 1]])
    return Camera("cam_1", size, matrix, np.eye(3, 4), np.array(distortion), fisheye)


@pytest.fixture(params=LENSES.values(), ids=LENSES.keys())
def lens(request) -> Camera:
    return camera(*request.param)


def source_pixels(source: Camera) -> np.ndarray:
    """A grid over the whole area of the picture, up to the corners of its corner pixels."""
    width, height = source.size
    u, v = np.meshgrid(np.linspace(-0.5, width - 0.5, 33), np.linspace(-0.5, height - 0.5, 19))
    return np.column_stack([u.ravel(), v.ravel()])


def rays_by_opencv(source: Camera, pixels: np.ndarray) -> np.ndarray:
    points = pixels[:, None]
    if source.fisheye:
        criteria = (cv2.TERM_CRITERIA_COUNT, 100, 0)
        found = cv2.fisheye.undistortPoints(
            points, source.matrix, source.distortion, criteria=criteria
        )
    else:
        criteria = (cv2.TERM_CRITERIA_COUNT, 500, 0)
        found = cv2.undistortPointsIter(
            points, source.matrix, source.distortion, np.eye(3), np.eye(3), criteria
        )
    return np.column_stack([found[:, 0], np.ones(len(pixels))])


def test_every_source_pixel_has_a_place_in_the_undistorted_picture(lens):
    target = Undistortion(lens).camera
    places = target.project(rays_by_opencv(lens, source_pixels(lens)))
    width, height = target.size
    assert places.min() > -0.55
    assert places[:, 0].max() < width - 0.45
    assert places[:, 1].max() < height - 0.45


def test_the_undistorted_picture_holds_no_more_than_the_source_needs(lens):
    target = Undistortion(lens).camera
    places = target.project(rays_by_opencv(lens, source_pixels(lens)))
    slack = np.array(target.size) - (places.max(axis=0) - places.min(axis=0))
    assert slack.max() < 3.0


def test_the_centre_keeps_its_resolution_while_growth_is_moderate():
    source = camera(640.0, [-0.2, 0.05, 0.0, 0.0])
    target = Undistortion(source).camera
    np.testing.assert_allclose(np.diag(target.matrix), np.diag(source.matrix))
    assert (target.matrix[:2, 2] - source.matrix[:2, 2]) % 1 == pytest.approx([0, 0])


def test_growth_is_capped_by_a_smaller_focal_length():
    source = camera(700.0, [-0.02, 0.01, 0.0, 0.0], fisheye=True, size=(1300, 720))
    target = Undistortion(source).camera
    assert target.size[0] <= 1.5 * source.size[0] + 1
    assert 0.5 < target.matrix[0, 0] / source.matrix[0, 0] < 1.0
    assert target.matrix[1, 1] / target.matrix[0, 0] == pytest.approx(1.01)


def test_a_spot_lands_where_the_pinhole_projects_it(lens):
    # a Gaussian of 6 px stays symmetric enough for its centroid to be good to 0.05 px
    for pixel in np.array([[640.0, 360], [200, 150], [1150, 600]]):
        v, u = np.mgrid[: lens.size[1], : lens.size[0]]
        spot = np.exp(-((u - pixel[0]) ** 2 + (v - pixel[1]) ** 2) / (2 * 6.0**2))
        undistortion = Undistortion(lens)
        picture = undistortion.undistorted(spot.astype(np.float32)) ** 8  # its peak
        rows, columns = np.mgrid[: picture.shape[0], : picture.shape[1]]
        found = [(picture * columns).sum(), (picture * rows).sum()] / picture.sum()
        expected = undistortion.camera.project(rays_by_opencv(lens, pixel[None]))[0]
        np.testing.assert_allclose(found, expected, atol=0.05)


def test_undistorting_and_projecting_again_returns_to_the_pixel(lens):
    pixels = source_pixels(lens)
    target = Undistortion(lens).camera
    places = target.project(rays_by_opencv(lens, pixels))
    rays = np.column_stack([places, np.ones(len(places))]) @ np.linalg.inv(target.matrix).T
    assert np.abs(lens.project(rays) - pixels).max() < 0.05


def test_a_full_mask_becomes_exactly_the_observed_pixels(lens):
    undistortion = Undistortion(lens)
    full = np.ones(lens.size[::-1], bool)
    result = undistortion.undistorted(full)
    assert result.dtype == bool
    assert (result == undistortion.observed).all()
    assert result.shape == undistortion.camera.size[::-1]


def test_a_white_picture_stays_white_where_observed_and_is_black_elsewhere(lens):
    undistortion = Undistortion(lens)
    result = undistortion.undistorted(np.full((*lens.size[::-1], 3), 255, np.uint8))
    assert (result[undistortion.observed] == 255).all()
    assert not result[~undistortion.observed].any()


def test_observed_pixels_are_those_whose_ray_meets_the_source(lens):
    undistortion = Undistortion(lens)
    observed = undistortion.observed
    v, u = np.indices(observed.shape)
    pixels = np.stack([u, v, np.ones_like(u)], axis=-1)[::7, ::7].reshape(-1, 3)
    rays = pixels @ np.linalg.inv(undistortion.camera.matrix).T
    x, y = lens.project(rays).T
    inside = (x > -0.49) & (x < lens.size[0] - 0.51) & (y > -0.49) & (y < lens.size[1] - 0.51)
    outside = (x < -0.51) | (x > lens.size[0] - 0.49) | (y < -0.51) | (y > lens.size[1] - 0.49)
    sampled = observed[::7, ::7].ravel()
    assert sampled[inside].all()
    assert not sampled[outside].any()


def test_beyond_the_fold_of_the_lens_polynomial_nothing_is_observed():
    # r (1 - 0.45 r²) turns at r = 0.861 and comes back to the picture's middle at r = 1.49
    source = camera(1150.0, [-0.45, 0, 0, 0])
    undistortion = Undistortion(source)
    target = undistortion.camera
    v, u = np.indices(undistortion.observed.shape)
    radius = np.hypot(
        (u - target.matrix[0, 2]) / target.matrix[0, 0],
        (v - target.matrix[1, 2]) / target.matrix[1, 1],
    )
    assert (radius > 0.87).any()
    assert not undistortion.observed[radius > 0.87].any()
    assert undistortion.observed[radius < 0.3].all()


def test_the_outline_of_a_mask_keeps_its_place_to_a_fraction_of_a_pixel():
    source = camera(*LENSES["barrel"])
    undistortion = Undistortion(source)
    v, u = np.mgrid[:720, :1280]
    disc = np.hypot(u - 300.0, v - 200.0) < 80
    angles = np.linspace(0, 2 * np.pi, 721)[:-1]
    outline = np.column_stack([300 + 80 * np.cos(angles), 200 + 80 * np.sin(angles)])
    places = undistortion.camera.project(rays_by_opencv(source, outline))
    x, y = places.T
    area = 0.5 * abs((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
    result = undistortion.undistorted(disc)
    assert result.sum() == pytest.approx(area, rel=0.003)
    rows, columns = np.nonzero(result)
    expected = [(x + np.roll(x, -1)), (y + np.roll(y, -1))]
    cross = x * np.roll(y, -1) - y * np.roll(x, -1)
    expected = [(side * cross).sum() / (3 * cross.sum()) for side in expected]
    np.testing.assert_allclose([columns.mean(), rows.mean()], expected, atol=0.05)


def test_a_pinhole_passes_pictures_through_without_a_copy():
    source = camera(640.0, [])
    undistortion = Undistortion(source)
    picture = np.zeros((720, 1280, 3), np.uint8)
    assert undistortion.undistorted(picture) is picture
    assert undistortion.camera is source
    assert undistortion.observed.all()


def test_a_picture_of_another_size_is_refused():
    with pytest.raises(ValueError, match="1280 x 720"):
        Undistortion(camera(640.0, [0.1, 0, 0, 0])).undistorted(np.zeros((1280, 720), np.uint8))


def test_name_and_pose_are_kept():
    source = camera(640.0, [0.1, 0, 0, 0])
    target = Undistortion(source).camera
    assert target.name == source.name
    assert target.is_pinhole
    np.testing.assert_array_equal(target.camera_from_world, source.camera_from_world)


def test_the_angle_of_view_is_taken_along_the_middle_lines():
    matrix = np.array([[50.0, 0, 49.5], [0, 50, 24.5], [0, 0, 1]])
    source = Camera("cam", (100, 50), matrix, np.eye(3, 4))
    assert view_angles_deg(source) == pytest.approx((90.0, 2 * np.degrees(np.arctan(0.5))))


@pytest.mark.parametrize("fisheye", [False, True])
def test_above_110_degrees_the_camera_is_refused_with_what_to_do(fisheye):
    distortion = [0.0, 0.0, 0.0, 0.0] if fisheye else [0.001, 0.0, 0.0, 0.0]
    with pytest.raises(MocapError) as caught:
        Undistortion(camera(430.0, distortion, fisheye))
    for part in ("cam_1", "110°", "narrower"):
        assert part in str(caught.value)
    assert ("fisheye" in str(caught.value)) == fisheye


def test_a_lens_that_folds_inside_the_picture_is_refused():
    with pytest.raises(MocapError, match=r"cam_1: .*no viewing ray .* calibrate"):
        Undistortion(camera(700.0, [-0.6, 0, 0, 0]))
