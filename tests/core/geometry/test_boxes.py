import numpy as np
from silhouette_mocap.core.geometry.boxes import box_round


def test_a_box_holds_all_that_is_true_and_its_margin_stops_at_the_picture():
    mask = np.zeros((20, 30), bool)
    mask[4, 7] = mask[9, 28] = True
    assert box_round(mask) == np.s_[4:10, 7:29]
    inner = np.zeros_like(mask)
    inner[box_round(mask, margin_px=6)] = True
    assert np.array_equal(np.argwhere(inner)[[0, -1]], [[0, 1], [15, 29]])


def test_nothing_is_boxed_in_the_corner():
    nothing = np.zeros((20, 30), bool)
    assert nothing[box_round(nothing)].size == 0
    assert nothing[box_round(nothing, margin_px=1)].shape == (1, 1)
