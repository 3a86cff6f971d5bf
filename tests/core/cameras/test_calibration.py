"""Calibration files of all formats, and what is said about bad ones."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.cameras.calibration import (
    CalibrationSettings,
    natural_key,
    read_calibration,
    read_camera_names,
)
from silhouette_mocap.core.cameras.undistortion import Undistortion
from silhouette_mocap.core.errors import MocapError

MATRIX = "[[800.0, 0.0, 319.5], [0.0, 810.0, 239.5], [0.0, 0.0, 1.0]]"
POINTS = np.array([[0.2, 0.3, 1.0], [-0.4, 0.1, 1.6]])


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


def fault(path: Path, settings: CalibrationSettings | None = None) -> str:
    with pytest.raises(MocapError) as caught:
        read_calibration(path, settings)
    line = str(caught.value)
    assert path.stem.removesuffix("tri") in line or path.is_dir()
    assert "; " in line, "a remedy follows"
    assert "\n" not in line
    return line


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
        table(f"cameras.{n}", name=None, fisheye=None, **extra)
        for n, extra in [(10, {}), (2, {"rotation_count": "1"}), (3, {"ignore": "true"})]
    )
    calibration = read_calibration(written(tmp_path, text))
    assert [camera.name for camera in calibration.cameras] == ["2", "10"]
    assert any("camera 3 is left out" in note for note in calibration.notes)
    assert any("camera 2 has rotation_count 1" in note for note in calibration.notes)


def test_cameras_stand_in_natural_order(tmp_path):
    text = "".join(table(f"cam_{n}") for n in (10, 2, 1))
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
def test_every_bad_value_is_named_with_file_camera_and_remedy(tmp_path, changes, parts):
    line = fault(written(tmp_path, two_tables(**changes)))
    for part in parts:
        assert part in line


def test_a_truncated_file_names_the_line(tmp_path):
    text = two_tables()
    line = fault(written(tmp_path, text[: text.rindex("translation") + 16]))
    assert "not valid TOML" in line
    assert "line" in line or "end of document" in line


def test_a_missing_file_says_so(tmp_path):
    assert "No such file" in fault(tmp_path / "nowhere.toml")


def test_an_empty_file_says_so(tmp_path):
    assert "empty" in fault(written(tmp_path, " \n"))


@pytest.mark.parametrize("content", ["version = 1\n[cameras]\n", '{"cameras": []}', "\x80\x04."])
def test_an_unknown_format_lists_the_known_ones(tmp_path, content):
    line = fault(written(tmp_path, content))
    for key in ("toml", "qca", "opencv"):
        assert f"({key})" in line


def test_a_file_without_cameras_says_so(tmp_path):
    assert "no camera" in fault(written(tmp_path, "[metadata]\nmatrix_error = 1\n"), TOML)


TOML = CalibrationSettings(format="toml")


@pytest.mark.parametrize("choice", [{"format": "yaml"}, {"units": "feet"}, {"up": "w"}])
def test_unknown_choices_name_the_known_ones(choice):
    with pytest.raises(MocapError, match=r"unknown .* use "):
        CalibrationSettings(**choice)


# --- Qualisys -----------------------------------------------------------------------------------

# the camera of table(): position (0, -4, 1) m; its axes right +X, up +Z, backwards -Y are the rows
QCA_CAMERA = """<camera active="{active}" serial="{serial}">
  <fov_video left="100" top="20" right="739" bottom="499"/>
  <transform x="{x}" y="-4000" z="1000" r11="1" r12="0" r13="0" r21="0" r22="0" r23="1"
    r31="0" r32="-1" r33="0"/>
  <intrinsic focalLengthU="51200" focalLengthV="51840" centerPointU="26848" centerPointV="16608"
    skew="0" radialDistortion1="-0.1" radialDistortion2="0.02" radialDistortion3="0"
    tangentalDistortion1="0.001" tangentalDistortion2="-0.002"/>
</camera>"""


def qca(*cameras: dict) -> str:
    start = {"active": 1, "serial": "cam_1", "x": 0}
    body = "\n".join(QCA_CAMERA.format(**start | camera) for camera in cameras)
    return f'<?xml version="1.0"?>\n<calibration>\n<cameras>\n{body}\n</cameras></calibration>'


def test_qualisys_agrees_with_the_same_camera_in_toml(tmp_path):
    toml = read_calibration(written(tmp_path, two_tables())).cameras
    text = qca({}, {"serial": "cam_2", "x": 2000})
    calibration = read_calibration(written(tmp_path, text, "calibration.qca.txt"))
    assert (calibration.units, calibration.units_guessed) == ("mm", False)
    for ours, theirs in zip(calibration.cameras, toml, strict=True):
        assert (ours.name, ours.size) == (theirs.name, theirs.size)
        np.testing.assert_allclose(ours.centre, theirs.centre, atol=1e-9)
        np.testing.assert_allclose(ours.matrix, theirs.matrix)
        np.testing.assert_allclose(ours.project(POINTS), theirs.project(POINTS), atol=1e-6)


def test_inactive_qualisys_cameras_are_left_out(tmp_path):
    path = written(tmp_path, qca({}, {"serial": "off", "active": 0}), "calibration.txt")
    calibration = read_calibration(path)
    assert [camera.name for camera in calibration.cameras] == ["cam_1"]
    assert "camera off is left out" in calibration.notes[0]


@pytest.mark.parametrize(
    ("old", "new", "parts"),
    [
        ("</cameras></calibration>", "", ["not complete XML", "line"]),
        ('r12="0" ', "", ["cam_1", "transform r12 is missing"]),
        ('r32="-1"', 'r32="1"', ["cam_1", "transform", "mirrored"]),
        ('focalLengthU="51200"', 'focalLengthU="inf"', ["cam_1", "intrinsic", "not finite"]),
        ('focalLengthU="51200"', 'focalLengthU="wide"', ["cam_1", "intrinsic", "numbers"]),
        ("fov_video", "fov_other", ["cam_1", "<fov_marker> is missing"]),
        ('serial="cam_1"', "", ["no serial"]),
    ],
)
def test_bad_qualisys_files_are_named(tmp_path, old, new, parts):
    line = fault(written(tmp_path, qca({}).replace(old, new), "calibration.txt"))
    for part in parts:
        assert part in line


# --- OpenCV / EasyMocap -------------------------------------------------------------------------


def write_pair(folder: Path, names=("none", "cam_10", "none", "cam_2"), lens="dist", rot="Rot"):
    """The camera of table(), once at x = 0 and once at x = 2 m, as OpenCV writes it."""
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
def test_an_easymocap_pair_is_read_from_either_file_or_the_folder(tmp_path, given, lens, rot):
    write_pair(tmp_path, lens=lens, rot=rot)
    calibration = read_calibration(tmp_path / given, SIZES)
    assert [camera.name for camera in calibration.cameras] == ["cam_2", "cam_10"]
    assert [camera.size for camera in calibration.cameras] == [(640, 480), (480, 640)]
    folder = tmp_path / "toml"
    folder.mkdir()
    twin = read_calibration(written(folder, two_tables())).cameras[1]
    np.testing.assert_allclose(calibration.cameras[0].centre, [2, -4, 1], atol=1e-9)
    np.testing.assert_allclose(
        calibration.cameras[0].project(POINTS), twin.project(POINTS), atol=1e-6
    )


def test_names_are_known_before_sizes(tmp_path):
    write_pair(tmp_path, names=())
    assert read_camera_names(tmp_path) == ("cam_2", "cam_10")


def test_an_unknown_size_names_the_camera_and_the_remedy(tmp_path):
    write_pair(tmp_path)
    line = fault(tmp_path / "intri.yml")
    assert "cam_2" in line
    assert "give the footage's size" in line


def test_sizes_in_the_pair_itself_are_taken(tmp_path):
    write_pair(tmp_path)
    with (tmp_path / "intri.yml").open("a") as file:
        file.write("W_cam_2: 640\nH_cam_2: 480\nW_cam_10: 640\nH_cam_10: 480\n")
    assert read_calibration(tmp_path).cameras[0].size == (640, 480)


def test_a_pair_without_its_other_half_says_so(tmp_path):
    write_pair(tmp_path)
    (tmp_path / "extri.yml").unlink()
    assert "extri.yml is not beside it" in fault(tmp_path / "intri.yml", SIZES)


def test_a_folder_without_a_pair_says_so(tmp_path):
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
def test_bad_values_of_a_pair_are_named(tmp_path, file, old, new, parts):
    write_pair(tmp_path)
    path = tmp_path / file
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    line = fault(tmp_path / "intri.yml", SIZES)
    for part in parts:
        assert part in line


def test_a_truncated_pair_says_so(tmp_path):
    write_pair(tmp_path)
    path = tmp_path / "extri.yml"
    path.write_text(path.read_text()[:-150])
    assert "extri.yml" in fault(tmp_path / "intri.yml", SIZES)


# --- Real files, where they are at hand ---------------------------------------------------------

REAL = Path(__file__).parents[3].parent / "shared" / "calibration"
needs_real_files = pytest.mark.skipif(not REAL.is_dir(), reason="the real files are not at hand")


@needs_real_files
def test_the_real_qualisys_file_agrees_with_its_toml_twin():
    qca_cameras = read_calibration(REAL / "qualisys_qca" / "Calib.qca.txt").cameras
    toml_cameras = read_calibration(REAL / "pose2sim_toml" / "Calib_2024-02_pose2sim.toml").cameras
    grid = np.stack(np.meshgrid([-0.5, 0.5], [-0.5, 0.5], [0.1, 1.8]), axis=-1).reshape(-1, 3)
    for ours, theirs in zip(qca_cameras, toml_cameras, strict=True):
        np.testing.assert_allclose(ours.centre, theirs.centre, atol=0.001)
        # the twin's writer divided the lens coefficients by 64 as well (see the reader's head)
        twin = replace(theirs, distortion=theirs.distortion * 64)
        assert np.abs(ours.project(grid) - twin.project(grid)).max() < 0.1


@needs_real_files
@pytest.mark.parametrize(
    ("file", "count", "spread"),
    [
        ("anipose_caliscope_toml/caliscope_post_optimization_camera_array.toml", 4, (0.5, 3)),
        ("pose2sim_toml/Calib_2024-02_pose2sim.toml", 4, (5, 8)),
        ("qualisys_qca/Calib.qca.txt", 4, (5, 8)),
        ("easymocap_yml", 23, (4, 8)),
    ],
)
def test_real_files_give_cameras_metres_apart_that_undistort(file, count, spread):
    sizes = {f"Camera_B{n}": (1024, 1024) for n in range(1, 24)}
    cameras = read_calibration(REAL / file, CalibrationSettings(sizes=sizes)).cameras
    assert len(cameras) == count
    centres = np.array([camera.centre for camera in cameras])
    widest = np.linalg.norm(centres[:, None] - centres, axis=2).max()
    assert spread[0] < widest < spread[1]
    for camera in cameras:
        assert Undistortion(camera).observed.mean() > 0.7
