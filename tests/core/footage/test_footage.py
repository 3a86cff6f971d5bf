import gc
import os
import tracemalloc
from pathlib import Path

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.footage.footage import open_footage
from silhouette_mocap.core.footage.pictures import colour_picture, read_picture, write_picture

VideoCapture = cv2.VideoCapture


def _picture(value: int, size=(24, 16)) -> np.ndarray:
    picture = np.zeros((size[1], size[0], 3), np.uint8)
    picture[:, : size[0] // 2] = value
    return picture


def _write_video(path: Path, values, size=(64, 48)) -> Path:
    video = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), 15.0, size)
    for value in values:
        video.write(_picture(value, size))
    video.release()
    return path


@pytest.mark.parametrize("suffix", [".png", ".tif", ".bmp"])
def test_a_numbered_sequence_gives_its_own_frame_numbers(tmp_path, suffix):
    for frame in (7, 8, 9):
        write_picture(tmp_path / "böse ordner" / f"a {frame:04d}{suffix}", _picture(frame * 10))
    pattern = tmp_path / "{camera} ordner" / ("a {frame:04d}" + suffix)
    footage = open_footage(pattern, "böse", (7, 9))
    assert footage.size == (24, 16)
    assert footage.fps is None
    assert list(footage.frames) == [7, 8, 9]
    assert [frame for frame, _ in footage.pictures(8, 9)] == [8, 9]
    assert np.array_equal(footage.picture(9), _picture(90))


def test_a_folder_without_numbering_is_sorted_naturally_and_counted_from_zero(tmp_path):
    for number in (10, 9, 100):
        write_picture(tmp_path / "cam" / f"shot{number}.png", _picture(number))
    (tmp_path / "cam" / "._shot9.png").write_bytes(b"left by a Mac")
    footage = open_footage(tmp_path / "{camera}", "cam")
    assert [int(footage.picture(frame)[0, 0, 0]) for frame in footage.frames] == [9, 10, 100]


def test_unpadded_numbers_and_folders_per_frame_are_found(tmp_path):
    for frame in (9, 10):
        write_picture(tmp_path / f"{frame}" / "cam.png", _picture(frame))
    footage = open_footage(tmp_path / "{frame}" / "{camera}.png", "cam")
    assert list(footage.frames) == [9, 10]


def test_a_missing_frame_is_named_with_camera_number_path_and_remedy(tmp_path):
    for frame in (0, 1, 3):
        write_picture(tmp_path / f"{frame:06d}.png", _picture(1))
    with pytest.raises(MocapError) as caught:
        open_footage(tmp_path / "{frame:06d}.png", "left", (0, 3))
    line = str(caught.value)
    assert "camera left, frame 2" in line
    assert str(tmp_path / "000002.png") in line
    assert "narrow the take's frames" in line


def test_a_missing_folder_is_named_as_expanded(tmp_path):
    with pytest.raises(MocapError, match=r"nowhere.*left.*no such footage"):
        open_footage(tmp_path / "nowhere" / "{camera}.mp4", "left")
    with pytest.raises(MocapError, match=r"left.*frame:06d.*how many digits"):
        open_footage(tmp_path / "{camera}" / "abc{frame:06d}.png", "left")


def test_a_misspelt_placeholder_is_pointed_out(tmp_path):
    with pytest.raises(MocapError, match=r"only \{camera\} and \{frame\}"):
        open_footage(tmp_path / "{cam}.mp4", "left")


def test_a_single_picture_is_no_footage(tmp_path):
    write_picture(tmp_path / "left.png", _picture(1))
    with pytest.raises(MocapError, match="frame:06d"):
        open_footage(tmp_path / "{camera}.png", "left")


def test_a_picture_of_another_size_is_refused_when_it_is_reached(tmp_path):
    write_picture(tmp_path / "0.png", _picture(1))
    write_picture(tmp_path / "1.png", _picture(1, (30, 16)))
    footage = open_footage(tmp_path / "{frame}.png", "left", (0, 1))
    footage.picture(0)
    with pytest.raises(MocapError, match=r"frame 1: is 30 x 16 px, .* 24 x 16 px"):
        footage.picture(1)


def test_a_cut_off_picture_is_refused_with_its_name(tmp_path):
    write_picture(tmp_path / "0.png", np.random.default_rng(0).integers(0, 255, (40, 40), np.uint8))
    whole = (tmp_path / "0.png").read_bytes()
    (tmp_path / "0.png").write_bytes(whole[:40])
    with pytest.raises(MocapError, match=r"0\.png, camera left, frame 0: .*cut short"):
        open_footage(tmp_path / "{frame}.png", "left")


@pytest.mark.parametrize("suffix", [".png", ".jpg", ".webp", ".tif"])
def test_a_damaged_picture_is_told_by_us_alone(tmp_path, suffix, capfd):
    path = tmp_path / f"0{suffix}"
    write_picture(path, np.random.default_rng(0).integers(0, 255, (40, 40, 3), np.uint8))
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    level = cv2.getLogLevel()
    with pytest.raises(MocapError, match="cut short"):
        read_picture(path)
    assert capfd.readouterr().err == ""
    assert cv2.getLogLevel() == level


def test_a_png_that_claims_more_bytes_than_there_are_is_not_decoded(tmp_path, monkeypatch):
    path = tmp_path / "0.png"
    write_picture(path, np.random.default_rng(0).integers(0, 255, (40, 40, 3), np.uint8))
    whole = bytearray(path.read_bytes())
    place = whole.index(b"IDAT") - 4
    path.write_bytes(whole[:place] + b"\x7f\xff\xff\x00" + whole[place + 4 :])
    # OpenCV 4.11 would take 2 GB
    monkeypatch.setattr("cv2.imdecode", None)
    with pytest.raises(MocapError, match="cut short"):
        read_picture(path)


def test_a_path_too_long_for_any_file_is_named(tmp_path):
    with pytest.raises(MocapError, match=r"camera left: cannot be opened \(File name too long\)"):
        open_footage(tmp_path / ("n" * 5000 + ".mp4"), "left")


def test_sixteen_bit_and_grey_pictures_become_eight_bit_colour(tmp_path):
    write_picture(tmp_path / "deep.png", np.full((4, 5), 257 * 200, np.uint16))
    picture = read_picture(tmp_path / "deep.png")
    assert picture.dtype == np.uint16
    assert np.array_equal(colour_picture(picture), np.full((4, 5, 3), 200, np.uint8))


def test_video_pictures_are_the_same_forwards_backwards_and_at_random(tmp_path):
    path = _write_video(tmp_path / "left.mp4", range(40, 240, 20))
    footage = open_footage(tmp_path / "{camera}.mp4", "left")
    assert footage.size == (64, 48)
    assert footage.fps == pytest.approx(15)
    in_order = [int(picture[20, 10, 0]) for _, picture in footage.pictures(0, 9)]
    assert np.abs(np.array(in_order) - np.arange(40, 240, 20)).max() <= 6
    jumps = [9, 0, 5, 5, 3, 8]
    assert [int(footage.picture(frame)[20, 10, 0]) for frame in jumps] == [
        in_order[frame] for frame in jumps
    ]
    assert list(open_footage(path, "left").frames) == list(range(10))


class Counting:
    """A decoder that counts the frames it goes over, and the files opened."""

    opened, frames = 0, 0

    def __init__(self, *source):
        self.capture = VideoCapture(*source)
        Counting.opened += 1

    def __getattr__(self, name):
        if name in ("grab", "read"):
            Counting.frames += 1
        return getattr(self.capture, name)


def test_going_backwards_through_a_video_decodes_it_once_per_block(tmp_path, monkeypatch):
    path = _write_video(tmp_path / "left.mp4", range(40, 240, 5))
    forwards = [picture for _, picture in open_footage(path, "left").pictures(0, 39)]
    monkeypatch.setattr("cv2.VideoCapture", Counting)
    monkeypatch.setattr("silhouette_mocap.core.footage.video.HELD_BYTES", 10 * 64 * 48 * 3)
    footage = open_footage(path, "left")
    footage.picture(39)
    Counting.opened = Counting.frames = 0
    for frame in range(38, -1, -1):
        assert np.array_equal(footage.picture(frame), forwards[frame])
        assert len(footage._held) <= 10
    assert Counting.opened == 4
    assert Counting.frames == 39 + 29 + 19 + 9


def test_a_video_of_pictures_larger_than_a_block_goes_backwards_too(tmp_path, monkeypatch):
    path = _write_video(tmp_path / "left.mp4", range(40, 60, 5))
    monkeypatch.setattr("silhouette_mocap.core.footage.video.HELD_BYTES", 1)
    footage = open_footage(path, "left")
    grey = [int(footage.picture(frame)[20, 10, 0]) for frame in (3, 2, 1, 0)]
    assert np.abs(np.array(grey) - [55, 50, 45, 40]).max() <= 6 and len(footage._held) == 1


@pytest.mark.parametrize(("pattern", "most"), [("cam/{frame:06d}.png", 1), ("cam", 150)])
def test_a_long_sequence_takes_a_few_bytes_per_frame(tmp_path, pattern, most):
    write_picture(tmp_path / "cam" / "000000.png", _picture(1))
    for frame in range(1, 2000):
        os.link(tmp_path / "cam" / "000000.png", tmp_path / "cam" / f"{frame:06d}.png")
    open_footage(tmp_path / pattern, "left")
    tracemalloc.start()
    footage = open_footage(tmp_path / pattern, "left")
    # what is held, not what waits to be collected
    gc.collect()
    taken = tracemalloc.get_traced_memory()[0]
    tracemalloc.stop()
    assert taken < 4000 + 2000 * most
    assert len(footage.frames) == 2000


def test_a_sequence_with_gaps_knows_which_frames_it_has(tmp_path):
    for frame in (3, 4, 9):
        write_picture(tmp_path / f"{frame:06d}.png", _picture(frame))
    footage = open_footage(tmp_path / "{frame:06d}.png", "left")
    assert list(footage.frames) == [3, 4, 9]
    assert footage.picture(9)[0, 0, 0] == 9
    for frame in (2, 5, 10):
        with pytest.raises(MocapError, match=f"frame {frame}: missing; .* frames 3 to 9"):
            footage.picture(frame)


def test_names_of_more_digits_than_any_count_has_are_no_frames(tmp_path):
    for name in ("7", "9" * 30):
        write_picture(tmp_path / f"{name}.png", _picture(1))
    assert list(open_footage(tmp_path / "{frame}.png", "left").frames) == [7]
    with pytest.raises(MocapError, match="only"):
        open_footage(tmp_path / "{frame:0999999999d}.png", "left")


def test_a_video_that_is_too_short_says_where_it_ends(tmp_path):
    footage = open_footage(_write_video(tmp_path / "a.mp4", range(50, 100, 10)), "left")
    with pytest.raises(MocapError, match=r"camera left, frame 5: ends after 5 frames"):
        list(footage.pictures(0, 7))


def test_a_damaged_video_is_counted_by_decoding(tmp_path):
    rng = np.random.default_rng(1)
    path = tmp_path / "a.avi"
    video = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 25.0, (64, 48))
    for _ in range(20):
        video.write(rng.integers(0, 255, (48, 64, 3), np.uint8))
    video.release()
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    footage = open_footage(path, "left")
    assert 5 <= len(footage.frames) < 15
    with pytest.raises(MocapError, match="left, frame 19: "):
        footage.picture(19)


def test_what_is_no_video_is_refused(tmp_path):
    (tmp_path / "a.mp4").write_bytes(b"not a video" * 50)
    with pytest.raises(MocapError, match=r"a\.mp4, camera left: is no video"):
        open_footage(tmp_path / "a.mp4", "left")


def test_pictures_are_read_only_when_they_are_asked_for(tmp_path):
    write_picture(tmp_path / "0.png", _picture(1))
    (tmp_path / "1.png").write_bytes(b"broken")
    stream = open_footage(tmp_path / "{frame}.png", "left", (0, 1)).pictures(0, 1)
    assert next(stream)[0] == 0
    with pytest.raises(MocapError, match="frame 1"):
        next(stream)
