"""What OpenGL is given: tiles side by side, meshes without doubles."""

import numpy as np
import pytest
from silhouette_mocap.core.rendering.opengl.meshes import is_closed, segment_mesh, welded
from silhouette_mocap.core.rendering.opengl.tiles import clipped_windows, packed


@pytest.mark.parametrize("area", [1 << 24, 3000])
def test_tiles_hold_every_window_once_and_never_overlap(area):
    rng = np.random.default_rng(0)
    low = rng.integers(0, 50, (30, 2))
    windows = np.concatenate([low, low + rng.integers(1, 40, (30, 2))], axis=1)
    windows[[3, 7], 2] = low[[3, 7], 0]  # nothing is left of two of them
    blocks = packed(windows, 200, area)
    views = np.concatenate([block.views for block in blocks])
    shown = np.flatnonzero((windows[:, 2:] > windows[:, :2]).all(axis=1))
    assert sorted(views) == list(shown) and len(shown) == 28
    assert (len(blocks) > 1) == (area == 3000)
    for block in blocks:
        width, height = block.size
        assert max(width, height) <= 200 and width * height <= area
        used = np.zeros((height, width), int)
        for view, (x0, y0, x1, y1) in zip(block.views, block.areas, strict=True):
            x, y, right, bottom = windows[view]
            assert (x1 - x0, y1 - y0) == (right - x, bottom - y)
            used[y0:y1, x0:x1] += 1
            assert used[y0:y1, x0:x1].size == (x1 - x0) * (y1 - y0)
        assert used.max() == 1


def test_windows_are_clipped_to_the_pictures():
    sizes = np.array([[64, 48], [30, 20]])
    windows = clipped_windows(sizes, np.array([[-5, 40, 20, 90], [40, 5, 50, 9]]))
    np.testing.assert_array_equal(windows, [[0, 40, 20, 48], [30, 5, 30, 9]])
    np.testing.assert_array_equal(clipped_windows(sizes, None), [[0, 0, 64, 48], [0, 0, 30, 20]])


def test_welding_closes_seams_and_drops_what_covers_nothing(scenes):
    points, corners = scenes.sphere(4, 8, 1.0, np.random.default_rng(1))
    apart = points[corners].reshape(-1, 3)  # every triangle with corners of its own
    loose = np.arange(len(apart)).reshape(-1, 3)
    assert not is_closed(loose)
    spoiled = np.concatenate([loose, [[0, 0, 1], [2, 1, 2]]])
    joined, found = welded(apart, spoiled)
    assert len(joined) == len(points) and len(found) == len(corners)
    assert is_closed(found)
    np.testing.assert_array_equal(np.sort(joined[found], 0), np.sort(points[corners], 0))


def test_closed_segments_come_first_and_columns_follow_the_question(scenes):
    rng = np.random.default_rng(2)
    vertices, triangles = scenes.sphere(3, 6, 0.15, rng)
    body = scenes.body_of(
        [(vertices, triangles[:-1]), (vertices, triangles), (np.zeros((0, 3)), [])], rng
    )
    mesh = segment_mesh(body.surfaces[0], [2, 0, 1])
    assert mesh.order.tolist() == [1, 2, 0] or mesh.order.tolist() == [0, 2, 1]
    assert mesh.closed == len(triangles) and len(mesh.corners) == 2 * len(triangles) - 1
    for column, begin, end in zip(mesh.order, mesh.starts[:-1], mesh.starts[1:], strict=True):
        assert (mesh.columns[mesh.corners[begin:end]] == column).all()
