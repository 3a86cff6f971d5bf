"""The whole takes whose files are damaged: one per format of calibration and of masks."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from benchmarks import mutations
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.cameras.presets import Ring, ring
from small_take import calibration_of

SIZE, FRAMES = (80, 60), 2
TAKE = """version = 1
name = "small"
fps = 29.97
frames = [0, 1]
initial_pose = { frames = [0, 1], kind = "A" }
[cameras]
calibration = "CALIBRATION"
units = "UNITS"
up = "z"
adjust = { cam_1 = { scale = 1.0, shift = [0.0, 0.0] } }
[footage]
silhouettes = "masks/{camera}MASK"
[performer]
body = "sixteen_segment"
height_m = 1.8
[world]
floor = 0.0
[fit]
tracker = "hierarchical"
[export]
formats = ["trc"]
"""
CAMERAS = ("cam_1", "cam_2")


@dataclass(frozen=True)
class Kind:
    """One format.

    Attributes:
        targets: files of the take that are damaged.
        mutations: how.
        calibration: the name of the calibration.
        units: of its lengths.
        mask: what follows the camera in the masks' names.
    """

    targets: tuple[str, ...]
    mutations: tuple[mutations.Mutation, ...]
    calibration: str = "calibration.toml"
    units: str = "m"
    mask: str = "/{frame:06d}.png"


@dataclass(frozen=True)
class Target:
    """A file to damage, and the take that it belongs to."""

    kind: str
    take: Path
    file: Path


def _masks(suffix: str, damage: tuple[mutations.Mutation, ...]) -> Kind:
    files = tuple(f"masks/cam_1/{frame:06d}{suffix}" for frame in range(FRAMES))
    return Kind(files, damage, mask="/{frame:06d}" + suffix)


KINDS = {
    "take.toml": Kind(("take.toml",), mutations.TEXT),
    "toml": Kind(("calibration.toml",), mutations.TEXT),
    "qca": Kind(("camera.qca.txt",), mutations.XML, "camera.qca.txt", "mm"),
    "yml": Kind(("intri.yml", "extri.yml"), mutations.TEXT, "intri.yml"),
    "xml": Kind(("intri.xml", "extri.xml"), mutations.XML, "intri.xml"),
    "png": _masks(".png", mutations.PNG),
    "jpeg": _masks(".jpg", mutations.PICTURE),
    "tiff": _masks(".tif", mutations.PICTURE),
    "mp4": Kind(("masks/cam_1.mp4",), mutations.PICTURE, mask=".mp4"),
}


def write_takes(folder: Path) -> Path:
    """Writes a take of each kind into ``folder/KIND`` and returns ``folder``."""
    cameras = ring(Ring(len(CAMERAS), heights=(1.0, 2.0), size=SIZE, focal_px=70.0))
    for name, kind in KINDS.items():
        place = folder / name
        (place / "masks").mkdir(parents=True)
        _CALIBRATIONS[kind.calibration](place, cameras)
        _write_masks(place / "masks", kind.mask)
        text = TAKE.replace("CALIBRATION", kind.calibration).replace("MASK", kind.mask)
        (place / "take.toml").write_text(text.replace("UNITS", kind.units), "utf-8")
    return folder


def _write_masks(folder: Path, pattern: str) -> None:
    picture = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    cv2.ellipse(picture, (40, 30), (12, 25), 0, 0, 360, (255, 255, 255), -1)
    for camera in CAMERAS:
        if pattern == ".mp4":
            code = cv2.VideoWriter.fourcc(*"mp4v")
            video = cv2.VideoWriter(str(folder / f"{camera}.mp4"), code, 30.0, SIZE)
            for _ in range(FRAMES):
                video.write(picture)
            video.release()
            continue
        (folder / camera).mkdir()
        deep = picture[:, :, 0].astype(np.uint16) * 257 if pattern.endswith("tif") else picture
        for frame in range(FRAMES):
            cv2.imwrite(str(folder) + f"/{camera}" + pattern.format(frame=frame), deep)


def _write_toml(folder: Path, cameras: tuple[Camera, ...]) -> None:
    text = "\n".join(map(calibration_of, cameras))
    for camera, name in zip(cameras, CAMERAS, strict=True):
        text = text.replace(camera.name, name)
    (folder / "calibration.toml").write_text(text, "utf-8")


def _write_opencv(folder: Path, cameras: tuple[Camera, ...], suffix: str = ".yml") -> None:
    lenses = cv2.FileStorage(str(folder / f"intri{suffix}"), cv2.FileStorage_WRITE)
    places = cv2.FileStorage(str(folder / f"extri{suffix}"), cv2.FileStorage_WRITE)
    for storage in (lenses, places):
        storage.startWriteStruct("names", cv2.FileNode_SEQ)
        for name in CAMERAS:
            storage.write("", name)
        storage.endWriteStruct()
    for camera, name in zip(cameras, CAMERAS, strict=True):
        lenses.write(f"K_{name}", camera.matrix)
        lenses.write(f"dist_{name}", np.zeros((1, 5)))
        places.write(f"Rot_{name}", np.ascontiguousarray(camera.rotation))
        places.write(f"T_{name}", np.ascontiguousarray(camera.camera_from_world[:, 3:]))
    for storage in (lenses, places):
        storage.release()


def _write_qualisys(folder: Path, cameras: tuple[Camera, ...]) -> None:
    rows = ['<?xml version="1.0" encoding="UTF-8"?>', '<calibration created="2026-01-01"><cameras>']
    for camera, name in zip(cameras, CAMERAS, strict=True):
        axes = np.diag([1.0, -1.0, -1.0]) @ camera.rotation
        names = [f"r{row}{column}" for row in (1, 2, 3) for column in (1, 2, 3)]
        place = dict(zip("xyz", camera.centre * 1000.0, strict=True))
        place |= dict(zip(names, axes.ravel(), strict=True))
        fx, fy, cx, cy = (camera.matrix[i] * 64.0 for i in ((0, 0), (1, 1), (0, 2), (1, 2)))
        lens = {"focalLengthU": fx, "focalLengthV": fy, "centerPointU": cx, "centerPointV": cy}
        lens |= dict.fromkeys(("skew", "radialDistortion1", "radialDistortion2"), 0.0)
        lens |= dict.fromkeys(("radialDistortion3", "tangentalDistortion1"), 0.0)
        lens["tangentalDistortion2"] = 0.0
        view = {"left": 0, "top": 0, "right": SIZE[0] - 1, "bottom": SIZE[1] - 1}
        children = {"fov_video": view, "transform": place, "intrinsic": lens}
        rows.append(f'<camera active="1" serial="{name}">')
        rows += [f"<{tag} {_attributes(values)}/>" for tag, values in children.items()]
        rows.append("</camera>")
    rows.append("</cameras></calibration>")
    (folder / "camera.qca.txt").write_text("\n".join(rows), "utf-8")


def _attributes(values: dict) -> str:
    return " ".join(f'{key}="{value}"' for key, value in values.items())


_CALIBRATIONS: dict[str, Callable[[Path, tuple[Camera, ...]], None]] = {
    "calibration.toml": _write_toml,
    "camera.qca.txt": _write_qualisys,
    "intri.yml": _write_opencv,
    "intri.xml": lambda folder, cameras: _write_opencv(folder, cameras, ".xml"),
}
