import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.footage.footage import open_footage
from silhouette_mocap.core.silhouettes.cleaning import Cleaned, Cleaning
from silhouette_mocap.core.silhouettes.masks import ReadyMasks, write_masks
from silhouette_mocap.core.silhouettes.quality import MaskMeter, contour_contrast
from silhouette_mocap.core.silhouettes.source import SilhouetteSource


class _ShiftedRight:
    """Moves pictures two and a half pixels to the right, with nothing coming in from the left."""

    def __init__(self, shape):
        self.observed = np.ones(shape, bool)
        self.observed[:, :3] = False

    def undistorted(self, picture):
        whole = np.roll(picture.astype(float), 2, axis=1)
        return np.round((whole + np.roll(whole, 1, axis=1)) / 2).astype(np.uint8)


def _mask() -> np.ndarray:
    mask = np.zeros((40, 50), bool)
    mask[10:30, 15:30] = True
    return mask


def _footage(tmp_path, frames=3):
    speck = _mask()
    speck[1, 1] = True
    pattern = tmp_path / "{camera}" / "{frame:06d}.png"
    write_masks(pattern, "left", ((frame, speck) for frame in range(frames)))
    return open_footage(pattern, "left", (0, frames - 1))


def test_silhouettes_are_cleaned_masks_in_frame_order(tmp_path):
    source = SilhouetteSource(_footage(tmp_path), ReadyMasks(), Cleaning())
    frames = list(source.silhouettes(1, 2))
    assert [frame for frame, _ in frames] == [1, 2]
    for _, silhouette in frames:
        assert np.array_equal(silhouette.foreground, _mask())
        assert silhouette.observed.all()


def test_ready_masks_can_be_left_as_they_are(tmp_path):
    silhouette = SilhouetteSource(_footage(tmp_path), ReadyMasks()).read(0)
    assert silhouette.foreground[1, 1]


def test_nothing_is_known_under_an_ignore_mask(tmp_path):
    ignore = np.zeros((40, 50), bool)
    ignore[:, 25:] = True
    silhouette = SilhouetteSource(_footage(tmp_path), ReadyMasks(), Cleaning(), ignore).read(0)
    assert np.array_equal(silhouette.observed, ~ignore)
    assert np.array_equal(silhouette.foreground, _mask() & ~ignore)


def test_an_ignore_mask_of_another_size_is_refused(tmp_path):
    with pytest.raises(MocapError, match="camera left: the ignore mask is 50 x 41 px"):
        SilhouetteSource(_footage(tmp_path), ReadyMasks(), ignore=np.zeros((41, 50), bool))


def test_lens_and_ignore_mask_meet_in_the_pixels_of_the_pinhole_camera(tmp_path):
    ignore = np.zeros((40, 50), bool)
    ignore[:, 40] = True
    source = SilhouetteSource(
        _footage(tmp_path), ReadyMasks(), Cleaning(), ignore, _ShiftedRight((40, 50))
    )
    silhouette = source.read(0)
    expected = np.zeros((40, 50), bool)
    # half-covered pixels on both sides count as foreground (128 of 255)
    expected[10:30, 17:33] = True
    assert np.array_equal(silhouette.foreground, expected)
    assert np.flatnonzero(~silhouette.observed[0]).tolist() == [0, 1, 2, 42, 43]


def test_quality_counts_coverage_specks_and_masks_that_flicker():
    meter = MaskMeter()
    blinking = _mask()
    blinking[10:30, 30:33] = True
    for mask in (_mask(), blinking, _mask(), _mask()):
        meter.add(Cleaned(mask, specks=2, holes=0))
    quality = meter.quality()
    assert (quality.frames, quality.empty, quality.specks) == (4, 0, 2)
    assert quality.coverage == pytest.approx((4 * 300 + 60) / 4 / 2000)
    # of three frames with both neighbours two exist; one of them blinks 60 of its 360 px
    assert quality.flicker == pytest.approx((60 / 360 + 0) / 2)
    assert np.isnan(quality.contrast)


def test_contrast_is_the_difference_in_colour_across_the_contour():
    picture = np.full((40, 50, 3), 60, np.uint8)
    picture[_mask()] = (90, 100, 60)
    assert contour_contrast(picture, _mask()) == pytest.approx(50, abs=0.5)
    assert contour_contrast(np.full((40, 50), 7, np.uint8), _mask()) == pytest.approx(0, abs=1e-3)
