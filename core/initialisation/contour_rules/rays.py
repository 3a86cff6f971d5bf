"""Where rays meet: the midpoint between two, the least squares of more.

Of two rays it is the middle of the shortest line between them (midpoint triangulation, Trucco and
Verri 1998), of more the point with the least sum of weighted squared distances. A ray far off the
others is outvoted by reweighting: the weights fall with the squared distance, as Cauchy's do.
"""

from dataclasses import dataclass

import numpy as np

from ...cameras.camera import Camera
from ...geometry.arrays import frozen_array

_REWEIGHTINGS = 8
_USUAL_M = 0.02
"""Distance at which a ray's weight is halved; what a rule means differs so much between views."""


@dataclass(frozen=True, eq=False)
class Rays:
    """n rays, one for each view that shows a joint.

    Attributes:
        centres: (n, 3) where they begin, world metres.
        directions: (n, 3) unit vectors.
        weights: (n,) how much each counts.
    """

    centres: np.ndarray
    directions: np.ndarray
    weights: np.ndarray

    def __post_init__(self):
        set_ = object.__setattr__
        centres = frozen_array(self.centres, (None, 3), "centres")
        set_(self, "centres", centres)
        set_(self, "directions", frozen_array(self.directions, centres.shape, "directions"))
        set_(self, "weights", frozen_array(self.weights, (len(centres),), "weights"))

    @property
    def across(self) -> np.ndarray:
        """(n, 3, 3) what takes out the part along each ray."""
        return np.eye(3) - self.directions[:, :, None] * self.directions[:, None, :]


@dataclass(frozen=True, eq=False)
class Planes:
    """m planes, for joints of which a view tells one coordinate only.

    Attributes:
        normals: (m, 3) unit vectors.
        offsets: (m,) metres; a point p lies in a plane where normal @ p is its offset.
        weight: how much each counts.
    """

    normals: np.ndarray
    offsets: np.ndarray
    weight: float = 1.0

    def __post_init__(self):
        set_ = object.__setattr__
        normals = frozen_array(self.normals, (None, 3), "normals")
        set_(self, "normals", normals)
        set_(self, "offsets", frozen_array(self.offsets, (len(normals),), "offsets"))


@dataclass(frozen=True, eq=False)
class Meeting:
    """Where rays meet.

    Attributes:
        point: (3,) world metres.
        gap: metres; between two rays their distance, between more twice the root of the weighted
            mean of their squared distances from the point, which is the same for two.
        depth: how well the point is fixed along the direction that is fixed least: the share of a
            squared distance that a ray sees on average; 0.5 where two rays cross at 90°.
    """

    point: np.ndarray
    gap: float
    depth: float


def meeting(rays: Rays, planes: Planes | None = None) -> Meeting:
    """Where at least two rays meet, or one ray and a plane."""
    weights = rays.weights
    point = _nearest(rays, weights, planes)
    for _ in range(_REWEIGHTINGS if len(weights) > 2 else 0):
        weights = rays.weights / (1.0 + (_apart(rays, point) / _USUAL_M) ** 2)
        point = _nearest(rays, weights, planes)
    gap = 2 * np.sqrt(np.average(_apart(rays, point) ** 2, weights=weights))
    seen, _ = _normal_equations(rays, weights, planes)
    depth = np.linalg.eigvalsh(seen / weights.sum())[0]
    return Meeting(np.round(point, 6), float(gap), float(depth))


def ray(camera: Camera, px: np.ndarray) -> np.ndarray:
    """(3,) unit direction in the world of what a pinhole camera sees at ``px`` (2,)."""
    way = camera.rotation.T @ np.linalg.solve(camera.matrix, [*px, 1.0])
    return way / np.linalg.norm(way)


def _apart(rays: Rays, point: np.ndarray) -> np.ndarray:
    """(n,) metres from a point (3,) to the rays."""
    return np.linalg.norm(np.einsum("vab,vb->va", rays.across, point - rays.centres), axis=1)


def _nearest(rays: Rays, weights: np.ndarray, planes: Planes | None) -> np.ndarray:
    """(3,) the point of the least squares."""
    return np.linalg.lstsq(*_normal_equations(rays, weights, planes), rcond=None)[0]


def _normal_equations(
    rays: Rays, weights: np.ndarray, planes: Planes | None
) -> tuple[np.ndarray, np.ndarray]:
    """(3, 3) and (3,) of the least squares."""
    weighted = weights[:, None, None] * rays.across
    left, right = weighted.sum(axis=0), np.einsum("vab,vb->a", weighted, rays.centres)
    if planes is None:
        return left, right
    normals = planes.weight * planes.normals
    return left + normals.T @ planes.normals, right + planes.offsets @ normals
