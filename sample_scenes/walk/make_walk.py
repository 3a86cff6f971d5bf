"""Make the sample take ``walk``: cameras, masks, silhouette videos, footage, plates and truth.

    python sample_scenes/walk/make_walk.py                                  # the whole sample
    python sample_scenes/walk/make_walk.py --out DIR --frame 20 --camera cam_03    # one mask

It shares no code with the product: the performer, the motion and the renderer are its own.
"""

import argparse
from pathlib import Path

import cv2
import numpy as np
from walk_figure import make_performer
from walk_footage import Room, filmed
from walk_motion import FPS, FRAMES, POINTS, STILL_FRAMES, posed, truth_points
from walk_render import HEIGHT, WIDTH, Flesh, calibration_text, coverage, make_cameras, mask

FILMED = ("cam_01", "cam_03")
TAKE = """version = 1
name = "{name}"
fps = {fps}
frames = [0, {last}]
initial_pose = {{ frames = [0, {still}], kind = "A" }}

[cameras]
calibration = "{calibration}"

[footage]
{footage}

[performer]
body = "performer"

[world]
floor = 0.0

[export]
formats = ["blend", "fbx", "bvh", "trc"]
"""
TAKES = {
    "take.toml": ("walk", "calibration.toml", 'silhouettes = "masks/{camera}/{frame:06d}.png"'),
    "take_videos.toml": ("walk_videos", "calibration.toml", 'silhouettes = "videos/{camera}.mp4"'),
    "take_footage.toml": (
        "walk_footage",
        "calibration_footage.toml",
        'video = "footage/{camera}.mp4"\nplate = "plates/{camera}.png"\nextraction = "statistics"',
    ),
}


def write_mask(folder: Path, camera: str, frame: int, picture: np.ndarray) -> None:
    """Write one silhouette as a 1-bit PNG."""
    path = folder / "masks" / camera / f"{frame:06d}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(path), picture, [cv2.IMWRITE_PNG_BILEVEL, 1, cv2.IMWRITE_PNG_COMPRESSION, 9])


def open_video(path: Path) -> cv2.VideoWriter:
    """A writer of colour frames, MPEG-4 part 2, which every OpenCV decodes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    return cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), FPS, (WIDTH, HEIGHT))


def write_pictures(folder: Path) -> None:
    """Write masks, silhouette videos, footage and plates of all frames."""
    performer, cameras = make_performer(), make_cameras()
    rooms = {c.name: Room(c, seed) for seed, c in enumerate(cameras) if c.name in FILMED}
    videos = {c.name: open_video(folder / "videos" / f"{c.name}.mp4") for c in cameras}
    footage = {name: open_video(folder / "footage" / f"{name}.mp4") for name in rooms}
    for frame in range(FRAMES):
        flesh = Flesh(performer, frame)
        for index, camera in enumerate(cameras):
            seen = coverage(flesh, camera)
            picture = np.where(seen[0] >= 5, 255, 0).astype(np.uint8)
            write_mask(folder, camera.name, frame, picture)
            videos[camera.name].write(cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR))
            if camera.name in rooms:
                room = rooms[camera.name]
                footage[camera.name].write(filmed(flesh, camera, room, seen, (index, frame)))
    for video in (*videos.values(), *footage.values()):
        video.release()
    (folder / "plates").mkdir(exist_ok=True)
    for name, room in rooms.items():
        cv2.imwrite(str(folder / "plates" / f"{name}.png"), room.plate())


def write_descriptions(folder: Path) -> None:
    """Write calibration files, takes and the truth."""
    cameras = make_cameras()
    (folder / "calibration.toml").write_text(calibration_text(cameras))
    filmed_by = [camera for camera in cameras if camera.name in FILMED]
    (folder / "calibration_footage.toml").write_text(calibration_text(filmed_by))
    for file, (name, calibration, footage) in TAKES.items():
        numbers = {"fps": FPS, "last": FRAMES - 1, "still": STILL_FRAMES - 1}
        text = TAKE.format(name=name, calibration=calibration, footage=footage, **numbers)
        (folder / file).write_text(text)
    performer = make_performer()
    truth = [truth_points(*posed(performer, frame)) for frame in range(FRAMES)]
    np.savez_compressed(
        folder / "truth.npz",
        frames=np.arange(FRAMES),
        fps=np.float64(FPS),
        points=np.array([points for points, _ in truth], np.float32),
        point_names=np.array(list(POINTS)),
        point_rotations=np.array([rotations for _, rotations in truth], np.float32),
    )


def main() -> None:
    """Make the whole sample, or one mask of it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).parent, help="folder")
    parser.add_argument("--frame", type=int, help="with --camera: write only this mask")
    parser.add_argument("--camera", help="such as cam_03")
    options = parser.parse_args()
    if options.frame is None:
        write_descriptions(options.out)
        write_pictures(options.out)
        return
    camera = next(camera for camera in make_cameras() if camera.name == options.camera)
    picture = mask(Flesh(make_performer(), options.frame), camera)
    write_mask(options.out, options.camera, options.frame, picture)


if __name__ == "__main__":
    main()
