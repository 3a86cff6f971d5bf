import subprocess
import sys
import tomllib
from pathlib import Path

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.body.body import POINT_NAMES

WALK = Path(__file__).parents[3] / "sample_scenes" / "walk"
FRAMES = 60
CAMERAS = tuple(f"cam_{index:02d}" for index in range(1, 9))
SIDES = ("left", "right")
FILMED = ("cam_01", "cam_03")
# joints that lie deep in the flesh: wrists, elbows and ankles are left out, where a pixel matters
DEEP = ("head", *(f"{side}_{name}" for side in SIDES for name in ("shoulder", "hip", "knee")))
BONES = (("shoulder", "elbow"), ("elbow", "wrist"), ("hip", "knee"), ("knee", "ankle"))


def read_mask(camera: str, frame: int) -> np.ndarray:
    return cv2.imread(str(WALK / "masks" / camera / f"{frame:06d}.png"), cv2.IMREAD_GRAYSCALE)


def read_video(path: Path) -> list[np.ndarray]:
    video, pictures = cv2.VideoCapture(str(path)), []
    while True:
        found, picture = video.read()
        if not found:
            return pictures
        pictures.append(picture)


@pytest.fixture(scope="module")
def truth() -> dict[str, np.ndarray]:
    with np.load(WALK / "truth.npz", allow_pickle=False) as data:
        return dict(data)


def calibration(name: str = "calibration.toml") -> dict[str, dict]:
    table = tomllib.loads((WALK / name).read_text())
    return {key: value for key, value in table.items() if key != "metadata"}


def test_every_camera_has_sixty_masks_of_one_bit_that_hold_the_whole_performer():
    assert sorted(path.name for path in (WALK / "masks").iterdir()) == list(CAMERAS)
    for camera in CAMERAS:
        files = sorted((WALK / "masks" / camera).iterdir())
        assert [file.name for file in files] == [f"{frame:06d}.png" for frame in range(FRAMES)]
        for frame, file in enumerate(files):
            assert file.read_bytes()[24] == 1, "bit depth in the PNG header"
            mask = read_mask(camera, frame)
            assert mask.shape == (240, 320)
            assert set(np.unique(mask)) == {0, 255}
            rim = np.concatenate([mask[0], mask[-1], mask[:, 0], mask[:, -1]])
            assert not rim.any(), f"{camera} frame {frame} touches the rim"


@pytest.mark.parametrize("name", ["take.toml", "take_videos.toml", "take_footage.toml"])
def test_every_take_names_files_that_are_there(name):
    take = tomllib.loads((WALK / name).read_text())
    assert (take["version"], take["fps"], take["frames"]) == (1, 15.0, [0, FRAMES - 1])
    assert take["initial_pose"] == {"frames": [0, 7], "kind": "A"}
    footage = take["footage"]
    cameras = calibration(take["cameras"]["calibration"])
    assert tuple(cameras) == (FILMED if "video" in footage else CAMERAS)
    for camera in cameras:
        for key in set(footage) - {"extraction"}:
            assert (WALK / footage[key].format(camera=camera, frame=FRAMES - 1)).is_file()


def test_the_two_filmed_cameras_are_calibrated_alike_in_both_files():
    every = calibration()
    assert calibration("calibration_footage.toml") == {name: every[name] for name in FILMED}


def test_the_truth_has_the_fourteen_points_and_a_rotation_for_each(truth):
    assert tuple(truth["point_names"]) == POINT_NAMES
    assert truth["points"].shape == (FRAMES, 14, 3)
    assert truth["frames"].tolist() == list(range(FRAMES))
    assert float(truth["fps"]) == 15.0
    rotations = truth["point_rotations"].astype(float)
    assert rotations.shape == (FRAMES, 14, 3, 3)
    assert np.allclose(rotations @ rotations.swapaxes(2, 3), np.eye(3), atol=1e-5)
    assert np.allclose(np.linalg.det(rotations), 1.0, atol=1e-5)


def test_the_bones_of_the_truth_keep_their_lengths_and_both_sides_are_alike(truth):
    place = dict(zip(POINT_NAMES, truth["points"].astype(float).swapaxes(0, 1), strict=True))
    for start, end in BONES:
        lengths = [
            np.linalg.norm(place[f"{side}_{start}"] - place[f"{side}_{end}"], axis=1)
            for side in SIDES
        ]
        assert np.ptp(lengths) < 1e-5


def test_the_performer_stands_still_at_first_and_looks_along_minus_y(truth):
    points = truth["points"]
    assert np.abs(points[:8] - points[0]).max() == 0.0
    assert np.abs(points[12] - points[0]).max() > 0.05
    left, right = (POINT_NAMES.index(f"{side}_wrist") for side in SIDES)
    assert points[0, left, 0] - points[0, right, 0] > 0.8
    assert points[30, POINT_NAMES.index("head"), 1] < points[0, POINT_NAMES.index("head"), 1] - 0.5


def test_joints_deep_in_the_flesh_are_seen_inside_every_silhouette(truth):
    rows = [POINT_NAMES.index(name) for name in DEEP]
    for name, camera in calibration().items():
        rotation, translation, matrix = (
            np.array(camera[key]) for key in ("rotation", "translation", "matrix")
        )
        for frame in range(FRAMES):
            points = truth["points"][frame, rows].astype(float)
            pixels, _ = cv2.projectPoints(points, rotation, translation, matrix, None)
            columns, lines = np.rint(pixels[:, 0]).astype(int).T
            outside = read_mask(name, frame)[lines, columns] == 0
            assert not outside.any(), (name, frame, np.array(DEEP)[outside])


@pytest.mark.parametrize("camera", CAMERAS)
def test_a_silhouette_video_shows_the_masks_frame_for_frame(camera):
    pictures = read_video(WALK / "videos" / f"{camera}.mp4")
    assert len(pictures) == FRAMES
    for frame, picture in enumerate(pictures):
        seen, mask = picture[..., 0] >= 128, read_mask(camera, frame) > 0
        assert (seen & mask).sum() / (seen | mask).sum() > 0.98


@pytest.mark.parametrize("camera", FILMED)
def test_the_footage_differs_from_the_plate_where_the_performer_is(camera):
    plate = cv2.imread(str(WALK / "plates" / f"{camera}.png")).astype(float)
    pictures = read_video(WALK / "footage" / f"{camera}.mp4")
    assert len(pictures) == FRAMES
    for frame, picture in enumerate(pictures):
        change = np.abs(picture - plate).sum(2)
        inside = read_mask(camera, frame) > 0
        assert np.median(change[inside]) > 100
        # sensor noise and compression: the mean of three channels stays near the noise's spread
        assert np.median(change[~inside]) < 12


def test_the_script_makes_a_committed_mask_again_bit_for_bit(tmp_path):
    command = [sys.executable, str(WALK / "make_walk.py"), "--out", str(tmp_path)]
    subprocess.run([*command, "--frame", "29", "--camera", "cam_06"], check=True)
    again = cv2.imread(str(tmp_path / "masks" / "cam_06" / "000029.png"), cv2.IMREAD_GRAYSCALE)
    assert np.array_equal(again, read_mask("cam_06", 29))


def test_the_sample_is_smaller_than_three_megabytes():
    files = [path for path in WALK.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
    assert sum(path.stat().st_size for path in files) < 3_000_000
