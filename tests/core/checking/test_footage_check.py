"""Footage looked at before a fit."""

import math
import shutil

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.checking.footage_check import checked_footage, coarse_to_fine
from silhouette_mocap.core.footage.video_writing import write_video
from silhouette_mocap.core.take.reading import read_take
from silhouette_mocap.core.take.views import open_views


@pytest.fixture
def folder(small_take, tmp_path):
    return shutil.copytree(small_take.parent, tmp_path / "session" / "small")


def views_of(folder, old="", new=""):
    text = (folder / "take.toml").read_text("utf-8").replace(old, new)
    (folder / "take.toml").write_text(text, "utf-8")
    return open_views(read_take(folder / "take.toml"))


@pytest.mark.parametrize("count", [1, 2, 3, 8, 9, 1000])
def test_coarse_to_fine_visits_each_once_and_evenly(count):
    order = list(coarse_to_fine(count))
    assert sorted(order) == list(range(count)) and order[:2] == [0, count - 1][:count]
    for many in (8, 64, 300):
        gaps = np.diff(sorted(order[:many]))
        assert not len(gaps) or gaps.max() <= max(1, 4 * math.ceil(count / many))


def test_all_is_looked_at_where_there_is_time(folder):
    check = checked_footage(views_of(folder), 60.0)
    assert not check.faults and check.seconds > 0
    for facts in check.cameras:
        assert (facts.looked_at, facts.extracted, facts.wanted, facts.empty) == (4, 4, 4, 0)
        assert (facts.there, facts.count, facts.size) == ((0, 3), 4, (160, 120))
        assert facts.is_masks and not facts.is_video and not facts.lossy and facts.fps is None
    first = cv2.imread(str(folder / "masks" / "cam_02" / "000000.png"), cv2.IMREAD_GRAYSCALE)
    np.testing.assert_array_equal(check.cameras[1].silhouette.foreground, first > 0)


def test_without_time_each_camera_is_looked_at_nevertheless(folder):
    check = checked_footage(views_of(folder), 0.0)
    assert all(facts.extracted == 1 and facts.looked_at == 2 for facts in check.cameras)


def test_coverage_and_empty_silhouettes_are_counted(folder):
    paths = [folder / "masks" / "cam_03" / f"00000{k}.png" for k in range(4)]
    for path in paths[:3]:
        cv2.imwrite(str(path), np.zeros((120, 160), np.uint8))
    facts = checked_footage(views_of(folder), 60.0).cameras[2]
    share = (cv2.imread(str(paths[3]), cv2.IMREAD_GRAYSCALE) > 0).mean()
    assert facts.empty == 3 and facts.coverage == pytest.approx(share / 4)


def test_a_broken_picture_is_the_fault_of_its_camera_alone(folder):
    (folder / "masks" / "cam_03" / "000002.png").write_bytes(b"no picture")
    check = checked_footage(views_of(folder), 60.0)
    (fault,) = check.faults
    assert (fault.camera, fault.frame) == ("cam_03", 2)
    assert [facts.looked_at == 4 for facts in check.cameras] == [True, True, False, True, True]


def test_a_missing_frame_is_found_without_decoding(folder):
    (folder / "masks" / "cam_04" / "000002.png").unlink()
    check = checked_footage(views_of(folder, "frames = [0, 3]\n"), 0.0)
    (fault,) = check.faults
    assert (fault.camera, fault.frame) == ("cam_04", 2)
    assert check.cameras[3].count == 3


@pytest.fixture
def videos(folder):
    """The take with mask videos."""
    for number in range(1, 6):
        name = f"cam_{number:02d}"
        pictures = [cv2.imread(str(folder / "masks" / name / f"00000{k}.png")) for k in range(4)]
        write_video(folder / "masks" / f"{name}.mp4", pictures, 15.0)
    return views_of(folder, "masks/{camera}/{frame:06d}.png", "masks/{camera}.mp4")


def test_videos_tell_their_frame_rate_and_are_lossy(videos):
    facts = checked_footage(videos, 60.0).cameras[0]
    assert facts.is_video and facts.lossy and facts.fps == 15.0 and facts.there == (0, 3)
