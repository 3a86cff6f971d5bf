"""What the tests of calibration readers share."""

from pathlib import Path

import numpy as np
import pytest
from silhouette_mocap.core.cameras.calibration import CalibrationSettings, read_calibration
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.errors import MocapError


@pytest.fixture
def fault():
    """A function: the line that reading a bad calibration gives, checked for file and remedy."""

    def line_of(path: Path, settings: CalibrationSettings | None = None) -> str:
        with pytest.raises(MocapError) as caught:
            read_calibration(path, settings)
        line = str(caught.value)
        assert path.stem.removesuffix("tri") in line or path.is_dir()
        assert "; " in line, "a remedy follows"
        assert "\n" not in line
        return line

    return line_of


@pytest.fixture
def twins() -> tuple[Camera, Camera]:
    """Two cameras that look along +Y, at (0, -4, 1) and (2, -4, 1), as the fixtures state them."""
    matrix = np.array([[800, 0, 319.5], [0, 810, 239.5], [0, 0, 1]])
    lens = np.array([-0.1, 0.02, 0.001, -0.002])

    def twin(name: str, x: float) -> Camera:
        pose = np.array([[1.0, 0, 0, -x], [0, 0, -1, 1], [0, 1, 0, 4]])
        return Camera(name, (640, 480), matrix, pose, lens)

    return twin("cam_1", 0.0), twin("cam_2", 2.0)
