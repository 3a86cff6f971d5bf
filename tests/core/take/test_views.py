"""Calibration and footage brought together, and what is said where they do not fit."""

import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.silhouettes.plate_recipe import PlateRecipe
from silhouette_mocap.core.take import read_take
from silhouette_mocap.core.take.extraction import make_plate, write_take_masks
from silhouette_mocap.core.take.views import open_views


@pytest.fixture
def folder(small_take, tmp_path) -> Path:
    return shutil.copytree(small_take.parent, tmp_path / "session" / "small")


def changed(folder: Path, *changes: tuple[str, str]):
    path = folder / "take.toml"
    text = path.read_text("utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, "utf-8")
    return read_take(path)


def footage_take(folder: Path, *changes: tuple[str, str]):
    """The take with grey footage over a textured scene instead of masks."""
    noise = np.random.default_rng(0).integers(40, 120, (120, 160, 3)).astype(np.uint8)
    for path in sorted(folder.glob("masks/*/*.png")):
        mask = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) > 0
        picture = np.where(mask[..., None], np.uint8(230), noise)
        place = folder / "video" / path.parent.name / path.name
        place.parent.mkdir(parents=True, exist_ok=True)
        cv2.imwrite(str(place), picture)
        cv2.imwrite(str(folder / f"{path.parent.name}_plate.png"), noise)
    return changed(
        folder,
        (
            'silhouettes = "masks/{camera}/{frame:06d}.png"',
            'video = "video/{camera}/{frame:06d}.png"\nplate = "{camera}_plate.png"\n'
            'extraction = "difference"',
        ),
        *changes,
    )


def test_all_views_of_a_take_are_opened(folder):
    views = open_views(read_take(folder / "take.toml"))
    assert [camera.name for camera in views.cameras] == [f"cam_0{i}" for i in range(1, 6)]
    assert views.frames == (0, 3)
    mask = cv2.imread(str(folder / "masks/cam_02/000003.png"), cv2.IMREAD_GRAYSCALE) > 0
    np.testing.assert_array_equal(views.silhouettes(3)[1].foreground, mask)


def test_a_camera_can_be_left_out_and_frames_narrowed(folder):
    views = open_views(read_take(folder / "take.toml"), ["cam_03"], (1, None))
    assert "cam_03" not in [camera.name for camera in views.cameras]
    assert views.frames == (1, 3)


def test_only_the_frames_that_are_wanted_must_be_there(folder):
    (folder / "masks/cam_04/000002.png").unlink()
    assert open_views(read_take(folder / "take.toml"), (), (0, 1)).frames == (0, 1)
    with pytest.raises(MocapError, match="camera cam_04, frame 2: missing"):
        open_views(read_take(folder / "take.toml"))


def test_one_place_for_the_pictures_of_all_cameras_is_refused(folder):
    take = footage_take(folder, ('plate = "{camera}_plate.png"', 'plate = "cam_01_plate.png"'))
    with pytest.raises(MocapError, match=r'"footage\.plate" gives all cameras the same pictures'):
        open_views(take)
    take = changed(folder, ("video/{camera}/", "video/cam_01/"))
    with pytest.raises(MocapError, match=r'"footage\.video" .* write \{camera\} where'):
        open_views(take)


def test_without_frames_in_the_take_all_footage_counts(folder):
    (folder / "masks/cam_04/000003.png").unlink()
    take = changed(folder, ("frames = [0, 3]\n", ""))
    assert open_views(take).frames == (0, 2)


@pytest.mark.parametrize(
    ("without", "frames", "line"),
    [
        (["cam_9"], (None, None), 'no camera "cam_9"; the cameras are cam_01'),
        (["cam_01", "cam_02", "cam_03", "cam_04"], (None, None), "1 camera left; use at least 2"),
        ([], (2, 1), "first frame wanted, 2, comes after the last, 1; swap them"),
        ([], (4, None), "frames 4 to 3 lie outside the take's, 0 to 3"),
        ([], (None, 4), "frames 0 to 4 lie outside the take's, 0 to 3"),
    ],
)
def test_wishes_that_cannot_be_met_are_one_line(folder, without, frames, line):
    with pytest.raises(MocapError, match=line):
        open_views(read_take(folder / "take.toml"), without, frames)


def test_adjusted_footage_moves_the_camera_and_hides_what_was_never_filmed(folder):
    shift = "adjust = { cam_01 = { scale = 1.0, shift = [0.0, 7.0] } }"
    take = changed(folder, ('units = "m"', f'units = "m"\n{shift}'))
    plain, moved = open_views(read_take(folder / "take.toml")), open_views(take)
    point = np.array([0.1, 0.2, 1.0])
    np.testing.assert_allclose(
        moved.cameras[0].project(point) - open_views_of_original(folder).cameras[0].project(point),
        [0, 7],
        atol=1e-9,
    )
    assert not moved.silhouettes(0)[0].observed[:7].any()
    assert moved.silhouettes(0)[0].observed[7:].all()
    assert plain.frames == moved.frames


def open_views_of_original(folder: Path):
    return open_views(changed(folder, ("shift = [0.0, 7.0]", "shift = [0.0, 0.0]")))


def test_an_ignore_mask_hides_its_pixels_and_must_fit(folder):
    take = changed(folder, ("[performer]", 'ignore = "ignore.png"\n[performer]'))
    hidden = np.zeros((120, 160), np.uint8)
    hidden[:, :40] = 255
    cv2.imwrite(str(folder / "ignore.png"), hidden)
    observed = open_views(take).silhouettes(0)[0].observed
    assert not observed[:, :40].any() and observed[:, 40:].all()
    cv2.imwrite(str(folder / "ignore.png"), hidden[:60])
    with pytest.raises(MocapError, match=r"camera cam_01: is 160 x 60 px, the footage 160 x 120"):
        open_views(take)


def test_footage_and_plate_give_the_same_silhouettes_as_masks(folder):
    ready = open_views(read_take(folder / "take.toml")).silhouettes(2)
    extracted = open_views(footage_take(folder)).silhouettes(2)
    for mask, found in zip(ready, extracted, strict=True):
        assert np.count_nonzero(mask.foreground ^ found.foreground) < 10


def test_settings_of_the_extraction_are_checked(folder):
    take = footage_take(folder, ("[performer]", "[footage.difference]\ntreshold = 3\n[performer]"))
    with pytest.raises(MocapError, match=r'in \[footage.difference\]; did you mean "threshold'):
        open_views(take)
    take = changed(folder, ("treshold = 3", 'threshold = "3"'))
    with pytest.raises(MocapError, match=r'expected a number for "footage\.difference\.threshold"'):
        open_views(take)
    take = changed(folder, ('threshold = "3"', "threshold = 300\ndrift = false"))
    assert not open_views(take).silhouettes(0)[0].foreground.any()


def test_a_plate_that_is_missing_or_of_another_size_is_one_line(folder):
    take = footage_take(folder)
    cv2.imwrite(str(folder / "cam_02_plate.png"), np.zeros((60, 80, 3), np.uint8))
    with pytest.raises(MocapError, match="cam_02: the plate is 80 x 60 px, the footage 160 x 120"):
        open_views(take)
    take = changed(folder, ('plate = "{camera}_plate.png"\n', ""))
    with pytest.raises(MocapError, match=r'"footage\.plate" is missing'):
        open_views(take)


def test_masks_and_plates_are_written_where_they_are_found_again(folder):
    take = footage_take(folder)
    path = make_plate(take, "cam_01", PlateRecipe(), (None, None))
    assert path == folder / "cam_01_plate.png"
    qualities = write_take_masks(open_views(take), folder / "made", Silence())
    assert [(q.frames, q.empty) for q in qualities.values()] == [(4, 0)] * 5
    take = changed(folder, ('extraction = "difference"', ""), ('plate = "{camera}_plate.png"', ""),
                   ('video = "video/', 'silhouettes = "made/'))  # fmt: skip
    assert open_views(take).silhouettes(1)[2].foreground.any()
