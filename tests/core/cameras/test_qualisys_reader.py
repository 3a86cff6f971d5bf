"""Qualisys .qca.txt files."""

from pathlib import Path

import numpy as np
import pytest
from silhouette_mocap.core.cameras.calibration import read_calibration

POINTS = np.array([[0.2, 0.3, 1.0], [-0.4, 0.1, 1.6]])


def written(folder: Path, text: str) -> Path:
    path = folder / "calibration.qca.txt"
    path.write_text(text, encoding="utf-8")
    return path


# the first twin: at (0, -4, 1) m; its axes right +X, up +Z, backwards -Y are the rows
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


def test_qualisys_is_read_in_millimetres_with_its_axes_turned(tmp_path, twins):
    text = qca({}, {"serial": "cam_2", "x": 2000})
    calibration = read_calibration(written(tmp_path, text))
    assert (calibration.units, calibration.units_guessed) == ("mm", False)
    for ours, theirs in zip(calibration.cameras, twins, strict=True):
        assert (ours.name, ours.size) == (theirs.name, theirs.size)
        np.testing.assert_allclose(ours.centre, theirs.centre, atol=1e-9)
        np.testing.assert_allclose(ours.matrix, theirs.matrix)
        np.testing.assert_allclose(ours.project(POINTS), theirs.project(POINTS), atol=1e-6)


def test_inactive_qualisys_cameras_are_left_out(tmp_path):
    path = written(tmp_path, qca({}, {"serial": "off", "active": 0}))
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
def test_bad_qualisys_files_are_named(tmp_path, fault, old, new, parts):
    line = fault(written(tmp_path, qca({}).replace(old, new)))
    for part in parts:
        assert part in line
