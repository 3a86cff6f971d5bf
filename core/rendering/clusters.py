"""Faces in clusters of sixteen, so that most edges are known at a glance not to be contours.

Edge records are owned by the lower of the two clusters they join; the set of faces that is judged
for a cluster (see `faces`) holds its own and those across the edges it owns.
"""

from dataclasses import dataclass

import numpy as np

from .faces import Faces, joint_planes
from .records import EdgeRecords

CLUSTER = 16
"""Faces, or edges, to a cluster."""
RUN = 8
"""A cluster's records are filled up to a multiple of this."""
PLACE_WEIGHT = 0.3
"""Of a place, in radii of the segment, against the normal when neighbours are sought."""


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


def clustered_mesh(faces: Faces) -> ClusteredMesh:
    """Clusters of one segment's triangles."""
    order = cluster_order(faces.planes[:3].T, faces.middles)
    filled = np.concatenate([order, np.repeat(order[-1:], -len(order) % CLUSTER)])
    places = np.append(np.argsort(order), len(filled))
    records = EdgeRecords(faces.records.vertices, places[faces.records.faces])
    records, lengths = _in_runs(records, len(filled) // CLUSTER)
    planes = faces.planes[:, filled]
    return ClusteredMesh(
        corners=faces.triangles[filled].astype(np.int32),
        face_planes=planes.astype(np.float32),
        cluster_planes=_ring_planes(planes, faces.middles[filled], records, lengths),
        records=records,
        run_lengths=lengths,
    )


def cluster_order(normals: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(n,) indices of what has normals (n, 3) and places (n, 3) m: every sixteen make a cluster."""
    apart = np.linalg.norm(places - places.mean(axis=0), axis=1) if len(places) else np.ones(1)
    weighed = places * (PLACE_WEIGHT / max(apart.max(), 1e-9))
    features = np.concatenate([normals, weighed], axis=1)
    return np.concatenate(_halves(features, np.arange(len(features))))


def _halves(features: np.ndarray, members: np.ndarray) -> list[np.ndarray]:
    """The members split in two along their largest spread, again and again; the last may lack."""
    if len(members) <= CLUSTER:
        return [members]
    centred = features[members] - features[members].mean(axis=0)
    direction = np.linalg.eigh(centred.T @ centred)[1][:, -1]
    members = members[np.argsort(centred @ direction, kind="stable")]
    half = max(CLUSTER, CLUSTER * round(len(members) / (2 * CLUSTER)))
    return _halves(features, members[:half]) + _halves(features, members[half:])


def _in_runs(records: EdgeRecords, clusters: int) -> tuple[EdgeRecords, np.ndarray]:
    """The records by cluster, each cluster's filled up to a multiple of eight, and its lengths."""
    low, high = records.faces.min(axis=1), records.faces.max(axis=1)
    order = np.lexsort((high, low))
    owners = low[order] // CLUSTER
    counts = np.bincount(owners, minlength=clusters)
    lengths = -(-counts // RUN) * RUN
    at = np.arange(len(order)) + (np.cumsum(lengths - counts) - (lengths - counts))[owners]
    vertices = np.zeros((lengths.sum(), 2), np.int32)
    faces = np.full((lengths.sum(), 2), CLUSTER * clusters + 1, np.int32)
    vertices[at], faces[at] = records.vertices[order], records.faces[order]
    return EdgeRecords(vertices, faces), lengths.astype(np.int32)


def _ring_planes(
    planes: np.ndarray, middles: np.ndarray, records: EdgeRecords, lengths: np.ndarray
) -> np.ndarray:
    """(8, K) float32 by which the faces on both sides of each cluster's records are judged.

    An edge with a triangle on one side only is always a contour: then nothing is known.
    """
    count = planes.shape[1]
    owners = np.repeat(np.arange(len(lengths)), lengths)
    beside = records.faces < count
    sets = np.concatenate([np.arange(count) // CLUSTER, np.repeat(owners, 2)[beside.ravel()]])
    faces = np.concatenate([np.arange(count), records.faces[beside]])
    joint = joint_planes(planes, middles, sets, faces, len(lengths))
    joint[4, owners[(records.faces == count).any(axis=1)]] = np.inf
    return joint.astype(np.float32)
