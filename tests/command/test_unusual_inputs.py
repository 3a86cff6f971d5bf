"""What is unusual, yet no fault: names in any script, ends of lines, masks of any kind."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest
from faults import fit_words, replace_text, told_by
from faults_of_footage import CAMERAS, mask, masks, painted, videos
from silhouette_mocap.core.motion.motion import read_motion


@pytest.fixture
def folder(small_take, tmp_path) -> Path:
    """A small take of one's own."""
    return shutil.copytree(small_take.parent, tmp_path / "session" / "small")


def fits(folder: Path, *more: str) -> Path:
    """Where the fit of a take that is no fault went."""
    told = told_by(fit_words(folder, *more))
    assert (told.code, told.error) == (0, "")
    return folder.parent / "out"


def test_names_in_any_script_and_with_spaces_work_for_pictures_and_videos(small_take, tmp_path):
    folder = tmp_path / "Ärger über 東京" / "Prüfung {1} [ä]"
    shutil.copytree(small_take.parent, folder)
    replace_text(folder / "calibration.toml", 'name = "cam_03"', 'name = "Kamera ö 3"')
    replace_text(folder / "take.toml", '"small"', '"пример 1"')
    (folder / "masks/cam_03").rename(folder / "masks/Kamera ö 3")
    out = fits(folder, "--frames", "0:0", "--export", "trc")
    assert "Kamera ö 3" in read_motion(out / "motion.npz").camera_names
    assert (out / "пример 1.trc").exists()
    assert cv2.VideoCapture(str(out / "overlay.mp4")).read()[0]
    (folder / "masks/Kamera ö 3").rename(folder / "masks/cam_03")
    videos(folder)
    (folder / "cam_03.mp4").rename(folder / "Kamera ö 3.mp4")
    assert told_by(("info", folder / "take.toml")).code == 0


@pytest.mark.parametrize("name", ["take.toml", "calibration.toml"])
def test_a_byte_order_mark_and_windows_line_ends_do_no_harm(folder, name):
    path = folder / name
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n"))
    assert told_by(("info", folder / "take.toml")).code == 0


def test_a_performer_who_leaves_one_view_and_then_all_is_no_fault(folder):
    painted(mask(folder, "cam_01", 2), np.zeros_like)
    for camera in CAMERAS:
        painted(mask(folder, camera, 3), np.zeros_like)
    told = told_by(fit_words(folder))
    assert (told.code, told.error) == (0, "silhouette-mocap: frames lost: 3\n")


def test_a_camera_that_the_performer_enters_later_is_told(folder):
    for frame in (0, 1):
        painted(mask(folder, "cam_04", frame), np.zeros_like)
    out = fits(folder)
    notes = json.loads((out / "report.json").read_text("utf-8"))["notes"]
    assert "camera cam_04 does not see the performer in the initial pose" in notes


def test_a_performer_who_fills_nearly_the_whole_picture_is_no_fault(folder):
    def filled(picture):
        picture[:] = 255
        picture[:, :9] = 0
        return picture

    for frame in range(4):
        painted(mask(folder, "cam_05", frame), filled)
    fits(folder, "--frames", "0:0")


def test_ones_for_white_and_soft_edges_are_masks_too(folder):
    for camera in CAMERAS:
        for frame, picture in enumerate(masks(folder, camera)):
            cv2.imwrite(str(mask(folder, camera, frame)), picture // 255)
    assert told_by(("info", folder / "take.toml")).code == 0
    for camera in CAMERAS:
        for frame, picture in enumerate(masks(folder, camera)):
            cv2.imwrite(str(mask(folder, camera, frame)), cv2.blur(picture * 255, (3, 3)))
    assert told_by(("info", folder / "take.toml")).code == 0


# as in programs that take up the user's locale: C then reads and writes decimal commas
IN_LOCALE = """
import locale, sys
locale.setlocale(locale.LC_ALL, "")
assert locale.localeconv()["decimal_point"] == sys.argv[1], locale.localeconv()
from unittest.mock import patch
from silhouette_mocap.core.cli import main
from small_take import known_start
with patch("silhouette_mocap.core.beginning.initialised", known_start):
    sys.exit(main(sys.argv[2:]))
"""


@pytest.mark.skipif(shutil.which("localedef") is None, reason="needs localedef")
def test_a_decimal_comma_of_the_system_changes_no_result(folder, tmp_path):
    made = subprocess.run(
        ["localedef", "-i", "de_DE", "-f", "UTF-8", str(tmp_path / "de_DE.UTF-8")],
        capture_output=True,
    )
    if made.returncode:
        pytest.skip("the system does not know German")
    tests = str(Path(__file__).resolve().parents[1])
    found = {}
    for point, language in ((".", "C.UTF-8"), (",", "de_DE.UTF-8")):
        out = tmp_path / language
        places = os.pathsep.join([tests, os.environ.get("PYTHONPATH", "")])
        environment = {**os.environ, "LC_ALL": language, "PYTHONPATH": places}
        if point == ",":
            environment["LOCPATH"] = str(tmp_path)
        words = ["fit", str(folder / "take.toml"), "--out", str(out), "--frames", "0:1"]
        words += ["--export", "trc"]
        subprocess.run(
            [sys.executable, "-c", IN_LOCALE, point, *words], env=environment, check=True,
            capture_output=True,
        )  # fmt: skip
        found[point] = [(out / name).read_bytes() for name in ("motion.npz", "small.trc")]
    assert found["."] == found[","]
