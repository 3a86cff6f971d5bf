"""A take small enough to be fitted in a test: five cameras of 160 x 120 px, four frames, truth."""

from pathlib import Path

import cv2
import numpy as np
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.cameras.presets import Ring, ring
from silhouette_mocap.core.initialisation.first_pose import FirstFit
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.rendering.native import NativeEvaluator


class Notes(Silence):
    """Progress that remembers what was told, and of which frames."""

    def __init__(self):
        self.told, self.frames = [], []

    def note(self, text):
        """Remembers the text."""
        self.told.append(text)

    def advance(self, frame, figures=None):
        """Remembers the frame of a fit."""
        self.frames += [frame] * (figures is not None)


FRAMES = 4
TAKE = """
version = 1
name = "small"
fps = 15.0
frames = [0, 3]
initial_pose = { frames = [0, 1], kind = "A" }
[cameras]
calibration = "calibration.toml"
units = "m"
[footage]
silhouettes = "masks/{camera}/{frame:06d}.png"
[performer]
body = "sixteen_segment"
"""


def small_cameras():
    """Five cameras round the performer, 4 m away."""
    return ring(Ring(5, heights=(1.0, 2.0), size=(160, 120), focal_px=137.0))


def write_small_take(folder: Path) -> Path:
    """Writes the take into ``folder``, which is there, and returns its take.toml."""
    body, cameras = template("sixteen_segment"), small_cameras()
    poses = np.zeros((FRAMES, len(body.dofs)))
    poses[:, 0] = np.linspace(0, 0.12, FRAMES)
    poses[:, body.dofs.names.index("left_elbow_flexion")] = np.linspace(0, 0.6, FRAMES)
    evaluator = NativeEvaluator(body, cameras)
    for frame, pose in enumerate(poses):
        for camera, picture in zip(cameras, evaluator.silhouettes(pose), strict=True):
            path = folder / "masks" / camera.name / f"{frame:06d}.png"
            path.parent.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(path), picture.astype(np.uint8) * 255)
    np.savez(
        folder / "truth.npz",
        points=points(body, poses), point_names=POINT_NAMES, frames=np.arange(FRAMES), fps=15.0,
    )  # fmt: skip
    (folder / "calibration.toml").write_text("\n".join(map(calibration_of, cameras)), "utf-8")
    (folder / "take.toml").write_text(TAKE, "utf-8")
    return folder / "take.toml"


def calibration_of(camera) -> str:
    """One camera's table of a calibration.toml."""
    rotation = cv2.Rodrigues(camera.rotation)[0].ravel().tolist()
    return f"""[{camera.name}]
name = "{camera.name}"
size = {list(camera.size)}
matrix = {camera.matrix.tolist()}
distortions = [0.0, 0.0, 0.0, 0.0]
rotation = {rotation}
translation = {camera.camera_from_world[:, 3].tolist()}
"""


def known_start(body, cameras, silhouettes, request, make_evaluator) -> FirstFit:
    """What `initialised` would find in the small take, without searching for it."""
    return FirstFit(body, body.rest_pose, np.ones(len(cameras)), ())
