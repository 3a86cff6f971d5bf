"""Footage as Blender can show it: numbered pictures as they are, anything else as a video."""

import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.footage.patterns import ends_in_frame
from silhouette_mocap.core.results.shown_footage import shown_footage
from silhouette_mocap.core.take import read_take
from silhouette_mocap.core.take.views import open_views

NUMBERED = "masks/{camera}/{frame:06d}.png"


@pytest.fixture
def folder(small_take, tmp_path) -> Path:
    return shutil.copytree(small_take.parent, tmp_path / "session" / "small")


def shown(folder: Path, pattern: str) -> dict[str, str]:
    path = folder / "take.toml"
    path.write_text(path.read_text("utf-8").replace(NUMBERED, pattern), "utf-8")
    return shown_footage(open_views(read_take(path)).views, 3, 15.0, folder / "out")


def test_numbered_pictures_are_shown_as_they_are(folder):
    assert shown(folder, NUMBERED)["cam_03"] == str(folder / "masks/cam_03/{frame:06d}.png")
    assert not (folder / "out").exists()


@pytest.mark.parametrize("place", ["folder", "numbered folders"])
def test_other_pictures_are_shown_as_a_video(folder, place):
    pattern = "masks/{camera}"
    if place == "numbered folders":
        pattern = "masks/{camera}/{frame}/mask.png"
        for path in list(folder.glob("masks/*/*.png")):
            target = path.with_name(str(int(path.stem)))
            target.mkdir()
            path.rename(target / "mask.png")
    video = cv2.VideoCapture(shown(folder, pattern)["cam_03"])
    footage = open_views(read_take(folder / "take.toml")).views[2].source.footage
    for frame in range(4):
        good, picture = video.read()
        assert good
        wanted = footage.picture(frame) > 0
        assert np.mean((picture[..., 0] > 127) != wanted) < 0.01


@pytest.mark.parametrize(
    ("pattern", "ends"),
    [
        ("a/{frame:06d}.png", True),
        ("a1/shot{frame}_raw.png", True),
        ("a/{frame}_cam2.png", False),
        ("a/{frame}/mask.png", False),
        ("a/{frame}/{frame}.png", False),
        ("a/cam.png", False),
    ],
)
def test_players_count_the_last_number_of_a_file_name(pattern, ends):
    assert ends_in_frame(pattern) is ends
