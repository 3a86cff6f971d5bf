import bpy
import cv2
import numpy as np
import pytest
from bl_ext.user_default.silhouette_mocap.addon.bridge.cameras import add_camera
from bl_ext.user_default.silhouette_mocap.addon.bridge.footage import show_footage
from bl_ext.user_default.silhouette_mocap.addon.bridge.space import add_capture_space
from bl_ext.user_default.silhouette_mocap.core.cameras.camera import Camera
from bl_ext.user_default.silhouette_mocap.core.errors import MocapError

FRAMES = np.arange(5, 9)


@pytest.fixture
def camera():
    collection = bpy.context.scene.collection
    pinhole = Camera("cam01", (64, 48), [[50, 0, 32], [0, 50, 24], [0, 0, 1]], np.eye(4)[:3])
    return add_camera(pinhole, add_capture_space(collection), collection)


def shown_path(camera):
    """The file behind the camera at the scene's present frame."""
    background = camera.data.background_images[0]
    return background.image.filepath_from_user(image_user=background.image_user)


def shown_brightness(camera):
    """The sRGB brightness, 0 to 255, of the picture behind the camera, as Blender decodes it."""
    background = camera.data.background_images[0]
    texture = bpy.data.textures.new("probe", "IMAGE")
    texture.image = background.image
    texture.image_user.frame_duration = 1000
    texture.image_user.frame_current = background.image_user.frame_current
    linear = texture.evaluate((0, 0, 0))[0]
    return 255 * (1.055 * linear ** (1 / 2.4) - 0.055)


def test_a_picture_sequence_shows_the_file_with_the_number_of_the_frame(camera, tmp_path):
    for frame in range(4, 10):
        cv2.imwrite(str(tmp_path / f"{frame:06d}.png"), np.full((48, 64), frame, np.uint8))
    show_footage(camera, str(tmp_path / "{frame:06d}.png"), FRAMES)
    for frame in FRAMES:
        bpy.context.scene.frame_set(int(frame))
        assert shown_path(camera) == str(tmp_path / f"{frame:06d}.png")


def test_a_folder_may_have_braces_in_its_name(camera, tmp_path):
    folder = tmp_path / "br{raw}"
    folder.mkdir()
    cv2.imwrite(str(folder / "000005.png"), np.zeros((48, 64), np.uint8))
    show_footage(camera, str(folder / "{frame:06d}.png"), FRAMES)
    bpy.context.scene.frame_set(5)
    assert shown_path(camera) == str(folder / "000005.png")


def test_a_video_shows_the_picture_of_the_frame_counted_from_zero(camera, tmp_path):
    path = tmp_path / "cam01.mp4"
    video = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"mp4v"), 15, (64, 48))
    for frame in range(12):
        video.write(np.full((48, 64, 3), 20 * frame, np.uint8))
    video.release()
    show_footage(camera, str(path), FRAMES)
    for frame in FRAMES:
        bpy.context.scene.frame_set(int(frame))
        assert shown_brightness(camera) == pytest.approx(20 * frame, abs=6)


def test_footage_that_does_not_open_is_named_with_its_camera(camera, tmp_path):
    missing = tmp_path / "cam01.mp4"
    with pytest.raises(MocapError, match=r"cam01\.mp4, camera cam01: cannot be opened"):
        show_footage(camera, str(missing), FRAMES)
