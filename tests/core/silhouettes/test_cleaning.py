import numpy as np
from silhouette_mocap.core.silhouettes.cleaning import Cleaning, cleaned


def _performer() -> np.ndarray:
    mask = np.zeros((200, 160), bool)
    mask[20:180, 60:100] = True
    return mask


def test_specks_and_pinholes_go():
    mask = _performer()
    mask[5:8, 5:8] = True
    mask[100:102, 70:72] = False
    result = cleaned(mask, Cleaning())
    assert np.array_equal(result.mask, _performer())
    assert (result.specks, result.holes) == (1, 1)


def test_the_loop_of_an_arm_on_the_hip_and_a_cut_off_hand_stay():
    mask = _performer()
    mask[60:100, 100:120] = True
    mask[70:90, 103:110] = False
    mask[110:122, 104:114] = True
    result = cleaned(mask, Cleaning())
    assert np.array_equal(result.mask, mask)
    assert (result.specks, result.holes) == (0, 0)


def test_sizes_are_relative_so_that_resolution_does_not_matter():
    mask = _performer()
    mask[5:9, 5:9] = True
    mask[100:102, 70:72] = False
    thrice = np.kron(mask, np.ones((3, 3), bool))
    assert np.array_equal(
        cleaned(thrice, Cleaning()).mask,
        np.kron(cleaned(mask, Cleaning()).mask, np.ones((3, 3), bool)),
    )


def test_empty_and_full_masks_are_left_alone():
    for mask in (np.zeros((9, 9), bool), np.ones((9, 9), bool)):
        assert np.array_equal(cleaned(mask, Cleaning()).mask, mask)
