"""A segment's triangles with their planes, and what holds for several of them at once.

A face with unit normal n and a point p on it shows its front to a camera at c if n . (c - p) > 0.
The kernel needs the orientation of the *snapped* triangle in the image, which is the same wherever

    |n . (c - p)| > alpha (|e_1| + |e_2| + |e_3|) / |N| + beta / |N|,      N = e_1 x e_2

with its edges e_1, e_2, e_3 in metres; alpha and beta follow from bounds of depth and magnification
over the segment (`contours.c`). In the same way all faces of a set with mean normal m and mean
point q are known at once, and to face the same way, where

    |m . (c - q)| > |c - q| max |n - m| + max |n . (p - q)| + the largest margin.
"""

from dataclasses import dataclass

import numpy as np

from .records import EdgeRecords, edge_records

ROUND_UP = 1 + 1e-5


@dataclass(frozen=True, eq=False)
class Faces:
    """One segment's m triangles.

    Attributes:
        vertices: (n, 3) float32 m, in the space of the segment's joint.
        triangles: (m, 3) vertices.
        planes: (6, m) those of `face_planes`.
        middles: (m, 3) m.
        records: which of them meet at every edge.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    planes: np.ndarray
    middles: np.ndarray
    records: EdgeRecords


def faces_of(vertices: np.ndarray, triangles: np.ndarray) -> Faces:
    """The triangles (m, 3) of one segment with vertices (n, 3)."""
    return Faces(
        vertices,
        triangles,
        face_planes(vertices, triangles),
        vertices[triangles].astype(float).mean(axis=1).reshape(-1, 3),
        edge_records(triangles),
    )


def face_planes(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(6, m) n, n . p and the margins' factors (|e_1| + |e_2| + |e_3|) / |N| and 1 / |N|.

    A triangle without area has infinite margins.
    """
    p, q, r = (vertices[triangles[:, k]].astype(float) for k in range(3))
    normal = np.cross(q - p, r - p)
    length = np.linalg.norm(normal, axis=1)
    flat = length < 1e-18
    scale = np.where(flat, 0.0, 1 / np.where(flat, 1.0, length))
    unit = normal * scale[:, None]
    edges = sum(np.linalg.norm(edge, axis=1) for edge in (q - p, r - q, p - r))
    margins = np.stack([edges * scale, scale]) * ROUND_UP
    margins[:, flat] = np.inf
    return np.vstack([unit.T, (unit * p).sum(axis=1), margins])


def joint_planes(
    planes: np.ndarray, middles: np.ndarray, sets: np.ndarray, faces: np.ndarray, count: int
) -> np.ndarray:
    """(8, K) m, m . q, max |n - m|, max |n . (p - q)| and largest margins of K = ``count`` sets.

    Face ``faces[i]`` is in set ``sets[i]``, however often that is said; no set is empty.
    """
    keys = np.unique(sets * planes.shape[1] + faces)
    sets, faces = np.divmod(keys, planes.shape[1])
    begins = np.searchsorted(sets, np.arange(count))
    sizes = np.diff(begins, append=len(sets))
    joint = np.empty((8, count))
    for size in np.unique(sizes):
        alike = np.flatnonzero(sizes == size)
        chosen = faces[begins[alike, None] + np.arange(size)]
        joint[:, alike] = _joint_planes(planes[:, chosen], middles[chosen])
    return joint


def _joint_planes(planes: np.ndarray, middles: np.ndarray) -> np.ndarray:
    """(8, K) for K sets of n faces with planes (6, K, n) and middles (K, n, 3)."""
    normals, middles = planes[:3], np.moveaxis(middles, 2, 0)
    mean, centre = normals.mean(axis=2), middles.mean(axis=2)
    apart = np.linalg.norm(normals - mean[..., None], axis=0).max(axis=1)
    along = np.abs((normals * (middles - centre[..., None])).sum(axis=0)).max(axis=1)
    offset = (mean * centre).sum(axis=0)
    return np.vstack([mean, offset, apart * ROUND_UP, along * ROUND_UP, planes[4:].max(axis=2)])
