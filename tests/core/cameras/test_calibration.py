"""Calibration files in TOML, units, up axes, and what is said about bad files."""

from pathlib import Path

import numpy as np
import pytest
from silhouette_mocap.core.cameras.calibration import (
    CalibrationSettings,
    natural_key,
    read_calibration,
    read_camera_names,
)
from silhouette_mocap.core.errors import MocapError

MATRIX = "[[800.0, 0.0, 319.5], [0.0, 810.0, 239.5], [0.0, 0.0, 1.0]]"


def table(header: str, **changes) -> str:
    """A TOML table of a camera that looks along +Y from (0, -4, 1) m."""
    values = {
        "name": f'"{header}"',
        "size": "[640.0, 480.0]",
        "matrix": MATRIX,
        "distortions": "[-0.1, 0.02, 0.001, -0.002]",
        "rotation": "[1.5707963267948966, 0.0, 0.0]",
        "translation": "[0.0, 1.0, 4.0]",
        "fisheye": "false",
    } | changes
    lines = [f"{key} = {value}" for key, value in values.items() if value is not None]
    return "\n".join([f"[{header}]", *lines, ""])


def written(folder: Path, text: str, name: str = "calibration.toml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def two_tables(**changes) -> str:
    """Two cameras, 2 m apart; the second one as changed."""
    return table("cam_1") + table("cam_2", **({"translation": "[-2.0, 1.0, 4.0]"} | changes))


def test_toml_is_read_with_its_lens(tmp_path):
    camera = read_calibration(written(tmp_path, two_tables())).cameras[0]
    np.testing.assert_allclose(camera.centre, [0, -4, 1], atol=1e-12)
    np.testing.assert_allclose(camera.rotation, [[1, 0, 0], [0, 0, -1], [0, 1, 0]], atol=1e-12)
    np.testing.assert_allclose(camera.distortion, [-0.1, 0.02, 0.001, -0.002])
    np.testing.assert_allclose(camera.matrix, [[800, 0, 319.5], [0, 810, 239.5], [0, 0, 1]])
    assert (camera.name, camera.size, camera.fisheye) == ("cam_1", (640, 480), False)


def test_formats_are_found_by_content_whatever_the_suffix(tmp_path):
    assert "Pose2Sim" in read_calibration(written(tmp_path, two_tables(), "cams.txt")).format


def test_a_rotation_may_be_a_matrix(tmp_path):
    text = two_tables(rotation="[[1, 0, 0], [0, 0, -1], [0, 1, 0]]")
    first, second = read_calibration(written(tmp_path, text)).cameras
    np.testing.assert_allclose(first.rotation, second.rotation, atol=1e-12)


def test_cameras_without_a_name_are_called_by_their_table(tmp_path):
    text = table("front", name=None) + table("side", name='"left side"')
    assert read_camera_names(written(tmp_path, text)) == ("front", "left side")


def test_caliscope_tables_are_nested_and_may_be_ignored(tmp_path):
    text = "".join(
        table(f"cameras.{n}", name=None, fisheye=None, translation=f"[{n}, 1, 4]", **extra)
        for n, extra in [(10, {}), (2, {"rotation_count": "1"}), (3, {"ignore": "true"})]
    )
    calibration = read_calibration(written(tmp_path, text))
    assert [camera.name for camera in calibration.cameras] == ["2", "10"]
    assert any("camera 3 is left out" in note for note in calibration.notes)
    assert any("camera 2 has rotation_count 1" in note for note in calibration.notes)


def test_cameras_stand_in_natural_order(tmp_path):
    text = "".join(table(f"cam_{n}", translation=f"[{n}, 1, 4]") for n in (10, 2, 1))
    names = [camera.name for camera in read_calibration(written(tmp_path, text)).cameras]
    assert names == ["cam_1", "cam_2", "cam_10"]


def test_natural_order_mixes_digits_and_letters():
    names = ["b1", "a10", "2", "a2", "10", "a2b"]
    assert sorted(names, key=natural_key) == ["2", "10", "a2", "a2b", "a10", "b1"]


def test_mixed_and_portrait_sizes_are_kept(tmp_path):
    text = two_tables(size="[1080, 1920]")
    sizes = [camera.size for camera in read_calibration(written(tmp_path, text)).cameras]
    assert sizes == [(640, 480), (1080, 1920)]


def test_a_fisheye_keeps_four_coefficients(tmp_path):
    text = two_tables(fisheye="true", distortions="[0.1, 0.02, 0.003, 0.004, 0.0]")
    camera = read_calibration(written(tmp_path, text)).cameras[1]
    assert camera.fisheye
    np.testing.assert_allclose(camera.distortion, [0.1, 0.02, 0.003, 0.004])


def test_metres_are_guessed_for_cameras_that_stand_metres_apart(tmp_path):
    calibration = read_calibration(written(tmp_path, two_tables()))
    assert (calibration.units, calibration.units_guessed) == ("m", True)
    assert "2.00 m apart" in calibration.notes[0]


def test_millimetres_are_guessed_for_cameras_that_stand_thousands_apart(tmp_path):
    text = table("a", translation="[0, 1000, 4000]") + table("b", translation="[-2e3, 1e3, 4e3]")
    calibration = read_calibration(written(tmp_path, text))
    assert (calibration.units, calibration.units_guessed) == ("mm", True)
    np.testing.assert_allclose(calibration.cameras[0].centre, [0, -4, 1], atol=1e-9)


def test_the_user_overrides_the_units(tmp_path):
    text = table("a", translation="[0, 100, 400]") + table("b", translation="[-200, 100, 400]")
    calibration = read_calibration(written(tmp_path, text), CalibrationSettings(units="cm"))
    assert (calibration.units, calibration.units_guessed) == ("cm", False)
    np.testing.assert_allclose(calibration.cameras[1].centre, [2, -4, 1], atol=1e-9)
    assert not any("units" in note for note in calibration.notes)


@pytest.mark.parametrize(
    ("up", "point_in_file"),  # where the file has the point that is (0.2, 0.3, 1.0) for us
    [
        ("z", [0.2, 0.3, 1.0]),
        ("-z", [0.2, -0.3, -1.0]),
        ("y", [0.2, 1.0, -0.3]),
        ("-y", [0.2, -1.0, 0.3]),
        ("x", [1.0, 0.3, -0.2]),
        ("-x", [-1.0, 0.3, 0.2]),
    ],
)
def test_the_chosen_axis_becomes_up_and_pictures_stay_the_same(tmp_path, up, point_in_file):
    path = written(tmp_path, two_tables())
    as_in_file = read_calibration(path, CalibrationSettings(up="z")).cameras
    turned = read_calibration(path, CalibrationSettings(up=up)).cameras
    for before, after in zip(as_in_file, turned, strict=True):
        seen = before.camera_from_world @ [*point_in_file, 1]
        np.testing.assert_allclose(after.camera_from_world @ [0.2, 0.3, 1.0, 1], seen, atol=1e-12)


def test_pictures_upright_along_another_axis_are_hinted_at(tmp_path):
    upright_along_minus_y = "".join(
        table(name, rotation="[0.0, 0.0, 0.0]", translation=translation)
        for name, translation in [("a", "[0.0, 0.0, 4.0]"), ("b", "[1.0, 0.0, 4.0]")]
    )
    path = written(tmp_path, upright_along_minus_y)
    assert any('up = "-y"' in note for note in read_calibration(path).notes)
    turned = read_calibration(path, CalibrationSettings(up="-y"))
    assert not any("upright" in note for note in turned.notes)
    np.testing.assert_allclose(turned.cameras[0].centre, [0, -4, 0], atol=1e-12)


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"matrix": None}, ["cam_2", "matrix is missing"]),
        ({"translation": None}, ["cam_2", "translation is missing"]),
        ({"rotation": None}, ["cam_2", "rotation is missing"]),
        ({"size": None}, ["cam_2", "size is missing"]),
        ({"size": "[640.5, 480]"}, ["cam_2", "size", "whole"]),
        ({"translation": "[1.0, nan, 2.0]"}, ["cam_2", "translation", "not finite"]),
        ({"translation": "[1.0, 2.0]"}, ["cam_2", "translation", "3 numbers, got 2"]),
        ({"translation": '["a", 1, 2]'}, ["cam_2", "translation", "numbers"]),
        ({"rotation": "[[1, 0, 0], [0, 0, 1], [0, 1, 0]]"}, ["rotation is mirrored"]),
        ({"rotation": "[[1, 0, 0], [0, 1, 0], [0, 1, 0]]"}, ["not a rotation"]),
        ({"rotation": "[1, 2, 3, 4]"}, ["rotation", "3 (Rodrigues) or 3 x 3", "got 4"]),
        ({"matrix": "[[-800, 0, 1], [0, 8, 1], [0, 0, 1]]"}, ["matrix", "focal length"]),
        ({"matrix": "[[800, 5, 1], [0, 800, 1], [0, 0, 1]]"}, ["matrix", "skew of 5"]),
        ({"matrix": "[[800, 0, 0], [0, 800, 0], [9, 9, 1]]"}, ["matrix", "row 0 0 1"]),
        ({"distortions": "[0.1, 0.2, 0.3]"}, ["distortions", "got 3"]),
        ({"fisheye": "true", "distortions": "[0, 0, 0, 0, 1]"}, ["fisheye", "got 5"]),
        ({"name": '"cam_1"'}, ["2 cameras are called 'cam_1'"]),
    ],
)
def test_every_bad_value_is_named_with_file_camera_and_remedy(tmp_path, changes, parts, fault):
    line = fault(written(tmp_path, two_tables(**changes)))
    for part in parts:
        assert part in line


def test_a_truncated_file_names_the_line(tmp_path, fault):
    text = two_tables()
    line = fault(written(tmp_path, text[: text.rindex("translation") + 16]))
    assert "not valid TOML" in line
    assert "line" in line or "end of document" in line


def test_a_missing_file_says_so(tmp_path, fault):
    assert "No such file" in fault(tmp_path / "nowhere.toml")


def test_an_empty_file_says_so(tmp_path, fault):
    assert "calibration is empty;" in fault(written(tmp_path, " \n"))


@pytest.mark.parametrize("content", ["version = 1\n[cameras]\n", '{"cameras": []}', "\x80\x04."])
def test_an_unknown_format_lists_the_known_ones(tmp_path, content, fault):
    line = fault(written(tmp_path, content))
    for key in ("toml", "qca", "opencv"):
        assert f"({key})" in line


def test_a_file_without_cameras_says_so(tmp_path, fault):
    path = written(tmp_path, "[metadata]\nmatrix_error = 1\n")
    assert "no camera" in fault(path, CalibrationSettings(format="toml"))


@pytest.mark.parametrize("choice", [{"format": "yaml"}, {"units": "feet"}, {"up": "w"}])
def test_unknown_choices_name_the_known_ones(choice):
    with pytest.raises(MocapError, match=r"unknown .* use "):
        CalibrationSettings(**choice)
