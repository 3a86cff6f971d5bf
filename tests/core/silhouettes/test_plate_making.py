import cv2
import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.footage.footage import open_footage
from silhouette_mocap.core.footage.pictures import write_picture
from silhouette_mocap.core.silhouettes.plate import Plate, read_plate, write_plate
from silhouette_mocap.core.silhouettes.plate_making import plate_from
from silhouette_mocap.core.silhouettes.plate_recipe import (
    Patch,
    PlateRecipe,
    read_plate_recipes,
)
from silhouette_mocap.core.silhouettes.registration import registered

SIZE = (240, 180)
SKIN = (90, 120, 190)


def _room(size=SIZE) -> np.ndarray:
    rng = np.random.default_rng(5)
    coarse = rng.uniform(60, 180, (size[1] // 12, size[0] // 12, 3)).astype(np.float32)
    return cv2.resize(coarse, size, interpolation=cv2.INTER_CUBIC)


def _footage(tmp_path, frames=20):
    """A performer who stays in the middle; his arm leaves to the right after half of the frames."""
    rng = np.random.default_rng(6)
    for frame in range(frames):
        picture = _room().copy()
        sway = frame % 3
        picture[40:150, 90 + sway : 120 + sway] = SKIN
        if frame < frames - 4:
            picture[60:80, 130:150] = SKIN
        picture += rng.normal(0, 1.5, picture.shape)
        write_picture(tmp_path / f"{frame}.png", np.clip(picture, 0, 255).astype(np.uint8))
    return open_footage(tmp_path / "{frame}.png", "left")


def _still(tmp_path, scale=1.0):
    picture = _room() * 0.9 + 6
    picture[100:170, 10:40] = SKIN
    picture = cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_LINEAR)
    path = tmp_path / "still.png"
    write_picture(path, np.clip(picture, 0, 255).astype(np.uint8))
    return path


def test_what_moves_on_is_no_part_of_the_plate(tmp_path):
    plate = plate_from(_footage(tmp_path), (0, 19), PlateRecipe())
    assert np.abs(plate.mean - _room())[:, 160:].max() < 3
    assert plate.spread[:, 160:].mean() == pytest.approx(1.5, abs=0.4)
    assert np.abs(plate.mean - SKIN)[60:140, 100:115].max() < 4


def test_a_still_shows_what_the_performer_hides_all_the_time(tmp_path):
    footage = _footage(tmp_path)
    recipe = PlateRecipe(still=_still(tmp_path), box=(80, 30, 160, 160))
    plate = plate_from(footage, (0, 19), recipe)
    assert np.abs(plate.mean - _room())[31:159, 81:125].mean() < 3
    assert np.abs(plate.mean - _room())[105:165, 12:38].max() < 3


def test_a_still_of_another_size_and_exposure_is_brought_onto_the_footage(tmp_path):
    footage = _footage(tmp_path)
    recipe = PlateRecipe(still=_still(tmp_path, 1.25), box=(80, 30, 160, 160))
    plate = plate_from(footage, (0, 19), recipe)
    assert np.abs(plate.mean - _room())[31:159, 81:125].mean() < 3


def test_where_the_still_shows_the_performer_it_is_not_asked(tmp_path):
    footage = _footage(tmp_path)
    recipe = PlateRecipe(still=_still(tmp_path), still_boxes=((5, 95, 45, 175),))
    plate = plate_from(footage, (0, 19), recipe)
    assert np.abs(plate.mean - _room())[100:170, 10:40].max() < 3


def test_a_patch_looks_only_at_the_frames_that_show_it_empty(tmp_path):
    footage = _footage(tmp_path)
    without = plate_from(footage, (0, 19), PlateRecipe())
    recipe = PlateRecipe(patches=(Patch((125, 50, 155, 90), (16, 19)),))
    plate = plate_from(footage, (0, 19), recipe)
    assert np.abs(without.mean - SKIN)[62:78, 132:148].mean() < 4
    assert np.abs(plate.mean - _room())[52:88, 127:153].max() < 4
    assert np.array_equal(plate.mean[:, 160:], without.mean[:, 160:])


def test_a_still_of_another_scene_is_refused(tmp_path):
    write_picture(tmp_path / "still.png", np.full((180, 240, 3), 90, np.uint8))
    with pytest.raises(MocapError, match=r"still\.png: does not show the same scene"):
        plate_from(_footage(tmp_path), (0, 19), PlateRecipe(still=tmp_path / "still.png"))


def test_a_registered_picture_lies_on_its_reference(tmp_path):
    room = np.clip(_room((480, 360)), 0, 255).astype(np.uint8)
    transform = np.array([[0.95, 0.0, 9.0], [0.0, 0.95, 4.0]])
    moved = cv2.warpAffine(room, transform, (480, 360), borderMode=cv2.BORDER_REPLICATE)
    back = registered(moved, room, tmp_path)
    assert np.abs(back.astype(int) - room)[20:-20, 20:-20].mean() < 1.5


def test_a_plate_comes_back_from_its_files(tmp_path):
    rng = np.random.default_rng(0)
    plate = Plate(rng.uniform(-3, 258, (20, 30, 3)), rng.uniform(0, 9, (20, 30, 3)))
    write_plate(tmp_path / "left.png", plate)
    read = read_plate(tmp_path / "{camera}.png", "left")
    assert read.size == (30, 20)
    assert np.abs(read.mean - np.clip(plate.mean, 0, 255)).max() <= 0.5
    assert np.abs(read.spread - plate.spread).max() <= 1 / 256


def test_recipes_are_read_with_paths_beside_their_file(tmp_path):
    (tmp_path / "plates.toml").write_text(
        '[left]\nstill = "a.png"\nbox = [1, 2, 3, 4]\nstill_boxes = [[0, 0, 5, 5]]\n'
        "patches = [{ box = [1, 1, 2, 2], frames = [3, 4] }]\n[right]\n"
    )
    recipes = read_plate_recipes(tmp_path / "plates.toml")
    assert recipes["left"] == PlateRecipe(
        tmp_path / "a.png", (1, 2, 3, 4), ((0, 0, 5, 5),), (Patch((1, 1, 2, 2), (3, 4)),)
    )
    assert recipes["right"] == PlateRecipe()


@pytest.mark.parametrize(
    "text",
    [
        "[left]\nbax = [1, 2, 3, 4]",
        "[left]\nbox = [3, 2, 1, 4]",
        "[left]\nbox = [1, 2, 3]",
        "[left]\nstill = 5",
        "[left]\npatches = [{ box = [1, 1, 2, 2] }]",
        "[left]\npatches = [{ box = [1, 1, 2, 2], frames = [4, 3] }]",
        "left = 5",
    ],
)
def test_a_faulty_recipe_names_file_and_camera(tmp_path, text):
    (tmp_path / "plates.toml").write_text(text)
    with pytest.raises(MocapError, match=r"plates\.toml, camera left: "):
        read_plate_recipes(tmp_path / "plates.toml")
