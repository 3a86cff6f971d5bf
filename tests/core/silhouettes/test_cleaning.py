import cv2
import numpy as np
from silhouette_mocap.core.geometry.boxes import box_round
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


def small_patches(mask: np.ndarray, connectivity: int, least_px: float) -> np.ndarray:
    """Their labels, all over the picture, 0 where there are none."""
    picture = mask.astype(np.uint8)
    _, labels, stats, _ = cv2.connectedComponentsWithStats(picture, connectivity=connectivity)
    small = stats[:, cv2.CC_STAT_AREA] < least_px
    return np.where(small[labels] & mask, labels, 0)


def test_work_round_the_performer_gives_the_same_as_in_the_whole_picture():
    rng, counts = np.random.default_rng(0), np.zeros(2, int)
    for _ in range(300):
        mask = np.zeros((rng.integers(1, 30), rng.integers(1, 30)), bool)
        # some reach one, two or all of the picture's edges
        y0, x0 = rng.integers(-4, np.array(mask.shape) - 1).clip(0)
        y1, x1 = rng.integers([y0, x0], np.array(mask.shape) + 4) + 1
        part = mask[y0:y1, x0:x1]
        part |= rng.random(part.shape) < rng.choice([0.0, 0.4, 0.7, 0.97, 1.0])
        cleaning = Cleaning(*rng.choice([0.0, 0.05, 0.3], 2))
        areas = cv2.connectedComponentsWithStats(mask.view(np.uint8), connectivity=8)[2][1:, -1]
        largest = max(areas, default=0)
        specks = small_patches(mask, 8, cleaning.speck * largest)
        holes = small_patches(~mask | (specks > 0), 4, cleaning.hole * largest)
        beyond = np.ones_like(mask)
        beyond[box_round(mask, margin_px=1)] = False
        holes[np.isin(holes, holes[beyond])] = 0
        result = cleaned(mask, cleaning)
        np.testing.assert_array_equal(result.mask, mask & (specks == 0) | (holes > 0))
        found = [len(np.unique(labels[labels > 0])) for labels in (specks, holes)]
        assert [result.specks, result.holes] == found
        counts += found
    assert counts.min() > 50
