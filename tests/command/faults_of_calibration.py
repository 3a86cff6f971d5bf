"""Faults of the calibration: its file in each format, and the cameras in it."""

import os
import re
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from circumstances import ON_LINUX, ON_UNIX, bound_by_permissions
from faults import Chapter, replace_text
from silhouette_mocap.core.cameras.calibration import read_calibration
from silhouette_mocap.core.cameras.camera import Camera

FILE = Chapter("The calibration, its file")
CAMERAS = Chapter("The calibration, its cameras")
TOML = "calibration.toml"


def qca(folder: Path) -> Path:
    """The take's calibration as a Qualisys file, which the take then uses."""
    path = folder / "calibration.qca.txt"
    path.write_text(
        '<?xml version="1.0"?>\n<calibration><cameras>\n'
        + "\n".join(map(_qca_camera, read_calibration(folder / TOML).cameras))
        + "\n</cameras></calibration>\n",
        "utf-8",
    )
    _use(folder, path.name)
    return path


def _qca_camera(camera: Camera) -> str:
    (width, height), k = camera.size, (camera.matrix * 64).tolist()
    x, y, z = (camera.centre * 1000).tolist()
    axes = (np.diag([1.0, -1.0, -1.0]) @ camera.rotation).tolist()
    turns = " ".join(f'r{i + 1}{j + 1}="{axes[i][j]}"' for i in range(3) for j in range(3))
    kinds = ("radialDistortion1", "radialDistortion2", "radialDistortion3")
    kinds = (*kinds, "tangentalDistortion1", "tangentalDistortion2")
    lens = " ".join(f'{kind}="0"' for kind in kinds)
    return (
        f'<camera active="1" serial="{camera.name}">\n'
        f'<fov_video left="0" top="0" right="{width - 1}" bottom="{height - 1}"/>\n'
        f'<transform x="{x}" y="{y}" z="{z}" {turns}/>\n'
        f'<intrinsic focalLengthU="{k[0][0]}" focalLengthV="{k[1][1]}" '
        f'centerPointU="{k[0][2]}" centerPointV="{k[1][2]}" skew="0" {lens}/>\n</camera>'
    )


def opencv_pair(folder: Path) -> Path:
    """The take's calibration as intri.yml and extri.yml, which the take then uses: the folder."""
    lens, position = (
        cv2.FileStorage(str(folder / name), cv2.FILE_STORAGE_WRITE)
        for name in ("intri.yml", "extri.yml")
    )
    for camera in read_calibration(folder / TOML).cameras:
        lens.write(f"K_{camera.name}", camera.matrix)
        lens.write(f"dist_{camera.name}", np.zeros((1, 5)))
        position.write(f"Rot_{camera.name}", camera.rotation)
        position.write(f"T_{camera.name}", camera.camera_from_world[:, 3:])
    lens.release()
    position.release()
    _use(folder, "intri.yml")
    return folder


def of_opencv_pair(folder: Path, key: str, shape: tuple[int, int], data: str) -> None:
    """Gives one matrix of extri.yml other numbers, as written."""
    matrix = f": !!opencv-matrix\n   rows: {shape[0]}\n   cols: {shape[1]}\n   dt: d\n"
    path = opencv_pair(folder) / "extri.yml"
    changed(path, rf"(?s)(?<={key}):.*?data: \[.*?\]", f"{matrix}   data: [ {data} ]")


def _use(folder: Path, calibration: str) -> None:
    replace_text(folder / "take.toml", f'"{TOML}"', f'"{calibration}"')
    replace_text(folder / "take.toml", 'units = "m"\n', "")


def changed(path: Path, pattern: str, new: str) -> None:
    """Replaces what ``pattern`` finds first."""
    text, count = re.subn(pattern, lambda _: new, path.read_text("utf-8"), count=1)
    assert count, f"{pattern!r} is not in {path.name}"
    path.write_text(text, "utf-8")


def of_camera(folder: Path, camera: str, key: str, value: str) -> None:
    """Gives one key of a camera in the TOML file another value."""
    path = folder / TOML
    before, head, after = path.read_text("utf-8").partition(f"[{camera}]\n")
    after, count = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", after, count=1)
    assert count, f"{camera} has no {key}"
    path.write_text(before + head + after, "utf-8")


def moved(folder: Path, move: Callable[[Camera], np.ndarray], names: str = "cam_") -> None:
    """Gives cameras whose names hold ``names`` another translation."""
    for camera in read_calibration(folder / TOML).cameras:
        if names in camera.name:
            of_camera(folder, camera.name, "translation", str(move(camera).tolist()))


def turned(camera: Camera, turn: np.ndarray) -> tuple[str, str]:
    """Rotation and translation, as written, of a camera turned about its own centre."""
    rotation = turn @ camera.rotation
    return (
        str(cv2.Rodrigues(rotation)[0].ravel().tolist()),
        str((-rotation @ camera.centre).tolist()),
    )


@FILE.add("no such calibration", "calibration.toml: ", "No such file", "[cameras] calibration")
def _(folder: Path):
    (folder / TOML).unlink()


@FILE.add("an empty calibration", "calibration.toml: calibration is empty")
def _(folder: Path):
    (folder / TOML).write_bytes(b"\n")


@FILE.add(
    "a calibration that may not be read",
    "calibration.toml: ",
    "Permission denied",
    within=bound_by_permissions,
    unless=ON_LINUX,
)
def _(folder: Path):
    (folder / TOML).chmod(0)


@FILE.add("a folder without a calibration", "masks: this folder holds no intri.yml")
def _(folder: Path):
    replace_text(folder / "take.toml", f'"{TOML}"', '"masks"')


@FILE.add("an unknown format", "calibration.toml: unknown calibration format", "qca")
def _(folder: Path):
    (folder / TOML).write_text("solver version 3\n", "utf-8")


@FILE.add("a picture as calibration", "000000.png: unknown calibration format")
def _(folder: Path):
    replace_text(folder / "take.toml", f'"{TOML}"', '"masks/cam_01/000000.png"')


@FILE.add("TOML cut short", "calibration.toml: is not valid TOML", "at end of document")
def _(folder: Path):
    path = folder / TOML
    path.write_bytes(path.read_bytes()[:-40])


@FILE.add("Qualisys file cut short", "calibration.qca.txt: is not complete XML", "QTM")
def _(folder: Path):
    path = qca(folder)
    path.write_bytes(path.read_bytes()[:-40])


@FILE.add("OpenCV file cut short", "intri.yml: is cut short")
def _(folder: Path):
    path = opencv_pair(folder) / "intri.yml"
    path.write_bytes(path.read_bytes()[:-40])


@FILE.add("one of OpenCV's two files missing", "intri.yml", "extri.yml is not beside it")
def _(folder: Path):
    (opencv_pair(folder) / "extri.yml").unlink()


@FILE.add("one file named as another format", "calibration.toml: is not complete XML")
def _(folder: Path):
    replace_text(folder / "take.toml", 'units = "m"', 'units = "m"\nformat = "qca"')


def _camera(title: str, key: str, value: str, *says: str) -> None:
    CAMERAS.add(title, ", camera cam_02: ", *says)(
        lambda folder: of_camera(folder, "cam_02", key, value)
    )


_camera(
    "a number that is none (TOML)", "translation", "[nan, 0.0, 4.0]", "translation", "not finite"
)
_camera(
    "an infinite number (TOML)",
    "matrix",
    "[[inf, 0, 80], [0, 137, 60], [0, 0, 1]]",
    "matrix",
    "not finite",
)
_camera(
    "a decimal comma (TOML)", "translation", "[0,1, 0,2, 4,0]", "translation", "6", "decimal points"
)
_camera(
    "a number written as text (TOML)",
    "translation",
    '["0,1", "0,2", "4,0"]',
    "translation",
    "decimal points",
)
_camera(
    "mirrored rotation (TOML)",
    "rotation",
    "[[1, 0, 0], [0, 1, 0], [0, 0, -1]]",
    "rotation",
    "mirrored (determinant -1)",
)
_camera(
    "rotation that is none",
    "rotation",
    "[[1, 0, 0], [0, 1, 0], [0, 1, 1]]",
    "rotation",
    "not orthonormal",
)
_camera(
    "negative focal length", "matrix", "[[-137, 0, 80], [0, 137, 60], [0, 0, 1]]", "focal length"
)
_camera(
    "a focal length of nearly nothing",
    "matrix",
    "[[1e-300, 0, 80], [0, 1e-300, 60], [0, 0, 1]]",
    "matrix has a focal length of 1e-300 px",
    "160 px wide",
    "calibrate this camera again",
)
_camera(
    "focal lengths far from each other",
    "matrix",
    "[[137, 0, 80], [0, 13.7, 60], [0, 0, 1]]",
    "focal lengths of 137 and 13.7 px",
)
_camera("matrix by columns", "matrix", "[[137, 0, 0], [0, 137, 0], [80, 60, 1]]", "row 0 0 1")
_camera("no size", "size", "[0, 0]", "size", "[0, 0]")
_camera("three lens coefficients", "distortions", "[0.1, 0.0, 0.0]", "distortions", "got 3")
_camera("a lens that folds the picture", "distortions", "[-3.0, 0.0, 0.0, 0.0]", "no viewing ray")
_camera("footage of another aspect", "size", "[160, 90]", "160 x 120", "160 x 90", "adjust")
_camera("footage turned to portrait", "size", "[120, 160]", "portrait and landscape")


@CAMERAS.add("a value missing (TOML)", "calibration.toml, camera cam_02: matrix is missing")
def _(folder: Path):
    of_camera(folder, "cam_02", "matrix", "0")
    replace_text(folder / TOML, "matrix = 0\n", "")


@CAMERAS.add("mirrored rotation (Qualisys)", "camera cam_01: transform is mirrored")
def _(folder: Path):
    path = qca(folder)
    values = re.findall(r'r3(\d)="(.*?)"', path.read_text("utf-8"))[:3]
    for column, value in values:
        changed(path, f'r3{column}="{value}"', f'r3{column}="{-float(value)}"')


@CAMERAS.add("mirrored rotation (OpenCV)", "extri.yml, camera cam_01: Rot_cam_01 is mirrored")
def _(folder: Path):
    of_opencv_pair(folder, "Rot_cam_01", (3, 3), "1., 0., 0., 0., 1., 0., 0., 0., -1.")


@CAMERAS.add("a number that is none (Qualisys)", "camera cam_01: transform", "not finite")
def _(folder: Path):
    changed(qca(folder), ' x="[^"]*"', ' x="NaN"')


@CAMERAS.add("a number that is none (OpenCV)", "camera cam_01: T_cam_01", "not finite")
def _(folder: Path):
    of_opencv_pair(folder, "T_cam_01", (3, 1), ".Nan, 0., 4.")


@CAMERAS.add("a decimal comma (Qualisys)", "camera cam_01: transform", "decimal points")
def _(folder: Path):
    changed(qca(folder), ' x="[^"]*"', ' x="1234,5"')


@CAMERAS.add("a decimal comma (OpenCV)", "extri.yml", "decimal points")
def _(folder: Path):
    of_opencv_pair(folder, "T_cam_01", (3, 1), "0,5, 0,5, 4,0")


@CAMERAS.add("two cameras of one name (TOML)", "calibration.toml: 2 cameras are called 'cam_01'")
def _(folder: Path):
    replace_text(folder / TOML, 'name = "cam_02"', 'name = "cam_01"')


@CAMERAS.add("two tables of one name (TOML)", "calibration.toml: ", "cam_01", "twice")
def _(folder: Path):
    replace_text(folder / TOML, "[cam_02]", "[cam_01]")


@CAMERAS.add("two cameras of one name (Qualisys)", "2 cameras are called 'cam_01'")
def _(folder: Path):
    replace_text(qca(folder), 'serial="cam_02"', 'serial="cam_01"')


@CAMERAS.add("two cameras of one name (OpenCV)", "intri.yml", "cam_01", "name")
def _(folder: Path):
    replace_text(opencv_pair(folder) / "intri.yml", "K_cam_02", "K_cam_01")


@CAMERAS.add("a camera named as no file can be", "'a/b'", "rename")
def _(folder: Path):
    replace_text(folder / TOML, 'name = "cam_02"', 'name = "a/b"')


@CAMERAS.add("a camera with a colour of the terminal", "x1b[31mcam", "cannot name files; rename it")
def _(folder: Path):
    replace_text(folder / TOML, 'name = "cam_02"', 'name = "\\u001b[31mcam"')


@FILE.add("a calibration that is a pipe", "calibration.toml: is no ordinary file", unless=ON_UNIX)
def _(folder: Path):
    (folder / TOML).unlink()
    os.mkfifo(folder / TOML)


@CAMERAS.add("only one camera", "calibration.toml", "1 camera", "at least 2")
def _(folder: Path):
    path = folder / TOML
    path.write_text(path.read_text("utf-8").partition("[cam_02]")[0], "utf-8")


@CAMERAS.add("no camera at all", "calibration.toml", "no camera")
def _(folder: Path):
    (folder / TOML).write_text("[metadata]\ndistortions = 1\n", "utf-8")


@CAMERAS.add(
    "a lens missing (OpenCV)", "intri.yml, camera cam_01: dist_cam_01 or D_cam_01 is missing"
)
def _(folder: Path):
    replace_text(opencv_pair(folder) / "intri.yml", "dist_cam_01", "d_cam_01")


@CAMERAS.add("millimetres taken for metres", "calibration.toml", "km apart", 'units = "mm"')
def _(folder: Path):
    moved(folder, lambda camera: camera.camera_from_world[:, 3] * 1000)


@CAMERAS.add("metres taken for millimetres", "calibration.toml", "mm apart", 'units = "m"')
def _(folder: Path):
    replace_text(folder / "take.toml", 'units = "m"', 'units = "mm"')


@CAMERAS.add("cameras a millimetre apart in any unit", "calibration.toml", "mm apart")
def _(folder: Path):
    moved(folder, lambda camera: camera.camera_from_world[:, 3] / 1000)


@CAMERAS.add(
    "one camera kilometres away", "calibration.toml, camera cam_04", "km", "--without cam_04"
)
def _(folder: Path):
    moved(folder, lambda camera: np.array([0.0, 0.0, 5000.0]), "cam_04")


@CAMERAS.add("all cameras in one place", "calibration.toml", "0 mm apart")
def _(folder: Path):
    moved(folder, lambda camera: np.zeros(3))


@CAMERAS.add("a camera turned away", "camera cam_03", "--without cam_03")
def _(folder: Path):
    camera = read_calibration(folder / TOML).cameras[2]
    rotation, translation = turned(camera, np.diag([-1.0, 1.0, -1.0]))
    of_camera(folder, "cam_03", "rotation", rotation)
    of_camera(folder, "cam_03", "translation", translation)


@CAMERAS.add("cameras whose rays do not meet", "rays", "m")
def _(folder: Path):
    cameras = read_calibration(folder / TOML).cameras
    for index, camera in enumerate(cameras):
        turn = cv2.Rodrigues(np.array([0.0, 0.35 * (-1) ** index, 0.0]))[0]
        rotation, translation = turned(camera, turn)
        of_camera(folder, camera.name, "rotation", rotation)
        of_camera(folder, camera.name, "translation", translation)
