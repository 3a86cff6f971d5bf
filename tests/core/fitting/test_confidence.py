from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.fitting.confidence import LimbSigns, point_confidence

SPREADS = np.full(14, 0.006)
WELL = LimbSigns(
    residual=np.full(5, 0.008),
    lumps=np.full(5, 0.002),
    unexplained=np.full(5, 0.03),
    usual=np.full(5, 0.002),
)
ARM = [POINT_NAMES.index(name) for name in ("left_elbow", "left_wrist")]


def with_arm(values, value):
    changed = values.copy()
    changed[1] = value
    return changed


BAD = LimbSigns(
    residual=with_arm(WELL.residual, 0.15),
    lumps=with_arm(WELL.lumps, 0.05),
    unexplained=with_arm(WELL.unexplained, 0.7),
    usual=WELL.usual,
)


def test_a_fit_without_fault_is_likely():
    assert (point_confidence(SPREADS, WELL) > 0.8).all()


@pytest.mark.parametrize("sign", ["spread", "residual", "lumps", "unexplained"])
def test_each_sign_of_error_lowers_the_confidence_of_its_own_points(sign):
    well, spreads, signs = point_confidence(SPREADS, WELL), SPREADS.copy(), WELL
    if sign == "spread":
        spreads[ARM] = 0.1
    else:
        signs = replace(WELL, **{sign: getattr(BAD, sign)})
    found, others = point_confidence(spreads, signs), np.setdiff1d(np.arange(14), ARM)
    assert (found[ARM] < well[ARM]).all()
    np.testing.assert_array_equal(found[others], well[others])


def test_what_nothing_fixes_is_never_likelier_however_well_the_rest_looks():
    spreads = [0.005, 0.01, 0.02, 0.05, 0.1, 0.3, 1.0, 5.0]
    found = [point_confidence(np.full(14, spread), WELL).max() for spread in spreads]
    assert (np.diff(found) < 0).all()
    assert found[-1] < 1e-3


def test_lumps_that_are_usual_count_less():
    lumpy = replace(WELL, lumps=BAD.lumps)
    usual = replace(lumpy, usual=BAD.lumps)
    assert (point_confidence(SPREADS, usual)[ARM] > point_confidence(SPREADS, lumpy)[ARM]).all()
    unknown = replace(lumpy, usual=np.full(5, np.inf))
    np.testing.assert_array_equal(
        point_confidence(SPREADS, unknown), point_confidence(SPREADS, usual)
    )


def test_all_signs_together_leave_no_doubt():
    assert (point_confidence(np.full(14, 0.1), BAD)[ARM] < 0.05).all()


def test_a_limb_that_no_view_shows_is_unlikely():
    unseen = LimbSigns(np.full(5, np.nan), np.zeros(5), np.ones(5), np.full(5, np.inf))
    assert (point_confidence(np.full(14, 0.3), unseen) < 0.05).all()
