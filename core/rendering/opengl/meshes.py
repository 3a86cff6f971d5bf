"""Triangle meshes as OpenGL draws them: welded, without waste, closed segments first.

Every pixel that the front faces of a closed mesh cover is covered by its back faces, too: after
snapping to whole numbers, the signed coverage of a closed surface is zero everywhere. So half of
its faces need not be drawn, whatever their orientation, as long as nothing is cut off by the near
plane.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...body.body import Surface


@dataclass(frozen=True, eq=False)
class Mesh:
    """The triangles of some segments, those of closed segments first.

    Attributes:
        points: (n, 3) float32 metres, in the space of the joint that carries the segment.
        columns: (n,) uint32, the vertex's place among the segments that were asked for.
        corners: (m, 3) uint32 indices into ``points``, segment by segment.
        order: (k,) the columns in the order in which their triangles follow each other.
        starts: (k + 1,) first triangle of each of them.
        closed: number of triangles, the first ones, that belong to closed segments.
    """

    points: np.ndarray
    columns: np.ndarray
    corners: np.ndarray
    order: np.ndarray
    starts: np.ndarray
    closed: int


def welded(points: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and corners without doubles, unused points and triangles that name a point twice."""
    points, places = np.unique(points, axis=0, return_inverse=True)
    corners = places.reshape(-1)[corners]
    a, b, c = corners.T
    corners = corners[(a != b) & (b != c) & (c != a)]
    used, corners = np.unique(corners, return_inverse=True)
    return points[used], corners.reshape(-1, 3)


def is_closed(corners: np.ndarray) -> bool:
    """Whether every edge is run through as often in one direction as in the other."""
    begins, ends = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    count = int(corners.max(initial=0)) + 1
    along, back = begins * count + ends, ends * count + begins
    return bool(np.array_equal(np.sort(along), np.sort(back)))


def segment_mesh(surface: Surface, segments: Sequence[int]) -> Mesh:
    """The mesh of ``segments``; columns count along them."""
    pieces = []
    for column, segment in enumerate(segments):
        first, last = surface.vertex_starts[segment : segment + 2]
        begin, end = surface.triangle_starts[segment : segment + 2]
        corners = surface.triangles[begin:end].astype(np.int64) - first
        points, corners = welded(surface.vertices[first:last], corners)
        pieces.append((not is_closed(corners), column, points, corners))
    pieces.sort(key=lambda piece: piece[:2])
    sizes = [len(points) for _, _, points, _ in pieces]
    firsts = np.cumsum([0, *sizes])
    lengths = [len(corners) for _, _, _, corners in pieces]
    empty_points, empty_corners = np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    return Mesh(
        points=np.concatenate([empty_points, *(p for _, _, p, _ in pieces)]).astype(np.float32),
        columns=np.repeat([column for _, column, _, _ in pieces], sizes).astype(np.uint32),
        corners=np.concatenate(
            [empty_corners, *(c + f for (_, _, _, c), f in zip(pieces, firsts, strict=False))]
        ).astype(np.uint32),
        order=np.array([column for _, column, _, _ in pieces], np.int64),
        starts=np.cumsum([0, *lengths]),
        closed=sum(len(corners) for is_open, _, _, corners in pieces if not is_open),
    )
