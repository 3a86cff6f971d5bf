import numpy as np
import pytest
from silhouette_mocap.core.geometry.arrays import check_indices, frozen_array


def test_a_frozen_array_is_a_read_only_copy():
    source = np.ones((2, 3))
    frozen = frozen_array(source, (None, 3), "things")
    source[0, 0] = 5
    assert frozen[0, 0] == 1
    with pytest.raises(ValueError, match="read-only"):
        frozen[0, 0] = 2


def test_a_wrong_shape_is_told_with_the_expected_one():
    with pytest.raises(ValueError, match=r"expected things of shape any x 3, got \(2, 2\)"):
        frozen_array(np.ones((2, 2)), (None, 3), "things")


def test_numbers_that_are_not_finite_are_refused():
    with pytest.raises(ValueError, match="finite numbers in things"):
        frozen_array([1.0, np.nan], (2,), "things")


@pytest.mark.parametrize("indices", [[0, 3], [-1, 0]])
def test_an_index_out_of_range_is_refused(indices):
    with pytest.raises(ValueError, match="expected things from 0 to 2"):
        check_indices(indices, 3, "things")


def test_indices_in_range_and_no_indices_at_all_are_fine():
    check_indices([0, 1, 2], 3, "things")
    check_indices([], 0, "things")
