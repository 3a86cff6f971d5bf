"""Facts about cameras, by hand."""

from types import SimpleNamespace

import numpy as np
import pytest
from silhouette_mocap.core.cameras.calibration import Calibration
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.cameras.presets import look_at
from silhouette_mocap.core.checking.camera_facts import Performer, camera_facts, units_in_words
from silhouette_mocap.core.take.reduction import Reduction

MATRIX = np.array([[500.0, 0, 319.5], [0, 500.0, 239.5], [0, 0, 1]])
# 3 m along x and 4 m along y from the performer, 1.5 m above the floor at -0.5 m
CAMERA = Camera("a", (640, 480), MATRIX, look_at(np.array([3.0, 4, 1]), np.array([0, 0, 1.0])))
PERFORMER = Performer(np.array([0.0, 0.0, 1.0]), 1.8)


def view_of(camera, factor=1):
    reduction = Reduction(factor)
    return SimpleNamespace(
        undistortion=SimpleNamespace(source=camera, camera=camera),
        reduction=reduction,
        camera=reduction.camera(camera),
    )


def test_height_distance_and_scale_of_a_known_camera():
    facts = camera_facts(view_of(CAMERA, 2), PERFORMER, floor=-0.5)
    assert facts.height_m == pytest.approx(1.5)
    assert facts.distance_m == pytest.approx(5.0)
    assert facts.mm_per_px == pytest.approx(1000 * 5 / 500)
    assert (facts.working_size, facts.reduced_by) == ((320, 240), 2)
    assert facts.across_deg == pytest.approx(2 * np.degrees(np.arctan(320 / 500)))
    assert facts.lens == "pinhole"


def test_a_camera_that_looks_away_has_a_distance_but_no_scale():
    away = Camera("a", (640, 480), MATRIX, look_at(np.array([3.0, 4, 1]), np.array([6.0, 8, 1])))
    facts = camera_facts(view_of(away), PERFORMER, floor=0.0)
    assert facts.distance_m == pytest.approx(5.0) and np.isnan(facts.mm_per_px)


def test_without_a_performer_only_the_height_is_known():
    facts = camera_facts(view_of(CAMERA), None, floor=0.0)
    assert np.isnan([facts.distance_m, facts.mm_per_px]).all() and facts.height_m == 1.0


@pytest.mark.parametrize(
    ("distortion", "fisheye", "lens"),
    [((0.1, 0, 0, 0), False, "distorted"), ((0.1, 0, 0, 0), True, "fisheye")],
)
def test_lenses(distortion, fisheye, lens):
    camera = Camera(
        "a", (640, 480), MATRIX, CAMERA.camera_from_world, np.array(distortion), fisheye
    )
    assert camera_facts(view_of(camera), None, 0.0).lens == lens


@pytest.mark.parametrize(
    ("units", "guessed", "wanted", "words"),
    [
        ("mm", False, None, "millimetres, as Qualisys files have"),
        ("cm", False, "cm", "centimetres, as the take says"),
        ("m", True, None, "metres, guessed: the cameras are then up to 5.0 m apart"),
    ],
)
def test_units_in_words(units, guessed, wanted, words):
    other = Camera("b", (640, 480), MATRIX, look_at(np.array([0, 0, 1.0]), np.array([1, 0, 1.0])))
    calibration = Calibration((CAMERA, other), "Qualisys", units, guessed, ())
    assert units_in_words(calibration, wanted) == words
