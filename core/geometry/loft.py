"""Closed meshes drawn through cross-sections along a straight axis.

A cross-section is made of four quarters of superellipses, |x / a|^n + |y / b|^n = 1, one radius
for each of the four directions outer, inner, front and back. Between the given sections the radii
follow a monotone cubic (no overshoot: a thigh never grows thicker than its sections say); beyond
the first and last section the surface closes as half an ellipsoid.
"""

from dataclasses import dataclass

import numpy as np

from .arrays import frozen_array
from .ring_choice import fitted_sections

BODY_SAMPLES = 49
CAP_SAMPLES = 10


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


def rings(radii: np.ndarray, exponent: float, sides: int) -> np.ndarray:
    """(K, sides, 2) points outwards and frontwards of sections with ``radii`` (K, 4).

    They are widened by (pi / sides) / sin(pi / sides): then the polygon's perimeter, and with it
    its mean width over all directions (Cauchy), is the ellipse's, and silhouettes keep their area.
    Every second ring is turned by half a side: where one is too wide its neighbours are too
    narrow, and the outline between them crosses the true one.
    """
    turns = np.arange(sides) + 0.5 * (np.arange(len(radii))[:, None] % 2)
    unit = np.stack([np.cos(2 * np.pi / sides * turns), np.sin(2 * np.pi / sides * turns)], -1)
    unit[np.abs(unit) < 1e-12] = 0
    unit = np.sign(unit) * np.abs(unit) ** (2 / exponent)
    positive = unit > 0
    widths = np.where(positive[..., 0], radii[:, :1], radii[:, 1:2])
    depths = np.where(positive[..., 1], radii[:, 2:3], radii[:, 3:])
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

    The rings turn about the direction from the first pole to the last by the right-hand rule,
    every second one half a side ahead, as those of `rings` do.
    """
    near = np.arange(sides)
    far = np.roll(near, -1)
    ahead = [[near, far, near + sides], [far, far + sides, near + sides]]
    behind = [[near, far, far + sides], [near, far + sides, near + sides]]
    bands = [
        1 + sides * k + np.stack(triangle, 1)
        for k in range(count - 1)
        for triangle in (behind if k % 2 else ahead)
    ]
    last = 1 + sides * (count - 1)
    start = np.stack([np.zeros_like(near), 1 + far, 1 + near], 1)
    end = np.stack([np.full_like(near, last + sides), last + near, last + far], 1)
    return np.concatenate([start, *bands, end])
