"""Overlays show agreement and difference in the promised colours."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.overlay import Tile, coloured, overlay_picture, write_overlay
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


def test_a_video_holds_every_picture_and_appears_only_when_it_is_whole(tmp_path):
    path = tmp_path / "overlay.mp4"

    def pictures(count):
        for number in range(count):
            yield np.full((48, 64, 3), 40 * number, np.uint8)
            assert not path.exists()

    write_overlay(path, 25.0, pictures(5))
    video = cv2.VideoCapture(str(path))
    levels = [video.read()[1].mean() for _ in range(5)]
    np.testing.assert_allclose(levels, [0, 40, 80, 120, 160], atol=6)
    assert not video.read()[0] and [p.name for p in tmp_path.iterdir()] == ["overlay.mp4"]


def test_a_folder_that_is_missing_is_one_line(tmp_path):
    with pytest.raises(MocapError, match="cannot be written"):
        write_overlay(tmp_path / "no" / "o.mp4", 25.0, iter([np.zeros((48, 64, 3), np.uint8)]))
