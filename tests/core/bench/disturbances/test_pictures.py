"""Disturbances of silhouettes, against what they say of themselves."""

import cv2
import numpy as np
import pytest
from known_recording import known_recording
from silhouette_mocap.core.bench.disturbances.edges import BoundaryJitter, Holes, Speckle, Swelling
from silhouette_mocap.core.bench.disturbances.limbs import (
    SHADOWS,
    BlobOnHand,
    FloorShadow,
    LimbBitten,
    LimbDropout,
)
from silhouette_mocap.core.bench.disturbances.recording import disturbed
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.silhouettes.cleaning import Cleaning, cleaned

RECORDING = known_recording()
SQUARE = np.ones((3, 3), np.uint8)
CROSS = cv2.getStructuringElement(cv2.MORPH_CROSS, (3, 3))


def before_and_after(disturbance, frame=5):
    """For each view the picture before and after."""
    noisy = disturbed(RECORDING, 1, disturbance)
    pairs = zip(RECORDING.silhouettes(frame), noisy.silhouettes(frame), strict=True)
    return [(clean.foreground, found.foreground) for clean, found in pairs]


def pixel(name, view, frame=5):
    """Row and column of a point."""
    point = RECORDING.points(frame)[POINT_NAMES.index(name)]
    x, y = np.round(RECORDING.cameras[view].project(point)).astype(int)
    return y, x


@pytest.mark.parametrize(("sign", "moved"), [(1, cv2.dilate), (-1, cv2.erode)])
def test_a_boundary_moves_by_a_pixel_or_by_half_of_one_on_average(sign, moved):
    for clean, found in before_and_after(Swelling(sign * 1.0)):
        least, most = (
            cleaned(moved(clean.astype(np.uint8), shape).view(bool), Cleaning()).mask
            for shape in (CROSS, SQUARE)
        )
        smaller, larger = (least, most) if sign > 0 else (most, least)
        assert not (smaller & ~found).any() and not (found & ~larger).any()
    changed = [clean != found for clean, found in before_and_after(Swelling(sign * 0.5))]
    whole = [
        clean != moved(clean.astype(np.uint8), CROSS).view(bool)
        for clean, _ in before_and_after(Swelling(0.5))
    ]
    assert np.sum(changed) / np.sum(whole) == pytest.approx(0.5, abs=0.12)


def test_a_jittering_boundary_moves_both_ways_and_no_further_than_noise_does():
    for view, (clean, found) in enumerate(before_and_after(BoundaryJitter(1.0))):
        distances = RECORDING.look(5, view).distances
        assert (found & ~clean).sum() > 20 and (clean & ~found).sum() > 20
        assert np.abs(distances[clean != found]).max() < 5
        # the mean of a half-normal distance, in px along the boundary
        edge = (np.abs(distances) < 1).sum() / 2
        assert (clean != found).sum() / edge == pytest.approx(np.sqrt(2 / np.pi), rel=0.5)


def test_holes_lie_within_the_silhouette_and_are_as_large_as_said():
    for view, (clean, found) in enumerate(before_and_after(Holes(2, radius_m=0.1))):
        assert not (found & ~clean).any()
        radius = 0.1 * RECORDING.cameras[view].matrix[0, 0] / 4.0
        assert 0 < (clean & ~found).sum() < 2 * 1.5 * np.pi * (radius + 0.5) ** 2


def test_specks_are_added_and_small_ones_are_cleaned_away_as_in_a_fit():
    for clean, found in before_and_after(Speckle(30)):
        assert not (clean & ~found).any() and (found & ~clean).any()
        areas = cv2.connectedComponentsWithStats(found.astype(np.uint8))[2][1:, cv2.CC_STAT_AREA]
        assert areas.min() >= 0.01 * clean.sum()


def test_a_bitten_arm_is_gone_and_the_other_stays():
    for view, (clean, found) in enumerate(before_and_after(LimbBitten("left"))):
        assert clean[pixel("left_wrist", view)] and not found[pixel("left_wrist", view)]
        assert not (found & ~clean).any()
        bitten = np.argwhere(clean & ~found)
        elbow = np.array(pixel("left_elbow", view))
        # forearm and hand, half an upper arm and the bite's radius: within 0.65 m of the elbow
        assert np.linalg.norm(bitten - elbow, axis=1).max() < 0.65 * 125 / 3.0
    _, (clean, found), *_ = before_and_after(LimbBitten("right", "leg"))
    assert clean[pixel("right_ankle", 1)] and not found[pixel("right_ankle", 1)]


def test_limbs_drop_out_as_often_as_said_and_for_five_frames():
    clean = {frame: RECORDING.silhouettes(frame) for frame in RECORDING.frames}

    def lost(chance, frame):
        noisy = disturbed(RECORDING, 1, LimbDropout(chance)).silhouettes(frame)
        return [
            bool((seen.foreground & ~found.foreground).any())
            for seen, found in zip(clean[frame], noisy, strict=True)
        ]

    assert not any(lost(0.0, 5)) and all(lost(1.0, 5))
    assert lost(0.5, 5) == lost(0.5, 7) == lost(0.5, 9)
    counts = [sum(lost(0.5, frame)) for frame in (0, 5)]
    assert 0 < sum(counts) < 8


def test_a_limb_that_nobody_has_is_refused():
    with pytest.raises(ValueError, match="expected a limb"):
        LimbBitten("left", "tail")
    with pytest.raises(ValueError, match="expected one of"):
        FloorShadow("ghost")


def test_a_blob_covers_the_hand_and_nothing_else():
    radius = 0.2
    for view, (clean, found) in enumerate(before_and_after(BlobOnHand("left", radius))):
        row, column = pixel("left_wrist", view)
        wrist = RECORDING.points(5)[POINT_NAMES.index("left_wrist")]
        camera = RECORDING.cameras[view]
        px = radius * camera.matrix[0, 0] / camera.depths(wrist)
        rows, columns = np.indices(clean.shape)
        away = np.hypot(rows - row, columns - column)
        assert found[away < px - 1].all()
        assert np.array_equal(found[away > px + 1], clean[away > px + 1])


def test_a_shadow_lies_on_the_floor_where_the_light_throws_it():
    ankle = RECORDING.points(5)[POINT_NAMES.index("left_knee")]
    fallen = ankle + np.array([0.6, 0.35, -1.0]) * ankle[2]
    assert fallen[2] == pytest.approx(0)
    for view, (clean, found) in enumerate(before_and_after(FloorShadow("shanks"))):
        assert not (clean & ~found).any()
        x, y = np.round(RECORDING.cameras[view].project(fallen)).astype(int)
        if 0 <= x < found.shape[1] and 0 <= y < found.shape[0]:
            assert found[y, x]


def test_longer_shadows_hold_shorter_ones():
    shanks, legs, body = (
        [found for _, found in before_and_after(FloorShadow(of))] for of in SHADOWS
    )
    for view in range(4):
        assert not (shanks[view] & ~legs[view]).any() and not (legs[view] & ~body[view]).any()
        assert body[view].sum() > shanks[view].sum()
