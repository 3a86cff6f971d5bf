"""The contour of a silhouette as a periodic cubic B-spline, and where it is creased.

Contour points about 2 % of the performer's height apart are interpolated by a spline, whose
derivatives give the signed curvature

    curvature = (x' y'' - y' x'') / (x'² + y'²)^(3/2)

counter-clockwise with y up, so that it is negative where the body is concave (Jaume-i-Capó et al.
2012, "Human Body Shape Decomposition"). Steps of pixels crease a contour, too: a crease counts if
it is still there twice as coarsely.
"""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import KDTree

from ...geometry.arrays import frozen_array
from ...geometry.boxes import box_round
from ...silhouettes.silhouette import Silhouette
from .upright import Upright

SPACING = 0.02
"""Between contour points, as a share of the performer's height."""
_COARSER = 2.0
_DRIFT = 0.04
"""How far a crease may move from one scale to the other, as a share of the height."""
_LEAST = 8.0
"""Curvature of a crease or bulge: wider turns than an eighth of the height bound no part."""
_FINE = 4
"""Parts of a pixel that the contour is traced by, and samples between two contour points."""


@dataclass(frozen=True, eq=False)
class Outline:
    """A closed contour, sampled densely along its spline; lengths in heights of the performer.

    Attributes:
        spline: place (2,) by arc length, x to the right and y up, counter-clockwise.
        points: (n, 2) samples at even steps of the spline's parameter.
        curvature: (n,) 1 / height, negative where the body is concave.
        creases: indices of the minima of negative curvature, in the order of the contour.
        bulges: indices of the maxima of positive curvature, likewise.
    """

    spline: BSpline
    points: np.ndarray
    curvature: np.ndarray
    creases: np.ndarray
    bulges: np.ndarray

    def __post_init__(self):
        set_ = object.__setattr__
        points = frozen_array(self.points, (None, 2), "points")
        set_(self, "points", points)
        set_(self, "curvature", frozen_array(self.curvature, (len(points),), "curvature"))
        for name in ("creases", "bulges"):
            set_(self, name, frozen_array(getattr(self, name), (None,), name, np.int64))

    @classmethod
    def of(cls, contour: np.ndarray, spacing: float = SPACING) -> "Outline":
        """The outline of a closed contour (m, 2), counter-clockwise, its points dense."""
        fine, coarse = (_spline(contour, s) for s in (spacing, _COARSER * spacing))
        points, curvature = _sampled(fine, spacing)
        places, rough = _sampled(coarse, spacing)
        valleys, tops = (
            _persistent(points, sign * curvature, places, sign * rough) for sign in (1, -1)
        )
        return cls(fine, points, curvature, valleys, tops)

    @cached_property
    def tangents(self) -> np.ndarray:
        """(n, 2) unit vectors along the contour."""
        ahead = np.roll(self.points, -1, axis=0) - np.roll(self.points, 1, axis=0)
        return ahead / np.linalg.norm(ahead, axis=1, keepdims=True)

    @property
    def normals(self) -> np.ndarray:
        """(n, 2) unit vectors out of the body."""
        return self.tangents @ np.array([[0.0, -1.0], [1.0, 0.0]])

    def between(self, first: int, last: int) -> np.ndarray:
        """Indices from ``first`` to ``last``, both included, counter-clockwise."""
        count = len(self.points)
        return np.arange(first, first + (last - first) % count + 1) % count


def traced_contour(silhouette: Silhouette, upright: Upright) -> np.ndarray:
    """(m, 2) the outer contour of the largest patch, counter-clockwise, in heights.

    It runs where the blurred distance from the boundary is 0, to a quarter of a pixel.
    """
    box = box_round(silhouette.foreground, margin_px=3)
    field = cv2.resize(silhouette.contour.field[box], None, fx=_FINE, fy=_FINE)
    # whose outermost pixels' centres lie half a fine pixel further in
    inside = (field < 0.5 / _FINE).astype(np.uint8)
    contours, _ = cv2.findContours(inside, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    largest = max(contours, key=cv2.contourArea)[:, 0].astype(float)
    px = (largest + 0.5) / _FINE - 0.5 + [box[1].start, box[0].start]
    points = upright.from_px(px)
    return points if _area(points) > 0 else points[::-1]


def _area(points: np.ndarray) -> float:
    x, y = points.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def _spline(contour: np.ndarray, spacing: float) -> BSpline:
    """The spline through points ``spacing`` apart; what is finer is taken out before."""
    steps = np.linalg.norm(np.diff(contour, axis=0, append=contour[:1]), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    count = max(8, round(along[-1] / spacing))
    dense = np.linspace(0.0, along[-1], 8 * count, endpoint=False)
    closed = np.concatenate([contour, contour[:1]])
    even = np.stack([np.interp(dense, along, closed[:, k]) for k in (0, 1)], axis=1)
    smooth = gaussian_filter1d(even, 4.0, axis=0, mode="wrap")[::8]
    places = np.linspace(0.0, along[-1], count + 1)
    return make_interp_spline(places, np.concatenate([smooth, smooth[:1]]), 3, bc_type="periodic")


def _sampled(spline: BSpline, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) and curvature (n,) of the spline."""
    length = spline.t[-4]
    places = np.linspace(0.0, length, _FINE * round(length / spacing), endpoint=False)
    return spline(places), curvature(spline, places)


def curvature(spline: BSpline, places: np.ndarray) -> np.ndarray:
    """(n,) signed curvature at parameters (n,) of a plane spline, from its derivatives."""
    (dx, dy), (ddx, ddy) = spline(places, 1).T, spline(places, 2).T
    return (dx * ddy - dy * ddx) / np.hypot(dx, dy) ** 3


def _persistent(
    points: np.ndarray, values: np.ndarray, places: np.ndarray, rough: np.ndarray
) -> np.ndarray:
    """Indices of negative minima of ``values`` (n,) that have one of ``rough`` (m,) nearby."""
    found, known = _minima(values, _LEAST), _minima(rough, _LEAST / _COARSER)
    if not len(found) or not len(known):
        return found[:0]
    distances, _ = KDTree(places[known]).query(points[found])
    return found[distances <= _DRIFT]


def _minima(values: np.ndarray, least: float) -> np.ndarray:
    lowest = (values < np.roll(values, 1)) & (values <= np.roll(values, -1))
    return np.flatnonzero(lowest & (values <= -least))
