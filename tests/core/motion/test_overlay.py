"""Overlays show agreement and difference in the promised colours."""

import numpy as np
from silhouette_mocap.core.motion.overlay import Tile, coloured, overlay_picture
from silhouette_mocap.core.silhouettes.silhouette import Silhouette


def tile(size=(40, 30)) -> Tile:
    width, height = size
    seen, drawn = np.zeros((height, width), bool), np.zeros((height, width), bool)
    seen[:, : width // 2] = True
    drawn[: height // 2] = True
    footage = np.full((height, width, 3), 100, np.uint8)
    return Tile("cam", footage, Silhouette(seen, np.ones_like(seen)), drawn)


def test_green_is_both_red_the_model_and_blue_the_performer_alone():
    picture = coloured(tile())
    corners = picture[[0, 0, -1, -1], [0, -1, 0, -1]]
    # BGR: both, model only, performer only, nothing
    np.testing.assert_array_equal(corners.argmax(axis=1)[:3], [1, 2, 0])
    assert len(set(corners[3].tolist())) == 1


def test_views_of_all_sizes_are_put_side_by_side():
    picture = overlay_picture([tile(), tile((30, 41)), tile((700, 333))], "frame 7")
    assert picture.dtype == np.uint8 and picture.shape[0] % 2 == picture.shape[1] % 2 == 0
    assert picture.shape[1] == 2 * 480


def test_small_pictures_are_not_blown_up():
    assert overlay_picture([tile((320, 240))] * 4, "frame 7").shape[1] == 2 * 320
    assert overlay_picture([tile((40, 30))] * 4, "frame 7").shape[1] == 2 * 240
