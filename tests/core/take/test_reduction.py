"""Reduced pictures and cameras belong together."""

import numpy as np
import pytest
from silhouette_mocap.core.cameras.presets import Ring, ring
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from silhouette_mocap.core.take.reduction import Reduction, fitting_reduction


def silhouette(height: int, size: tuple[int, int] = (101, 1000)) -> Silhouette:
    foreground = np.zeros(size[::-1], bool)
    foreground[20 : 20 + height, 30:60] = True
    return Silhouette(foreground, np.ones(size[::-1], bool))


@pytest.mark.parametrize(
    ("height", "factor"), [(1, 1), (400, 1), (590, 1), (610, 2), (800, 2), (980, 2)]
)
def test_the_performer_ends_up_near_the_working_height(height, factor):
    assert fitting_reduction((silhouette(height), silhouette(0))).factor == factor


def test_patches_elsewhere_do_not_make_the_performer_taller():
    spoilt = silhouette(500)
    spoilt.foreground[990:, :20] = True
    assert fitting_reduction((spoilt,)).factor == 1


def test_no_performer_reduces_nothing():
    assert fitting_reduction((silhouette(0),)).factor == 1


def test_a_projected_point_stays_on_its_content():
    (camera,) = ring(Ring(1, size=(641, 483), focal_px=550.0))
    reduction = Reduction(3)
    points = np.array([[0.1, 0.2, 1.3], [-0.5, 0.1, 0.4]])
    full, reduced = camera.project(points), reduction.camera(camera).project(points)
    # the centre of a block of 3 px is the centre of the px it becomes
    np.testing.assert_allclose(reduced, (full - 1) / 3)


def test_a_block_that_is_half_covered_counts_and_one_partly_unobserved_does_not():
    foreground, observed = np.zeros((4, 7), bool), np.ones((4, 7), bool)
    foreground[:, 0] = foreground[0:1, 2:4] = foreground[3, 2] = True
    foreground[:, 4:6] = True
    observed[0, 5] = False
    small = Reduction(2).silhouette(Silhouette(foreground, observed))
    np.testing.assert_array_equal(small.foreground, [[1, 1, 0], [1, 0, 1]])
    np.testing.assert_array_equal(small.observed, [[1, 1, 0], [1, 1, 1]])


def test_a_factor_of_one_is_the_same_thing():
    (camera,) = ring(Ring(1))
    one, seen = Reduction(), silhouette(100)
    assert one.camera(camera) is camera and one.silhouette(seen) is seen
    assert one.picture(seen.foreground) is seen.foreground
