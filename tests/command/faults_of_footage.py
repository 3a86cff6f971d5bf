"""Faults of the footage: its files, and what the masks show."""

import os
import shutil
from pathlib import Path

import cv2
import numpy as np
from circumstances import ON_LINUX, ON_UNIX, bound_by_permissions
from faults import Chapter, fit_words, replace_text
from faults_of_calibration import of_camera
from silhouette_mocap.core.footage.video_writing import write_video

FILES = Chapter("The footage, its files")
MASKS = Chapter("The footage, what it shows")
CAMERAS = tuple(f"cam_0{i}" for i in range(1, 6))


def mask(folder: Path, camera: str, frame: int) -> Path:
    """The file of one mask."""
    return folder / "masks" / camera / f"{frame:06d}.png"


def masks(folder: Path, camera: str) -> list[np.ndarray]:
    """(H, W) uint8 masks of one camera."""
    return [cv2.imread(str(mask(folder, camera, f)), cv2.IMREAD_GRAYSCALE) for f in range(4)]


def painted(path: Path, change) -> None:
    """Writes ``change`` of the picture in the place of the picture."""
    cv2.imwrite(str(path), change(cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)))


def down_to_the_edge(picture: np.ndarray) -> np.ndarray:
    """A performer whose feet are beyond the picture."""
    rows, columns = np.nonzero(picture)
    picture[rows.max() - 8 :, columns[rows > rows.max() - 8]] = 255
    return picture


def videos(folder: Path, frames: int = 4) -> None:
    """The masks as silhouette videos, which the take then uses."""
    for camera in CAMERAS:
        pictures = [cv2.cvtColor(one, cv2.COLOR_GRAY2BGR) for one in masks(folder, camera)]
        write_video(folder / f"{camera}.mp4", (pictures * 9)[:frames], 15.0)
    replace_text(folder / "take.toml", "masks/{camera}/{frame:06d}.png", "{camera}.mp4")


@FILES.add("a camera without footage", "masks/cam_03", "camera cam_03: no picture")
def _(folder: Path):
    shutil.rmtree(folder / "masks/cam_03")


@FILES.add("a camera without a video", "cam_03.mp4, camera cam_03: no such footage")
def _(folder: Path):
    videos(folder)
    (folder / "cam_03.mp4").unlink()


@FILES.add("a folder of masks that is empty", "masks/cam_03", "camera cam_03: no picture")
def _(folder: Path):
    replace_text(folder / "take.toml", "/{frame:06d}.png", "")
    for path in (folder / "masks/cam_03").iterdir():
        path.unlink()


@FILES.add(
    "a frame missing in one view", "masks/cam_02/000002.png, camera cam_02, frame 2: missing"
)
def _(folder: Path):
    mask(folder, "cam_02", 2).unlink()


@FILES.add(
    "pictures larger than what can be drawn",
    "masks/cam_02/{frame:06d}.png, camera cam_02: would be tracked at 16240 x 4 px",
)
def _(folder: Path):
    picture = np.zeros((4, 16240), np.uint8)
    picture[:, 8000:8010] = 255
    for frame in range(4):
        cv2.imwrite(str(mask(folder, "cam_02", frame)), picture)
    of_camera(folder, "cam_02", "size", "[16240, 4]")
    of_camera(folder, "cam_02", "matrix", "[[9000, 0, 8120], [0, 9000, 2], [0, 0, 1]]")


@FILES.add(
    "masks shorter than frames",
    "masks/cam_01/000004.png, camera cam_01, frame 4: missing",
    "frames 0 to 3",
)
def _(folder: Path):
    replace_text(folder / "take.toml", "[0, 3]", "[0, 9]")


@FILES.add("frames beyond anything", "camera cam_01, frame 4: missing", "frames 0 to 3")
def _(folder: Path):
    replace_text(folder / "take.toml", "[0, 3]", f"[0, {10**9}]")


@FILES.add("masks numbered otherwise", "masks/cam_01", "no picture of this name", "digits")
def _(folder: Path):
    replace_text(folder / "take.toml", "{frame:06d}", "{frame:04d}")


@FILES.add("one frame twice in a folder", "1.png", "01.png", "same number")
def _(folder: Path):
    replace_text(folder / "take.toml", "/{frame:06d}.png", "")
    shutil.copy(mask(folder, "cam_02", 1), folder / "masks/cam_02/1.png")


@FILES.add("footage without frames in common", "no frame", "cam_02")
def _(folder: Path):
    replace_text(folder / "take.toml", "frames = [0, 3]\n", "")
    for frame in range(4):
        mask(folder, "cam_02", frame).rename(mask(folder, "cam_02", frame + 100))


@FILES.add("videos shorter than frames", "cam_01.mp4, camera cam_01, frame 4: ends after 4 frames")
def _(folder: Path):
    videos(folder)
    replace_text(folder / "take.toml", "[0, 3]", "[0, 9]")


@FILES.add("a video cut short", "cam_02.mp4, camera cam_02: is no video", "cut short")
def _(folder: Path):
    videos(folder)
    path = folder / "cam_02.mp4"
    path.write_bytes(path.read_bytes()[:-300])


@FILES.add("a video that breaks off", "cam_02.avi, camera cam_02", "frame")
def _(folder: Path):
    videos(folder, 30)
    for camera in CAMERAS:
        _as_avi(folder / f"{camera}.mp4")
    replace_text(folder / "take.toml", "{camera}.mp4", "{camera}.avi")
    replace_text(folder / "take.toml", "[0, 3]", "[0, 29]")
    path = folder / "cam_02.avi"
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _as_avi(path: Path) -> None:
    video = cv2.VideoCapture(str(path))
    code = cv2.VideoWriter.fourcc(*"MJPG")
    avi = cv2.VideoWriter(str(path.with_suffix(".avi")), code, 15.0, (160, 120))
    while (read := video.read())[0]:
        avi.write(read[1])
    avi.release()


@FILES.add("a video without frames", "cam_02.avi, camera cam_02", "no frame")
def _(folder: Path):
    videos(folder)
    for camera in CAMERAS:
        _as_avi(folder / f"{camera}.mp4")
    replace_text(folder / "take.toml", "{camera}.mp4", "{camera}.avi")
    cv2.VideoWriter(
        str(folder / "cam_02.avi"), cv2.VideoWriter.fourcc(*"MJPG"), 15.0, (160, 120)
    ).release()


@FILES.add("a text called video", "cam_02.mp4, camera cam_02: is no video")
def _(folder: Path):
    videos(folder)
    (folder / "cam_02.mp4").write_text("no video\n", "utf-8")


@FILES.add("an empty file for a video", "cam_02.mp4, camera cam_02: is no video")
def _(folder: Path):
    videos(folder)
    (folder / "cam_02.mp4").write_bytes(b"")


@FILES.add("a mask cut short", "masks/cam_02/000000.png, camera cam_02, frame 0", "cut short")
def _(folder: Path):
    path = mask(folder, "cam_02", 0)
    path.write_bytes(path.read_bytes()[:-20])


@FILES.add("a mask of zero bytes", "masks/cam_02/000001.png, camera cam_02, frame 1", "empty file")
def _(folder: Path):
    mask(folder, "cam_02", 1).write_bytes(b"")


@FILES.add("a mask damaged inside", "masks/cam_02/000000.png, camera cam_02, frame 0", "decoded")
def _(folder: Path):
    path = mask(folder, "cam_02", 0)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 255
    path.write_bytes(data)


@FILES.add("a text called mask", "masks/cam_02/000001.png, camera cam_02, frame 1", "no picture")
def _(folder: Path):
    mask(folder, "cam_02", 1).write_text("no picture\n", "utf-8")


@FILES.add("a folder called mask", "masks/cam_02/000001.png, camera cam_02, frame 1")
def _(folder: Path):
    mask(folder, "cam_02", 1).unlink()
    mask(folder, "cam_02", 1).mkdir()


@FILES.add(
    "a mask that may not be read",
    "masks/cam_02/000001.png, camera cam_02, frame 1",
    "Permission denied",
    within=bound_by_permissions,
    unless=ON_LINUX,
)
def _(folder: Path):
    mask(folder, "cam_02", 1).chmod(0)


@FILES.add(
    "masks in a folder that may not be read",
    "masks/cam_02",
    "camera cam_02",
    "Permission denied",
    within=bound_by_permissions,
    unless=ON_LINUX,
)
def _(folder: Path):
    (folder / "masks/cam_02").chmod(0)


@FILES.add("a mask cut short in the middle of a fit", "camera cam_02, frame 2", "cut short")
def _(folder: Path):
    path = mask(folder, "cam_02", 2)
    path.write_bytes(path.read_bytes()[:-20])


@FILES.add("a single picture as footage", "camera cam_01: is a single picture", "{frame:06d}")
def _(folder: Path):
    replace_text(folder / "take.toml", "{frame:06d}", "000000")


@MASKS.add(
    "a mask of a wrong size",
    "masks/cam_02/000001.png, camera cam_02, frame 1",
    "80 x 60",
    "160 x 120",
)
def _(folder: Path):
    painted(mask(folder, "cam_02", 1), lambda picture: picture[::2, ::2])


@MASKS.add(
    "the first mask of a wrong size", "masks/cam_02/00000", "camera cam_02", "80 x 60", "160 x 120"
)
def _(folder: Path):
    painted(mask(folder, "cam_02", 0), lambda picture: picture[::2, ::2])


@MASKS.add("a mask that is a pipe", "000000.png, camera cam_02, frame 0: is no", unless=ON_UNIX)
def _(folder: Path):
    path = mask(folder, "cam_02", 0)
    path.unlink()
    os.mkfifo(path)


@MASKS.add("an ignore mask of a wrong size", "ignore.png, camera cam_01", "80 x 60", "160 x 120")
def _(folder: Path):
    cv2.imwrite(str(folder / "ignore.png"), np.zeros((60, 80), np.uint8))
    replace_text(folder / "take.toml", "[performer]", 'ignore = "ignore.png"\n[performer]')


@MASKS.add("an ignore mask over everything", "ignore.png, camera cam_01", "everything")
def _(folder: Path):
    cv2.imwrite(str(folder / "ignore.png"), np.full((120, 160), 255, np.uint8))
    replace_text(folder / "take.toml", "[performer]", 'ignore = "ignore.png"\n[performer]')


@MASKS.add("nobody in any view of the initial pose", "no camera sees", "in frame 0", "initial_pose")
def _(folder: Path):
    for camera in CAMERAS:
        for frame in (0, 1):
            painted(mask(folder, camera, frame), np.zeros_like)


@MASKS.add("the performer in one view of the initial pose", "only camera cam_01", "initial_pose")
def _(folder: Path):
    for camera in CAMERAS[1:]:
        for frame in (0, 1):
            painted(mask(folder, camera, frame), np.zeros_like)


@MASKS.add(
    "no initial pose, and nobody whole in any frame",
    "fewer than two cameras",
    "initial_pose = {",
    early=False,
)
def _(folder: Path):
    replace_text(folder / "take.toml", 'initial_pose = { frames = [0, 1], kind = "A" }', "")
    for camera in CAMERAS:
        for frame in range(4):
            painted(mask(folder, camera, frame), down_to_the_edge)


@MASKS.add(
    "a camera that never sees the performer", "masks/cam_04", "camera cam_04", "--without cam_04"
)
def _(folder: Path):
    for frame in range(4):
        painted(mask(folder, "cam_04", frame), np.zeros_like)


@MASKS.add("an all-white mask", "masks/cam_02/000001.png, camera cam_02, frame 1", "white")
def _(folder: Path):
    painted(mask(folder, "cam_02", 1), lambda picture: np.full_like(picture, 255))


@MASKS.add("an all-white mask later on", "masks/cam_02/000002.png, camera cam_02, frame 2", "white")
def _(folder: Path):
    painted(mask(folder, "cam_02", 2), lambda picture: np.full_like(picture, 255))


@MASKS.add(
    "an all-white frame of a silhouette video", "cam_02.mp4, camera cam_02, frame 0", "white"
)
def _(folder: Path):
    painted(mask(folder, "cam_02", 0), lambda picture: np.full_like(picture, 255))
    videos(folder)


@MASKS.add("inverted masks", "masks/cam_02/000000.png, camera cam_02, frame 0", "inverted")
def _(folder: Path):
    for frame in range(4):
        painted(mask(folder, "cam_02", frame), lambda picture: 255 - picture)


@MASKS.add("numbers that are none in a mask", "cam_02/000001.tif, camera cam_02, frame 1", "finite")
def _(folder: Path):
    for camera in CAMERAS:
        for frame, picture in enumerate(masks(folder, camera)):
            values = picture.astype(np.float32) / 255
            if (camera, frame) == ("cam_02", 1):
                values[3, 4] = np.nan
            cv2.imwrite(str(mask(folder, camera, frame).with_suffix(".tif")), values)
    replace_text(folder / "take.toml", "{frame:06d}.png", "{frame:06d}.tif")


@MASKS.add(
    "footage that a plate does not fit", "plates/cam_01.png, camera cam_01", "80 x 60", "160 x 120"
)
def _(folder: Path):
    (folder / "plates").mkdir()
    for camera in CAMERAS:
        cv2.imwrite(str(folder / f"plates/{camera}.png"), np.zeros((60, 80), np.uint8))
    replace_text(folder / "take.toml", "silhouettes =", 'plate = "plates/{camera}.png"\nvideo =')


@MASKS.add(
    "a plate of another scene", "masks/cam_01/000000.png, camera cam_01, frame 0", "from the plate"
)
def _(folder: Path):
    (folder / "plates").mkdir()
    for camera in CAMERAS:
        cv2.imwrite(str(folder / f"plates/{camera}.png"), np.full((120, 160, 3), 200, np.uint8))
    replace_text(
        folder / "take.toml",
        "silhouettes =",
        'plate = "plates/{camera}.png"\nextraction = "difference"\nvideo =',
    )
    replace_text(
        folder / "take.toml", "[performer]", "[footage.difference]\ndrift = false\n[performer]"
    )


@MASKS.add("no plate beside the footage", "plates/cam_01.png, camera cam_01", "empty scene")
def _(folder: Path):
    replace_text(folder / "take.toml", "silhouettes =", 'plate = "plates/{camera}.png"\nvideo =')
    return fit_words(folder)
