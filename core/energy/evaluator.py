"""The energy of poses, and the protocol that every rendering backend fulfils.

Both energies of the seeds are linear in the rendered silhouette T of a view:
E(T) = C + sum over pixels p in T of w(p). A backend therefore needs only a weight map w and a
constant C per view. For the XOR energy (Theobalt et al. 2003, section 4) w is +1 outside the
observed silhouette, -1 inside and 0 where nothing was observed; C is the silhouette's area.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera


@dataclass(frozen=True, eq=False)
class WeightMaps:
    """Weight maps of the V views of one frame.

    Attributes:
        maps: V arrays (H, W) int16, energy in px gained where the model covers a pixel.
        constants: (V,) int64, the energy of an empty rendering.
    """

    maps: tuple[np.ndarray, ...]
    constants: np.ndarray


@dataclass(frozen=True, eq=False)
class Outline:
    """P points on the outline of one view.

    Attributes:
        segments: (P,) int32 the segment each lies on.
        points: (P, 3) m, in the space of the segment's joint.
        px: (P, 2) where it is seen.
        normals: (P, 2) unit vectors in the image that point away from the body.
    """

    segments: np.ndarray
    points: np.ndarray
    px: np.ndarray
    normals: np.ndarray


class Weights(Protocol):
    """Weight maps in a backend's own form; made by `Evaluator.prepared` and `Evaluator.masked`."""

    @property
    def constants(self) -> np.ndarray:
        """(V,) int64 constants, fixed parts included."""
        ...


W = TypeVar("W", bound=Weights)


class Evaluator(Protocol[W]):
    """Energies and silhouettes of one body in fixed pinhole cameras, views kept apart."""

    body: Body
    cameras: tuple[Camera, ...]

    def prepared(self, maps: WeightMaps) -> W:
        """The weight maps in the backend's form."""
        ...

    def masked(
        self,
        weights: W,
        pose: np.ndarray,
        moving: Sequence[int],
        windows: np.ndarray | None = None,
    ) -> W:
        """Weights under which the ``moving`` segments alone give the full energy (section 4.3).

        The other segments are rendered once in ``pose`` (D,); where they cover, w becomes 0 and
        the sum of w goes into the constants. With ``windows`` (V, 4) int, [x0, y0, x1, y1) in px,
        weights outside become 0 as well (section 4.2), which changes no energy of a part that
        stays inside.
        """
        ...

    def energies(
        self, weights: W, poses: np.ndarray, segments: Sequence[int] | None = None
    ) -> np.ndarray:
        """(N, V) int64 energies of poses (N, D) or (N, V, D), of all or the given segments."""
        ...

    def silhouettes(
        self, pose: np.ndarray, segments: Sequence[int] | None = None
    ) -> tuple[np.ndarray, ...]:
        """V boolean pictures (H, W), True where the body covers the pixel's centre."""
        ...

    def outline(
        self, pose: np.ndarray, segments: Sequence[int] | None = None, spacing_px: float = 1.0
    ) -> tuple[Outline, ...]:
        """V outlines of what the segments cover in a pose (D,) or (V, D), see `rendering.outline`.

        Neighbouring points on an edge are at most ``spacing_px`` apart.
        """
        ...

    def bounds(self, poses: np.ndarray, segments: Sequence[int]) -> np.ndarray:
        """(N, V, 4) int: x0, y0, x1, y1 (exclusive), px that the segments can cover, unclipped."""
        ...

    def transforms(self, poses: np.ndarray) -> np.ndarray:
        """(N, J, 3, 4) world_from_joint of poses (N, D), metres."""
        ...
