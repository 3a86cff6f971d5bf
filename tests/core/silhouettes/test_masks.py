import cv2
import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.footage.footage import open_footage
from silhouette_mocap.core.footage.pictures import read_picture
from silhouette_mocap.core.silhouettes.masks import (
    ReadyMasks,
    mask_from_picture,
    write_mask_video,
    write_masks,
)


def _disc(radius=30, size=(120, 90), centre=(60, 45)) -> np.ndarray:
    y, x = np.mgrid[: size[1], : size[0]]
    return np.hypot(x - centre[0], y - centre[1]) < radius


def test_half_of_full_scale_is_the_performer():
    values = np.array([[0, 127, 128, 255]])
    expected = [[False, False, True, True]]
    assert mask_from_picture(values.astype(np.uint8)).tolist() == expected
    assert mask_from_picture((values * 257).astype(np.uint16)).tolist() == expected
    assert mask_from_picture(values.astype(np.uint16)).tolist() == expected
    assert mask_from_picture((values / 255).astype(np.float32)).tolist() == expected


def test_masks_of_zero_and_one_are_recognised_unless_compression_made_the_ones():
    ones = _disc().astype(np.uint8)
    assert np.array_equal(mask_from_picture(ones), _disc())
    assert not mask_from_picture(ones, lossy=True).any()


def test_all_black_and_all_white_masks_are_kept_as_they_are():
    assert not mask_from_picture(np.zeros((4, 5), np.uint8)).any()
    assert mask_from_picture(np.full((4, 5, 3), 255, np.uint8)).all()
    opaque_black = np.zeros((4, 5, 4), np.uint8)
    opaque_black[..., 3] = 255
    assert not mask_from_picture(opaque_black).any()


def test_a_colour_other_than_white_is_a_mask_too():
    picture = np.zeros((90, 120, 3), np.uint8)
    picture[_disc()] = (0, 0, 200)
    assert np.array_equal(mask_from_picture(picture), _disc())


def test_transparency_is_the_mask_of_a_cut_out():
    picture = np.full((90, 120, 4), 70, np.uint8)
    picture[..., 3] = np.where(_disc(), 255, 0)
    assert np.array_equal(mask_from_picture(picture), _disc())
    picture[..., 3] = 255
    picture[..., :3] = np.where(_disc(), 255, 0)[..., None]
    assert np.array_equal(mask_from_picture(picture), _disc())


def test_masks_come_back_from_pictures_unchanged_and_small(tmp_path):
    masks = [(4, _disc(20)), (5, _disc(30))]
    pattern = tmp_path / "{camera}" / "{frame:06d}.png"
    assert write_masks(pattern, "left", iter(masks)) == 2
    footage = open_footage(pattern, "left", (4, 5))
    for frame, mask in masks:
        assert np.array_equal(ReadyMasks().foreground(footage.picture(frame)), mask)
    bits_per_pixel = (tmp_path / "left" / "000004.png").read_bytes()[24]
    assert bits_per_pixel == 1
    assert read_picture(tmp_path / "left" / "000004.png").max() == 255


def test_masks_come_back_from_a_silhouette_video_nearly_unchanged(tmp_path):
    masks = [_disc(25, centre=(50 + frame, 45)) for frame in range(12)]
    assert write_mask_video(tmp_path / "left.mp4", iter(masks), 15.0) == 12
    footage = open_footage(tmp_path / "{camera}.mp4", "left")
    read = [ReadyMasks(footage.lossy).foreground(p) for _, p in footage.pictures(0, 11)]
    for got, mask in zip(read, masks, strict=True):
        assert (got & mask).sum() / (got | mask).sum() > 0.99


def test_a_mask_video_of_an_unwritable_kind_is_refused(tmp_path):
    with pytest.raises(MocapError, match=r"use \.mp4"):
        write_mask_video(tmp_path / "left.nothing", iter([_disc()]), 15.0)


def test_grey_video_codecs_keep_the_frame_order(tmp_path):
    masks = [_disc(10 + 2 * frame) for frame in range(8)]
    write_mask_video(tmp_path / "a.mp4", masks, 30.0)
    footage = open_footage(tmp_path / "a.mp4", "a")
    areas = [cv2.countNonZero(ReadyMasks(True).foreground(p).astype(np.uint8))
             for _, p in footage.pictures(0, 7)]  # fmt: skip
    assert areas == sorted(areas)
