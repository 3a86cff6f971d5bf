import numpy as np
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.fitting.confidence import point_confidence

WELL = np.full(14, 0.008), np.full(5, 0.012), np.zeros(5)


def test_a_fit_without_fault_is_likely():
    assert (point_confidence(*WELL) > 0.7).all()


def test_each_sign_of_error_lowers_the_confidence_of_its_own_points():
    arm = [POINT_NAMES.index(name) for name in ("left_elbow", "left_wrist")]
    others = np.setdiff1d(np.arange(14), arm)
    well = point_confidence(*WELL)
    spreads, residual, lumps = (array.copy() for array in WELL)
    spreads[arm] = 0.15
    residual[1] = 0.15
    lumps[1] = 0.05
    for changed in (
        (spreads, *WELL[1:]),
        (WELL[0], residual, WELL[2]),
        (*WELL[:2], lumps),
    ):
        found = point_confidence(*changed)
        assert (found[arm] < well[arm]).all()
        np.testing.assert_array_equal(found[others], well[others])
    assert (point_confidence(spreads, residual, lumps)[arm] < 0.3).all()


def test_a_limb_that_no_view_shows_is_unlikely():
    unseen = WELL[1].copy()
    unseen[1] = np.nan
    found = point_confidence(np.full(14, 0.3), unseen, WELL[2])
    assert found[POINT_NAMES.index("left_wrist")] < 0.3
