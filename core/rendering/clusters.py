"""Faces in clusters of sixteen, so that most edges are known at a glance not to be contours.

A face with unit normal n and a point p on it shows its front to a camera at c if n . (c - p) > 0.
The kernel needs the orientation of the *snapped* triangle in the image, which is the same wherever

    |n . (c - p)| > alpha (|e_1| + |e_2|) / |N| + beta / |N|,      N = e_1 x e_2

with e_1, e_2 two edges in metres; alpha and beta follow from bounds of depth and magnification over
the segment (`contours.c`). In the same way all faces of a set with mean normal m and mean point q
are known at once, and to face the same way, where

    |m . (c - q)| > |c - q| max |n - m| + max |n . (p - q)| + the largest margin.

Edge records are owned by the lower of the two clusters they join; the set that is judged for a
cluster holds its own faces and those across the edges it owns.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .records import EdgeRecords, edge_records

CLUSTER = 16
"""Triangles to a cluster."""
RUN = 8
"""A cluster's records are filled up to a multiple of this."""
ROUND_UP = 1 + 1e-5
PLACE_WEIGHT = 0.3
"""Of a face's place, in segment radii, against its normal when faces are clustered."""


@dataclass(frozen=True, eq=False)
class ClusteredMesh:
    """One segment's triangles in K clusters of sixteen, the last filled up with its last triangle.

    Attributes:
        corners: (16 K, 3) int32 vertices of the triangles.
        face_planes: (6, 16 K) float32 n, n . p, and the two margins' factors.
        cluster_planes: (8, K) float32 m, m . q, max |n - m|, max |n . (p - q)|, margins' factors.
        records: the edge records by cluster; 16 K stands for "no triangle", and twice 16 K + 1
            makes a record that fills up its run.
        run_lengths: (K,) number of records of each cluster, multiples of 8.
    """

    corners: np.ndarray
    face_planes: np.ndarray
    cluster_planes: np.ndarray
    records: EdgeRecords
    run_lengths: np.ndarray


def clustered_mesh(vertices: np.ndarray, triangles: np.ndarray) -> ClusteredMesh:
    """Clusters of the triangles (m, 3) of one segment with vertices (n, 3)."""
    planes = face_planes(vertices, triangles)
    points = vertices[triangles].astype(float).mean(axis=1).reshape(-1, 3)
    radius = np.linalg.norm(points - points.mean(axis=0), axis=1).max() if len(points) else 1.0
    features = np.concatenate([planes[:3].T, points * (PLACE_WEIGHT / max(radius, 1e-9))], axis=1)
    order = np.concatenate([np.zeros(0, int), *leaves(features, CLUSTER)])
    filled = np.concatenate([order, np.repeat(order[-1:], -len(order) % CLUSTER)])
    faces, points = planes[:, filled], points[filled]
    runs = _runs(edge_records(triangles[order]), len(order), len(filled) // CLUSTER)
    rings = [_ring_plane(faces, points, k, run.faces) for k, run in enumerate(runs)]
    return ClusteredMesh(
        corners=triangles[filled].astype(np.int32),
        face_planes=faces.astype(np.float32),
        cluster_planes=np.reshape(rings, (-1, 8)).T.astype(np.float32),
        records=EdgeRecords(
            np.concatenate([np.zeros((0, 2), np.int32), *(run.vertices for run in runs)]),
            np.concatenate([np.zeros((0, 2), np.int32), *(run.faces for run in runs)]),
        ),
        run_lengths=np.array([len(run.faces) for run in runs], np.int32),
    )


def face_planes(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(6, m) n, n . p and the margins' factors (|e_1| + |e_2|) / |N| and 1 / |N|.

    A triangle without area has infinite margins.
    """
    p, q, r = (vertices[triangles[:, k]].astype(float) for k in range(3))
    normal = np.cross(q - p, r - p)
    length = np.linalg.norm(normal, axis=1)
    flat = length < 1e-18
    scale = np.where(flat, 0.0, 1 / np.where(flat, 1.0, length))
    unit = normal * scale[:, None]
    edges = np.linalg.norm(q - p, axis=1) + np.linalg.norm(r - p, axis=1)
    margins = np.stack([edges * scale, scale]) * ROUND_UP
    margins[:, flat] = np.inf
    return np.vstack([unit.T, (unit * p).sum(axis=1), margins])


def leaves(features: np.ndarray, size: int) -> list[np.ndarray]:
    """Indices of features (n, k), split in two along their largest spread down to ``size``."""
    return _leaves(features, np.arange(len(features)), size)


def _leaves(features: np.ndarray, members: np.ndarray, size: int) -> list[np.ndarray]:
    if len(members) <= size:
        return [members]
    centred = features[members] - features[members].mean(axis=0)
    direction = np.linalg.eigh(centred.T @ centred)[1][:, -1]
    members = members[np.argsort(centred @ direction, kind="stable")]
    half = max(size, size * round(len(members) / (2 * size)))
    return _leaves(features, members[:half], size) + _leaves(features, members[half:], size)


def _runs(records: EdgeRecords, count: int, clusters: int) -> list[EdgeRecords]:
    """Each cluster's records of ``count`` triangles, filled up to a multiple of eight."""
    faces = np.where(records.faces == count, CLUSTER * clusters, records.faces)
    owners = faces.min(axis=1) // CLUSTER
    order = np.lexsort((faces.max(axis=1), faces.min(axis=1)))
    bounds = np.searchsorted(owners[order], np.arange(clusters + 1))
    runs = []
    for begin, end in pairwise(bounds):
        chosen, missing = order[begin:end], -(end - begin) % RUN
        fill = np.full((missing, 2), CLUSTER * clusters + 1)
        runs.append(
            EdgeRecords(
                np.concatenate([records.vertices[chosen], 0 * fill]).astype(np.int32),
                np.concatenate([faces[chosen], fill]).astype(np.int32),
            )
        )
    return runs


def _ring_plane(faces: np.ndarray, points: np.ndarray, cluster: int, owned: np.ndarray) -> list:
    """The eight numbers by which the faces on both sides of a cluster's records are judged.

    An edge with a triangle on one side only is always a contour: then nothing is known.
    """
    count = faces.shape[1]
    own = np.arange(CLUSTER * cluster, CLUSTER * (cluster + 1))
    ring = np.union1d(own, owned[owned < count])
    plane = joint_plane(faces, points, ring)
    if (owned == count).any():
        plane[4] = np.inf
    return plane


def joint_plane(planes: np.ndarray, points: np.ndarray, chosen: np.ndarray) -> list:
    """m, m . q, max |n - m|, max |n . (p - q)| and largest margins of the chosen faces.

    ``planes`` (6, m) are those of `face_planes`, ``points`` (m, 3) the faces' middles.
    """
    normals, margins = planes[:3, chosen].T, planes[4:, chosen].max(axis=1)
    mean, centre = normals.mean(axis=0), points[chosen].mean(axis=0)
    apart = np.linalg.norm(normals - mean, axis=1).max()
    along = np.abs((normals * (points[chosen] - centre)).sum(axis=1)).max()
    return [*mean, mean @ centre, apart * ROUND_UP, along * ROUND_UP, *margins]
