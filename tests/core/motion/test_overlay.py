"""Overlays show agreement and difference in the promised colours."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.motion.overlay import OverlayVideo, Tile, coloured, overlay_picture
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


def test_a_video_holds_every_picture_in_the_order_of_frames(tmp_path):
    path = tmp_path / "overlay.mp4"
    with OverlayVideo(path, 25.0) as video:
        for frame in (12, 13, 14, 11, 9):
            video.add(frame, np.full((48, 64, 3), 15 * frame, np.uint8))
        assert not path.exists()
        video.write()
    stored = cv2.VideoCapture(str(path))
    levels = [stored.read()[1].mean() for _ in range(5)]
    np.testing.assert_allclose(levels, [135, 165, 180, 195, 210], atol=6)
    assert not stored.read()[0] and [p.name for p in tmp_path.iterdir()] == ["overlay.mp4"]


def test_a_video_that_is_given_up_leaves_nothing_behind(tmp_path):
    with pytest.raises(KeyboardInterrupt), OverlayVideo(tmp_path / "o.mp4", 25.0) as video:
        video.add(0, np.zeros((48, 64, 3), np.uint8))
        raise KeyboardInterrupt
    assert not list(tmp_path.iterdir())
