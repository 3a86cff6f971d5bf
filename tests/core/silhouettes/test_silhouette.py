"""Distances to the boundary of a silhouette."""

import cv2
import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt
from silhouette_mocap.core.silhouettes.silhouette import Silhouette


def ellipse():
    picture = np.zeros((240, 320), np.uint8)
    cv2.ellipse(picture, (150, 120), (30, 90), 10, 0, 360, (1,), -1)
    return picture.view(bool)


def test_distances_are_those_between_pixels_but_for_half_of_one():
    foreground = ellipse()
    outside, inside = distance_transform_edt(~foreground), distance_transform_edt(foreground)
    distances = Silhouette(foreground, np.ones_like(foreground)).distances
    assert distances == pytest.approx(np.where(foreground, 0.5 - inside, outside - 0.5), abs=1e-4)


def test_distances_have_the_same_bits_wherever_in_memory_they_lie():
    foreground, rng, kept = ellipse(), np.random.default_rng(0), []
    found = set()
    for _ in range(60):
        kept.append(np.empty(rng.integers(1000, 200_000), np.uint8))
        silhouette = Silhouette(foreground.copy(), np.ones_like(foreground))
        found.add(silhouette.distances.tobytes())
    assert len(found) == 1


@pytest.mark.filterwarnings("error")
def test_nobody_is_far_away():
    nobody = np.zeros((24, 32), bool)
    assert Silhouette(nobody, ~nobody).distances.min() > 32
