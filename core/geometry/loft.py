"""Closed meshes drawn through cross-sections along a straight axis.

A cross-section is made of four quarters of superellipses, |x / a|^n + |y / b|^n = 1, one radius
for each of the four directions outer, inner, front and back. Between the given sections the radii
follow a monotone cubic (no overshoot: a thigh never grows thicker than its sections say); beyond
the first and last section the surface closes as half an ellipsoid.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .arrays import frozen_array

BODY_SAMPLES = 49
CAP_SAMPLES = 10
TIE_DIGITS = 9
"""Symmetric shapes have ties; rounding lets every processor break them alike."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Cross-sections along an axis from a start (station 0) to an end (station 1).

    Attributes:
        ends: the stations where the surface closes; outside the range of ``stations``.
        stations: (K,) rising positions of the cross-sections, in lengths of the axis.
        radii: (K, 4) metres from the axis towards outer, inner, front, back.
        exponent: of the superellipse; 2 is an ellipse, more is boxier.

    Raises:
        ValueError: a wrong shape, falling stations, ends between the stations, a negative radius.
    """

    ends: tuple[float, float]
    stations: np.ndarray
    radii: np.ndarray
    exponent: float = 2.0

    def __post_init__(self):
        set_ = object.__setattr__
        set_(self, "stations", frozen_array(self.stations, (None,), "stations"))
        set_(self, "radii", frozen_array(self.radii, (len(self.stations), 4), "radii"))
        path = [self.ends[0], *self.stations, self.ends[1]]
        if (np.diff(path) <= 0).any():
            raise ValueError(f"expected rising stations between the ends, got {path}")
        if (self.radii < 0).any():
            raise ValueError("expected radii of at least 0 m")

    def scaled(self, width: float, depth: float) -> "Profile":
        """Outer and inner radii times ``width``, front and back times ``depth``."""
        factors = np.array([width, width, depth, depth])
        return Profile(self.ends, self.stations, self.radii * factors, self.exponent)

    def sampled(self) -> tuple[np.ndarray, np.ndarray]:
        """Dense stations (M,) and radii (M, 4) from pole to pole; the poles have no radius."""
        first, last = self.stations[0], self.stations[-1]
        angles = np.linspace(0, np.pi / 2, CAP_SAMPLES + 1)[1:]
        shrink = np.cos(angles)[:, None]
        shrink[-1] = 0
        body = np.linspace(first, last, BODY_SAMPLES)
        start = first + (self.ends[0] - first) * np.sin(angles)
        end = last + (self.ends[1] - last) * np.sin(angles)
        # takes half a second to load, which commands without a body do without
        from scipy.interpolate import PchipInterpolator

        radii = PchipInterpolator(self.stations, self.radii)(body)
        caps = self.radii[0] * shrink, self.radii[-1] * shrink
        return np.r_[start[::-1], body, end], np.concatenate([caps[0][::-1], radii, caps[1]])


@dataclass(frozen=True, eq=False)
class Axis:
    """Where a profile stands.

    Attributes:
        start: (3,) station 0.
        end: (3,) station 1.
        front: (3,) any vector with the front's direction; it is made perpendicular to the axis.
            Outer is front x axis: for a bone that hangs down and a front at -Y it is +X, the left.
    """

    start: np.ndarray
    end: np.ndarray
    front: np.ndarray


def chosen_samples(stations: np.ndarray, radii: np.ndarray, count: int) -> np.ndarray:
    """(count,) rising indices of samples between which straight interpolation serves best.

    Of ``stations`` (M,) and ``radii`` (M, 4), as `Profile.sampled` gives them.
    The two ends are always taken; then, one by one, the gap with the largest area between outline
    and chord is split where they are farthest apart (after Douglas and Peucker 1973, who split by
    distance alone and so spend their samples on the blunt ends, which joints hide).
    """
    chosen = [0, len(stations) - 1]
    while len(chosen) < min(count, len(stations)):
        splits = [_split(stations, radii, i, j) for i, j in pairwise(chosen)]
        chosen = sorted([*chosen, max(splits)[1]])
    return np.array(chosen)


def _split(stations: np.ndarray, radii: np.ndarray, start: int, end: int) -> tuple[float, int]:
    """Area between outline and chord from sample ``start`` to ``end``, and the farthest sample."""
    if end - start < 2:
        return -1.0, start
    s, r = stations[start : end + 1], radii[start : end + 1]
    share = (s - s[0])[:, None] / (s[-1] - s[0])
    gaps = np.abs(r - r[0] - share * (r[-1] - r[0])).sum(axis=1).round(TIE_DIGITS)
    area = ((gaps[1:] + gaps[:-1]) * np.diff(s)).sum() / 2
    return round(float(area), TIE_DIGITS), start + int(np.argmax(gaps))


def fitted_sections(stations: np.ndarray, radii: np.ndarray, picked: np.ndarray) -> np.ndarray:
    """(len(picked), 4) radii whose straight interpolation is nearest to all samples' radii.

    Rings on the surface itself would lie inside it wherever it bulges; these lie astride. The
    poles at both ends keep no radius.
    """
    hats = np.array([np.interp(stations, stations[picked], unit) for unit in np.eye(len(picked))])
    fitted = np.zeros((len(picked), 4))
    fitted[1:-1] = np.linalg.lstsq(hats[1:-1].T, radii, rcond=None)[0]
    return np.maximum(fitted, 0)


def rings(radii: np.ndarray, exponent: float, sides: int) -> np.ndarray:
    """(K, sides, 2) points outwards and frontwards of sections with ``radii`` (K, 4).

    They are widened by (pi / sides) / sin(pi / sides): then the polygon's perimeter, and with it
    its mean width over all directions (Cauchy), is the ellipse's, and silhouettes keep their area.
    """
    angles = 2 * np.pi * np.arange(sides) / sides
    unit = np.stack([np.cos(angles), np.sin(angles)], -1)
    unit[np.abs(unit) < 1e-12] = 0
    unit = np.sign(unit) * np.abs(unit) ** (2 / exponent)
    positive = unit > 0
    widths = np.where(positive[:, 0], radii[:, :1], radii[:, 1:2])
    depths = np.where(positive[:, 1], radii[:, 2:3], radii[:, 3:])
    return unit * np.stack([widths, depths], -1) / np.sinc(1 / sides)


def lofted(
    profile: Profile, axis: Axis, sides: int, picked: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The closed mesh of ``profile`` along ``axis``.

    Args:
        profile: the cross-sections.
        axis: where they stand.
        sides: points of a ring.
        picked: (R + 2,) indices of the profile's samples that become poles and rings, as
            `chosen_samples` gives them. Meshes that are to deform smoothly with their profile
            need the same indices.

    Returns:
        vertices (2 + sides * R, 3) and triangles (2 * sides * R, 3), oriented outwards.
    """
    stations, radii = profile.sampled()
    along = axis.end - axis.start
    front = axis.front - (axis.front @ along) / (along @ along) * along
    front = front / np.linalg.norm(front)
    outer = np.cross(front, along) / np.linalg.norm(along)
    centres = axis.start + stations[picked, None] * along
    fitted = fitted_sections(stations, radii, picked)
    sections = rings(fitted[1:-1], profile.exponent, sides)
    points = centres[1:-1, None] + sections[..., :1] * outer + sections[..., 1:] * front
    vertices = np.concatenate([centres[:1], points.reshape(-1, 3), centres[-1:]])
    return vertices, tube_triangles(sides, len(picked) - 2)


def tube_triangles(sides: int, count: int) -> np.ndarray:
    """(2 * sides * count, 3) triangles of a pole, ``count`` rings of ``sides`` points and a pole.

    The rings turn about the direction from the first pole to the last by the right-hand rule.
    """
    near = np.arange(sides)
    far = np.roll(near, -1)
    band = np.concatenate(
        [np.stack([near, far, near + sides], 1), np.stack([far, far + sides, near + sides], 1)]
    )
    bands = (1 + band + sides * np.arange(count - 1)[:, None, None]).reshape(-1, 3)
    last = 1 + sides * (count - 1)
    start = np.stack([np.zeros_like(near), 1 + far, 1 + near], 1)
    end = np.stack([np.full_like(near, last + sides), last + near, last + far], 1)
    return np.concatenate([start, bands, end])
