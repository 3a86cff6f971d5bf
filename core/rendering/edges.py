"""Edges of closed surfaces with the planes on their two sides, in clusters of sixteen.

An edge is drawn only if one of its faces shows its front and the other its back. Where every edge
has both faces, that is all there is to know of a surface, so each edge carries the two planes and
its ends: sixteen neighbours are judged at once without looking anything up. The margins within
which a plane does not tell are those of `faces`; a cluster is skipped where all faces beside its
edges are known to look the same way.
"""

from dataclasses import dataclass

import numpy as np

from .clusters import CLUSTER, cluster_order
from .faces import Faces, joint_planes

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
    """

    cones: np.ndarray
    sides: np.ndarray
    ends: np.ndarray
    corners: np.ndarray


def closed_edges(faces: Faces) -> ClosedEdges:
    """Clusters of the edges of one segment's triangles."""
    pairs, ends, count = faces.records.faces, faces.records.vertices, len(faces.triangles)
    if not len(pairs) or (pairs == count).any() or len(faces.vertices) > MOST_VERTICES:
        return ClosedEdges(
            np.zeros((8, 0), np.float32),
            np.zeros((0, 8, CLUSTER), np.float32),
            np.zeros((0, CLUSTER), np.uint32),
            np.zeros((0, CLUSTER, 4), np.int32),
        )
    middles = faces.vertices[ends].astype(float).mean(axis=1)
    order = cluster_order(faces.planes[:3].T[pairs].mean(axis=1), middles)
    pairs, ends = pairs[order], ends[order]
    sets = np.repeat(np.arange(len(order)) // CLUSTER, 2)
    clusters = -(-len(order) // CLUSTER)
    cones = joint_planes(faces.planes, faces.middles, sets, pairs.ravel(), clusters)
    sides = np.concatenate([faces.planes[:4, pairs[:, k]].T for k in range(2)], axis=1)
    apart = faces.triangles[pairs].sum(axis=2) - ends.sum(axis=1, keepdims=True)
    corners = _filled(np.concatenate([ends, apart], axis=1), [0] * 4)
    return ClosedEdges(
        cones.astype(np.float32),
        _filled(sides, [0, 0, 0, -1] * 2).transpose(0, 2, 1).astype(np.float32),
        (corners[..., 0] + (corners[..., 1] << 16)).astype(np.uint32),
        corners.astype(np.int32),
    )


def _filled(rows: np.ndarray, fill: list[int]) -> np.ndarray:
    """(K, 16, …) rows; edges that are missing have two faces that always show their fronts."""
    missing = np.full((-len(rows) % CLUSTER, len(fill)), fill)
    return np.concatenate([rows, missing]).reshape(-1, CLUSTER, len(fill))
