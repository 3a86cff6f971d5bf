"""Pictures and masks of a distorting lens, turned into those of a pinhole.

Every later step is pinhole, so the lens is taken out once, when pictures are loaded (SPEC §2). The
new picture keeps the focal lengths of the old one, hence its resolution in the centre, and grows
until every source pixel has a place in it; where a lens would make it grow beyond
``LARGEST_GROWTH`` it keeps everything at a smaller focal length instead.

Two kinds of pixels of the new picture have no source: those that fall outside the old one, and
those beyond the radius at which the lens polynomial stops rising. There the polynomial folds back
and would show a mirrored ghost of the picture. Both are unobserved.
"""

from dataclasses import replace
from functools import cached_property

import cv2
import numpy as np

from ..errors import MocapError
from .camera import Camera

WIDEST_VIEW_DEG = 110.0
LARGEST_GROWTH = 1.5
LARGEST_LOSS = 0.05
SAMPLES_PER_SIDE = 101
WIDEST_RADIUS = 4.0
ROUND_TRIP_PX = 0.02


class Undistortion:
    """The pinhole camera that sees what ``camera`` sees, and the way to its pictures.

    For a camera without distortion, nothing is computed and pictures pass through untouched.

    Attributes:
        source: the camera as calibrated.
        camera: the pinhole camera, of the same name and pose; its pictures may be larger.

    Raises:
        MocapError: a field of view above 110°, or a lens polynomial that gives no viewing ray to
            more than 5 % of the picture.
    """

    def __init__(self, camera: Camera):
        self.source = camera
        self.camera = camera if camera.is_pinhole else _pinhole(camera)

    @property
    def is_identity(self) -> bool:
        """Whether pictures pass through untouched."""
        return self.camera is self.source

    def undistorted(self, picture: np.ndarray) -> np.ndarray:
        """The picture (H, W) or (H, W, 3) of ``source`` as ``camera`` sees it.

        Pictures and soft mattes are interpolated linearly. A boolean mask is interpolated linearly
        and cut at one half, which keeps its outline to a fraction of a pixel; taking the nearest
        pixel would move the outline by up to half a pixel, with steps. Pixels without a source are
        0. Without distortion, the result is ``picture`` itself.

        Raises:
            ValueError: a picture of another size than the source camera's.
        """
        width, height = self.source.size
        if picture.shape[:2] != (height, width):
            raise ValueError(f"expected a picture of {width} x {height} px, got {picture.shape}")
        if self.is_identity:
            return picture
        is_mask = picture.dtype == bool
        pixels = picture.astype(np.uint8) * 255 if is_mask else picture
        result = cv2.remap(pixels, *self._maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        if is_mask:
            return (result >= 128) & self.observed
        result[self._unobserved] = 0
        return result

    @property
    def observed(self) -> np.ndarray:
        """(H, W) bool, read-only: False where ``camera`` has pixels without a source pixel."""
        return self._observed

    @cached_property
    def _observed(self) -> np.ndarray:
        width, height = self.camera.size
        if self.is_identity:
            observed = np.ones((height, width), bool)
        else:
            u, v = self._source_places()
            w, h = self.source.size
            observed = (u >= -0.5) & (u <= w - 0.5) & (v >= -0.5) & (v <= h - 0.5)
            observed &= self._radii() < _fold_radius(self.source)
        observed.setflags(write=False)
        return observed

    @cached_property
    def _maps(self) -> tuple[np.ndarray, np.ndarray]:
        """The places in remap's fixed-point form, which it would else make for every picture."""
        return cv2.convertMaps(*self._source_places(), cv2.CV_16SC2)

    @cached_property
    def _unobserved(self) -> tuple[np.ndarray, ...]:
        return np.nonzero(~self.observed)

    def _source_places(self) -> tuple[np.ndarray, np.ndarray]:
        """Columns and rows (H, W), float32, in the source of every pixel."""
        source = self.source
        init = (
            cv2.fisheye.initUndistortRectifyMap if source.fisheye else cv2.initUndistortRectifyMap
        )
        return init(
            source.matrix, source.distortion, np.eye(3), self.camera.matrix, self.camera.size,
            cv2.CV_32FC1,
        )  # fmt: skip

    def _radii(self) -> np.ndarray:
        """(H, W) distances from the optical axis at depth 1."""
        matrix, (width, height) = self.camera.matrix, self.camera.size
        x = (np.arange(width) - matrix[0, 2]) / matrix[0, 0]
        y = (np.arange(height) - matrix[1, 2]) / matrix[1, 1]
        return np.hypot(x, y[:, None])


def view_angles_deg(camera: Camera) -> tuple[float, float]:
    """The horizontal and vertical angle of view along the picture's middle lines, in degrees.

    NaN where the lens polynomial gives no viewing ray to the middle of an edge.
    """
    width, height = camera.size
    cx, cy = camera.matrix[:2, 2]
    ends = np.array([[-0.5, cy], [width - 0.5, cy], [cx, -0.5], [cx, height - 0.5]])
    rays = np.column_stack([undistorted_pixels(camera, ends, np.eye(3)), np.ones(4)])
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    cosines = np.einsum("ij,ij->i", rays[::2], rays[1::2])
    horizontal, vertical = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
    return float(horizontal), float(vertical)


def undistorted_pixels(camera: Camera, pixels: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(N, 2) places under a pinhole ``matrix`` of the source pixels (N, 2).

    NaN where the lens polynomial has no inverse: no ray leads to that pixel.
    """
    points = np.asarray(pixels, float).reshape(-1, 1, 2)
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-10)
    if camera.fisheye:
        rays = cv2.fisheye.undistortPoints(
            points, camera.matrix, camera.distortion, criteria=criteria
        )
    else:
        rays = cv2.undistortPointsIter(
            points, camera.matrix, camera.distortion, np.eye(3), np.eye(3), criteria
        )
    rays = rays.reshape(-1, 2)
    homogeneous = np.column_stack([rays, np.ones(len(rays))])
    with np.errstate(invalid="ignore", over="ignore"):
        fine = (
            np.linalg.norm(camera.through_lens(homogeneous) - points[:, 0], axis=1) < ROUND_TRIP_PX
        )
        fine &= np.hypot(*rays.T) < _fold_radius(camera)
    rays[~fine] = np.nan
    return rays * matrix[[0, 1], [0, 1]] + matrix[:2, 2]


def _pinhole(camera: Camera) -> Camera:
    _refuse_wide_views(camera)
    low, high = _extent(camera)
    factor = min(1.0, LARGEST_GROWTH / ((high - low) / camera.size).max())
    low = np.floor(low + 0.5) - 0.5  # whole pixels: the picture's middle is not resampled
    matrix = camera.matrix.copy()
    matrix[[0, 1], [0, 1]] *= factor
    matrix[:2, 2] = factor * (camera.matrix[:2, 2] - low) - 0.5
    size = np.ceil(factor * (high - low) - 1e-6).astype(int)
    return replace(camera, matrix=matrix, size=tuple(size), distortion=np.zeros(0), fisheye=False)


def _refuse_wide_views(camera: Camera) -> None:
    widest = np.nanmax([0.0, *view_angles_deg(camera)])
    if widest > WIDEST_VIEW_DEG:
        kind = "fisheye camera" if camera.fisheye else "camera"
        raise MocapError(
            f"this {kind} sees {widest:.0f}°; pictures above {WIDEST_VIEW_DEG:.0f}° cannot be "
            "undistorted into a plane",
            "record with a narrower (linear) field of view, crop the footage, or leave this "
            "camera out",
            camera=camera.name,
        )


def _extent(camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """The corners (x, y) of the box that holds all undistorted source pixels, in px of its K."""
    width, height = camera.size
    u, v = np.meshgrid(
        np.linspace(-0.5, width - 0.5, SAMPLES_PER_SIDE),
        np.linspace(-0.5, height - 0.5, SAMPLES_PER_SIDE),
    )
    places = undistorted_pixels(camera, np.column_stack([u.ravel(), v.ravel()]), camera.matrix)
    lost = np.isnan(places[:, 0]).mean()
    if lost > LARGEST_LOSS:
        raise MocapError(
            f"the lens distortion gives no viewing ray to {100 * lost:.0f} % of the picture",
            "calibrate this camera again with the board up to the picture's corners",
            camera=camera.name,
        )
    return np.nanmin(places, axis=0), np.nanmax(places, axis=0)


def _fold_radius(camera: Camera) -> float:
    """The distance from the axis, at depth 1, at which the lens curve stops rising."""
    radii = np.linspace(0, WIDEST_RADIUS, 4001)
    points = np.column_stack([radii, np.zeros_like(radii), np.ones_like(radii)])
    radial = camera.distortion.copy()
    if not camera.fisheye:
        radial[2:4] = 0
        radial[8:] = 0
    lens = replace(camera, matrix=np.eye(3), distortion=radial)
    falling = np.flatnonzero(np.diff(lens.through_lens(points)[:, 0]) <= 0)
    return float(radii[falling[0]]) if falling.size else np.inf
