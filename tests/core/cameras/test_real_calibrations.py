"""Calibrations as their systems wrote them, where those files are at hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from silhouette_mocap.core.cameras.calibration import CalibrationSettings, read_calibration
from silhouette_mocap.core.cameras.undistortion import Undistortion

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
