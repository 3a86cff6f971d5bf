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
    """Where at least two rays meet, or one ray and a plane.

    Of three rays and more, the reweighting begins with all of them and with all but each one, and
    the best end counts: a wrong ray may draw the point so far that others look wrong.
    """
    count = len(rays.weights)
    starts = np.ones((1, count))
    if count > 2:
        starts = np.concatenate([starts, 1.0 - np.eye(count)])
    weights, points = starts * rays.weights, np.zeros((len(starts), 3))
    for _ in range(_REWEIGHTINGS if count > 2 else 1):
        points = _nearest(rays, weights, planes)
        squares = (_apart(rays, points) / _USUAL_M) ** 2
        weights = rays.weights / (1.0 + squares) if count > 2 else weights
    best = int(_costs(rays, points, planes).argmin())
    point, weights = points[best], weights[best]
    gap = 2 * np.sqrt(np.average(_apart(rays, point[None])[0] ** 2, weights=weights))
    seen, _ = _normal_equations(rays, weights[None], planes)
    depth = np.linalg.eigvalsh(seen[0] / weights.sum())[0]
    return Meeting(np.round(point, 6), float(gap), float(depth))


def ray(camera: Camera, px: np.ndarray) -> np.ndarray:
    """(3,) unit direction in the world of what a pinhole camera sees at ``px`` (2,)."""
    way = camera.rotation.T @ np.linalg.solve(camera.matrix, [*px, 1.0])
    return way / np.linalg.norm(way)


def _apart(rays: Rays, points: np.ndarray) -> np.ndarray:
    """(S, n) metres from points (S, 3) to the rays."""
    ways = points[:, None] - rays.centres
    return np.linalg.norm(np.einsum("vab,svb->sva", rays.across, ways), axis=2)


def _costs(rays: Rays, points: np.ndarray, planes: Planes | None) -> np.ndarray:
    """(S,) what the reweighting makes small, of points (S, 3)."""
    costs = (rays.weights * np.log1p((_apart(rays, points) / _USUAL_M) ** 2)).sum(axis=1)
    if planes is None:
        return costs
    misses = (points @ planes.normals.T - planes.offsets) / _USUAL_M
    return costs + planes.weight * (misses**2).sum(axis=1)


def _nearest(rays: Rays, weights: np.ndarray, planes: Planes | None) -> np.ndarray:
    """(S, 3) points of the least squares with weights (S, n)."""
    left, right = _normal_equations(rays, weights, planes)
    return np.einsum("sab,sb->sa", np.linalg.pinv(left, hermitian=True), right)


def _normal_equations(
    rays: Rays, weights: np.ndarray, planes: Planes | None
) -> tuple[np.ndarray, np.ndarray]:
    """(S, 3, 3) and (S, 3) of the least squares with weights (S, n)."""
    weighted = weights[:, :, None, None] * rays.across
    left, right = weighted.sum(axis=1), np.einsum("svab,vb->sa", weighted, rays.centres)
    if planes is None:
        return left, right
    normals = planes.weight * planes.normals
    return left + normals.T @ planes.normals, right + planes.offsets @ normals
