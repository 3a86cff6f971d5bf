import numpy as np
import pytest
from silhouette_mocap.core.silhouettes.difference import Difference, DifferenceSettings
from silhouette_mocap.core.silhouettes.drift import drift_between
from silhouette_mocap.core.silhouettes.own_colours import bridged, own_colours
from silhouette_mocap.core.silhouettes.plate import Plate, plate_from_empty
from silhouette_mocap.core.silhouettes.statistics import (
    Statistics,
    StatisticsSettings,
    hue_angles,
    vector_angles,
)

GROUND = (90, 120, 150)  # BGR, a warm grey
NOISE = 2.0


def _scene() -> np.ndarray:
    scene = np.full((120, 160, 3), GROUND, float)
    scene[:, 80:] = (150, 110, 80)
    scene[90:] *= 0.8
    return scene


def _filmed(scene: np.ndarray, seed: int) -> np.ndarray:
    noise = np.random.default_rng(seed).normal(0, NOISE, scene.shape)
    return np.clip(np.round(scene + noise), 0, 255).astype(np.uint8)


def _plate() -> Plate:
    return plate_from_empty(_filmed(_scene(), seed) for seed in range(20))


def _iou(a: np.ndarray, b: np.ndarray) -> float:
    return (a & b).sum() / (a | b).sum()


def _with_performer(colour=(60, 200, 60)) -> tuple[np.ndarray, np.ndarray]:
    scene, mask = _scene(), np.zeros((120, 160), bool)
    mask[30:100, 40:70] = True
    scene[mask] = colour
    return scene, mask


@pytest.mark.parametrize("method", [Difference, Statistics])
def test_a_performer_of_another_colour_is_found(method):
    scene, mask = _with_performer()
    assert _iou(method(_plate()).foreground(_filmed(scene, 99)), mask) > 0.99


@pytest.mark.parametrize("method", [Difference, Statistics])
def test_the_empty_scene_has_no_foreground(method):
    assert method(_plate()).foreground(_filmed(_scene(), 99)).mean() < 1e-3


def test_a_shadow_is_no_foreground_but_an_equally_dark_patch_of_another_hue_is():
    scene = _scene()
    scene[30:60, 20:50] *= 0.75
    scene[62:88, 20:50] = scene[30, 20][[2, 1, 0]]
    mask = Statistics(_plate()).foreground(_filmed(scene, 99))
    assert not mask[30:60, 20:50].any()
    assert mask[64:86, 22:48].all()
    assert Difference(_plate()).foreground(_filmed(scene, 99))[32:58, 22:48].mean() > 0.9


def test_black_clothes_are_too_dark_for_a_shadow():
    scene, mask = _with_performer(np.array(GROUND) * 0.25)
    assert _iou(Statistics(_plate()).foreground(_filmed(scene, 99)), mask) > 0.99


@pytest.mark.parametrize("method", [Difference, Statistics])
def test_a_change_of_exposure_and_white_balance_is_compensated(method):
    scene, mask = _with_performer()
    scene = scene * (1.15, 1.1, 1.05) + (8, 4, -3)
    assert _iou(method(_plate()).foreground(_filmed(scene, 99)), mask) > 0.98


def test_without_compensation_the_same_change_is_taken_for_foreground():
    picture = _filmed(_scene() * 1.15 + 8, 99)
    assert Difference(_plate(), DifferenceSettings(drift=False)).foreground(picture).mean() > 0.5


def test_drift_is_recovered_beside_a_large_performer():
    rng = np.random.default_rng(3)
    plate = rng.uniform(20, 200, (4000, 3))
    picture = plate * (1.1, 0.9, 1.0) + (5, -4, 0) + rng.normal(0, NOISE, plate.shape)
    picture[:1200] = 230
    drift = drift_between(plate, picture)
    assert drift.gain == pytest.approx([1.1, 0.9, 1.0], abs=0.02)
    assert drift.offset == pytest.approx([5, -4, 0], abs=2)
    # three pixels in ten are the performer: the median deviation takes the noise for 1.5 times it
    assert (drift.noise > 0.9 * NOISE).all()
    assert (drift.noise < 1.7 * NOISE).all()


def test_one_still_is_enough_for_a_plate():
    scene, mask = _with_performer()
    plate = plate_from_empty([_filmed(_scene(), 0)])
    assert not plate.spread.any()
    assert _iou(Statistics(plate).foreground(_filmed(scene, 99)), mask) > 0.98


def test_mean_and_spread_of_a_plate_are_those_of_its_pictures():
    pictures = [_filmed(_scene(), seed) for seed in range(6)]
    plate = plate_from_empty(iter(pictures))
    assert plate.mean == pytest.approx(np.mean(pictures, axis=0), abs=1e-3)
    assert plate.spread == pytest.approx(np.std(pictures, axis=0, ddof=1), abs=1e-3)


def test_the_loop_of_an_arm_on_the_hip_survives_extraction():
    scene, mask = _with_performer()
    ground = _scene()
    mask[50:62, 52:62] = False
    scene[~mask] = ground[~mask]
    assert _iou(Statistics(_plate()).foreground(_filmed(scene, 99)), mask) > 0.98


def test_angles_between_colours_follow_their_definitions():
    a, b = np.array([[0.0, 0.0, 200.0]]), np.array([[0.0, 100.0, 0.0]])
    assert np.degrees(hue_angles(a, b)) == pytest.approx([120])
    assert np.degrees(vector_angles(a, b)) == pytest.approx([90])
    assert vector_angles(a, a / 3) == pytest.approx([0], abs=1e-6)
    assert hue_angles(b, b / 2) == pytest.approx([0], abs=1e-6)


def test_a_gap_of_the_performers_own_colour_is_bridged_and_other_gaps_are_not():
    colours = np.full((60, 60, 3), 200.0)
    mask = np.zeros((60, 60), bool)
    mask[10:50, 20:40] = True
    colours[mask] = 20
    gap = mask.copy()
    gap[20:30, 20:30] = False
    own = own_colours(colours, gap)
    assert np.array_equal(bridged(gap, own), mask)
    colours[20:30, 20:30] = 200
    assert np.array_equal(bridged(gap, own_colours(colours, gap)), gap)


def test_limits_of_a_shadow_can_be_set():
    scene = _scene()
    scene[30:60, 20:50] *= 0.75
    strict = Statistics(_plate(), StatisticsSettings(darkest=0.9))
    assert strict.foreground(_filmed(scene, 99))[32:58, 22:48].all()
