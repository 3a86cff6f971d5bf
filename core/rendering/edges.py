"""Edges of closed surfaces with the planes on their two sides, in clusters of sixteen.

An edge is drawn only if one of its faces shows its front and the other its back. Where every edge
has both faces, that is all there is to know of a surface, so each edge carries the two planes and
its ends: sixteen neighbours are judged at once without looking anything up. The margins within
which a plane does not tell are those of `clusters`; a cluster is skipped where all faces beside its
edges are known to look the same way.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from .clusters import face_planes, joint_plane, leaves
from .records import edge_records

CLUSTER = 16
"""Edges to a cluster."""
MOST_VERTICES = 2**15
"""Of a segment whose edges are put into clusters."""


@dataclass(frozen=True, eq=False)
class ClosedEdges:
    """One segment's edges in K clusters; none where an edge lacks a face on one side.

    Attributes:
        cones: (8, K) float32 m, m . q, max |n - m|, max |n . (p - q)|, margins' factors.
        sides: (K, 8, 16) float32, row by row n and n . p of the face that runs from p to q, and of
            the one that runs back.
        ends: (K, 16) uint32 p + 2^16 q.
        corners: (K, 16, 4) int32 p, q and the third vertex of either face.
        connected: whether the triangles hang together.
    """

    cones: np.ndarray
    sides: np.ndarray
    ends: np.ndarray
    corners: np.ndarray
    connected: bool


def closed_edges(vertices: np.ndarray, triangles: np.ndarray) -> ClosedEdges:
    """Clusters of the edges of triangles (m, 3) with vertices (n, 3)."""
    records = edge_records(triangles)
    is_open = not len(records.faces) or (records.faces == len(triangles)).any()
    if is_open or len(vertices) > MOST_VERTICES:
        return ClosedEdges(
            np.zeros((8, 0), np.float32),
            np.zeros((0, 8, CLUSTER), np.float32),
            np.zeros((0, CLUSTER), np.uint32),
            np.zeros((0, CLUSTER, 4), np.int32),
            False,
        )
    planes = face_planes(vertices, triangles)
    points = vertices[triangles].astype(float).mean(axis=1)
    middles = vertices[records.vertices].astype(float).mean(axis=1)
    radius = max(np.linalg.norm(middles - middles.mean(axis=0), axis=1).max(), 1e-9)
    normals = planes[:3].T[records.faces].mean(axis=1)
    groups = leaves(np.concatenate([normals, middles * (0.3 / radius)], axis=1), CLUSTER)
    cones, sides, corners = [], [], []
    for group in groups:
        faces, ends = records.faces[group], records.vertices[group]
        cones.append(joint_plane(planes, points, np.unique(faces)))
        rows = np.concatenate([planes[:4, faces[:, 0]], planes[:4, faces[:, 1]]])
        sides.append(_filled(rows, [0, 0, 0, -1] * 2))
        apart = triangles[faces].sum(axis=2) - ends.sum(axis=1)[:, None]
        corners.append(_filled(np.concatenate([ends, apart], axis=1).T, [0] * 4).T.astype(int))
    return ClosedEdges(
        np.stack(cones, axis=1).astype(np.float32),
        np.stack(sides).astype(np.float32),
        np.stack([c[:, 0] + (c[:, 1] << 16) for c in corners]).astype(np.uint32),
        np.stack(corners).astype(np.int32),
        _is_connected(records.faces, len(triangles)),
    )


def _is_connected(pairs: np.ndarray, count: int) -> bool:
    """Whether all of ``count`` faces are reached from one over edges between pairs (n, 2)."""
    links = coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    return connected_components(links, directed=False, return_labels=False) == 1


def _filled(rows: np.ndarray, fill: list[float]) -> np.ndarray:
    """Rows of sixteen; edges that are missing have two faces that always show their fronts."""
    missing = np.repeat(np.array(fill, float)[:, None], CLUSTER - rows.shape[1], axis=1)
    return np.concatenate([rows, missing], axis=1)
