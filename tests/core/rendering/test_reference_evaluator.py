"""The reference against cases counted by hand."""

import numpy as np
import pytest
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.reference import (
    ReferenceEvaluator,
    clipped_polygon,
    covered_pixels,
)


def picture_of(corners, shape=(6, 6)):
    picture = np.zeros(shape, int)
    rows, columns, covered = covered_pixels(np.array(corners) * 256, shape)
    picture[rows, columns] = covered
    return picture


def test_left_and_top_edges_belong_to_a_triangle_and_right_and_bottom_edges_do_not():
    upper = picture_of([[1, 1], [4, 1], [1, 4]])
    expected = np.zeros((6, 6), int)
    expected[1, 1:4] = expected[2, 1:3] = expected[3, 1] = 1
    np.testing.assert_array_equal(upper, expected)


def test_two_triangles_that_share_an_edge_cover_every_pixel_of_the_square_once():
    both = picture_of([[1, 1], [4, 1], [1, 4]]) + picture_of([[4, 1], [4, 4], [1, 4]])
    expected = np.zeros((6, 6), int)
    expected[1:4, 1:4] = 1
    np.testing.assert_array_equal(both, expected)


def test_orientation_does_not_matter_and_zero_area_covers_nothing():
    corners = [[0, 0], [5, 2], [1, 5]]
    np.testing.assert_array_equal(picture_of(corners), picture_of(corners[::-1]))
    assert picture_of([[0, 0], [2, 2], [4, 4]]).sum() == 0


def test_a_triangle_through_the_near_plane_is_cut_at_one_centimetre():
    corners = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0]])
    polygon = clipped_polygon(corners)
    np.testing.assert_allclose(polygon[:, 2].min(), 0.01)
    np.testing.assert_allclose(polygon[1], [0.495, 0, 0.01])  # where z = 1 - 2 t is 0.01


@pytest.mark.parametrize("backend", [ReferenceEvaluator, NativeEvaluator])
def test_corners_on_pixel_centres_cover_the_left_and_top_but_not_right_and_bottom(scenes, backend):
    rng = np.random.default_rng(0)
    square = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    body = scenes.body_of([(square, [[0, 1, 2], [0, 2, 3]])], rng)
    matrix = [[4, 0, 10], [0, 4, 10], [0, 0, 1]]
    translation = -body.offsets[0] + [0, 0, 1]
    camera = Camera("front", (20, 20), matrix, np.column_stack([np.eye(3), translation]))
    evaluator = backend(body, [camera])
    maps = scenes.maps_for([camera], 1, rng)
    picture = evaluator.silhouettes(body.rest_pose)[0]
    np.testing.assert_array_equal(np.argwhere(picture)[[0, -1]], [[6, 6], [13, 13]])
    energies = evaluator.energies(evaluator.prepared(maps), body.rest_pose[None])
    assert energies[0, 0] == maps.constants[0] + maps.maps[0][6:14, 6:14].sum()
