"""OpenCV's FileStorage in EasyMocap's pair of files."""

from pathlib import Path

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.cameras.calibration import (
    CalibrationSettings,
    read_calibration,
    read_camera_names,
)

POINTS = np.array([[0.2, 0.3, 1.0], [-0.4, 0.1, 1.6]])


def write_pair(folder: Path, names=("none", "cam_10", "none", "cam_2"), lens="dist", rot="Rot"):
    """The camera of the fixture twins, once at x = 0 and once at x = 2 m, as OpenCV writes it."""
    rotation = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    intri = cv2.FileStorage(str(folder / "intri.yml"), cv2.FileStorage_WRITE)
    extri = cv2.FileStorage(str(folder / "extri.yml"), cv2.FileStorage_WRITE)
    for storage in (intri, extri):
        storage.startWriteStruct("names", cv2.FileNode_SEQ)
        for name in names:
            storage.write("", name)
        storage.endWriteStruct()
    for name, x in [("cam_10", 0.0), ("cam_2", 2.0)]:
        matrix = np.array([[800, 0, 319.5], [0, 810, 239.5], [0, 0, 1]])
        intri.write(f"K_{name}", matrix)
        intri.write(f"{lens}_{name}", np.array([[-0.1, 0.02, 0.001, -0.002, 0.0]]))
        turn = rotation if rot == "Rot" else cv2.Rodrigues(rotation)[0]
        extri.write(f"{rot}_{name}", turn)
        extri.write(f"T_{name}", np.array([[-x], [1.0], [4.0]]))
    intri.release()
    extri.release()


SIZES = CalibrationSettings(sizes={"cam_2": (640, 480), "cam_10": (480, 640)})


@pytest.mark.parametrize("given", ["intri.yml", "extri.yml", "."])
@pytest.mark.parametrize(("lens", "rot"), [("dist", "Rot"), ("D", "R")])
def test_a_pair_is_read_from_either_file_or_the_folder(tmp_path, twins, given, lens, rot):
    write_pair(tmp_path, lens=lens, rot=rot)
    calibration = read_calibration(tmp_path / given, SIZES)
    assert [camera.name for camera in calibration.cameras] == ["cam_2", "cam_10"]
    assert [camera.size for camera in calibration.cameras] == [(640, 480), (480, 640)]
    np.testing.assert_allclose(calibration.cameras[0].centre, [2, -4, 1], atol=1e-9)
    np.testing.assert_allclose(
        calibration.cameras[0].project(POINTS), twins[1].project(POINTS), atol=1e-6
    )


def test_names_are_known_before_sizes(tmp_path):
    write_pair(tmp_path, names=())
    assert read_camera_names(tmp_path) == ("cam_2", "cam_10")


def test_an_unknown_size_names_the_camera_and_the_remedy(tmp_path, fault):
    write_pair(tmp_path)
    line = fault(tmp_path / "intri.yml")
    assert "cam_2" in line
    assert "give the footage's size" in line


def test_cameras_that_are_left_out_need_no_size(tmp_path):
    write_pair(tmp_path)
    settings = CalibrationSettings(sizes={"cam_10": (480, 640)}, only=["cam_10"])
    assert [camera.name for camera in read_calibration(tmp_path, settings).cameras] == ["cam_10"]


def test_sizes_in_the_pair_itself_are_taken(tmp_path):
    write_pair(tmp_path)
    with (tmp_path / "intri.yml").open("a") as file:
        file.write("W_cam_2: 640\nH_cam_2: 480\nW_cam_10: 640\nH_cam_10: 480\n")
    assert read_calibration(tmp_path).cameras[0].size == (640, 480)


def test_a_pair_without_its_other_half_says_so(tmp_path, fault):
    write_pair(tmp_path)
    (tmp_path / "extri.yml").unlink()
    assert "extri.yml is not beside it" in fault(tmp_path / "intri.yml", SIZES)


def test_a_folder_without_a_pair_says_so(tmp_path, fault):
    assert "no intri.yml" in fault(tmp_path)


@pytest.mark.parametrize(
    ("file", "old", "new", "parts"),
    [
        ("intri.yml", "dist_cam_2", "other_cam_2", ["cam_2", "dist_cam_2 or D_cam_2 is missing"]),
        ("extri.yml", "T_cam_2", "other_cam_2", ["extri.yml", "cam_2", "T_cam_2 is missing"]),
        ("intri.yml", "K_cam_2", "L_cam_2", ["cam_2", "K_cam_2 is missing"]),
        ("extri.yml", "-2.", "-.Nan", ["extri.yml", "cam_2", "T_cam_2", "not finite"]),
    ],
)
def test_bad_values_of_a_pair_are_named(tmp_path, fault, file, old, new, parts):
    write_pair(tmp_path)
    path = tmp_path / file
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    line = fault(tmp_path / "intri.yml", SIZES)
    for part in parts:
        assert part in line


def test_a_truncated_pair_says_so(tmp_path, fault):
    write_pair(tmp_path)
    path = tmp_path / "extri.yml"
    path.write_text(path.read_text()[:-150])
    assert "extri.yml" in fault(tmp_path / "intri.yml", SIZES)
