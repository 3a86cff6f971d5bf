"""Edge records: which faces meet at every edge of a triangle soup.

Orient every triangle counter-clockwise in the image by a sign s; then the edge from p to q carries
the sum of s over the triangles that run from p to q, less that over those that run from q to p.
Where the sum vanishes the edge is inside the silhouette of its surface and need not be drawn; the
sum is +-2 at a contour and +-1 at a border. The winding number is additive, so an edge of many
triangles may be cut into records of at most two: one that runs along it and one that runs back.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class EdgeRecords:
    """R edge records of one segment.

    Attributes:
        vertices: (R, 2) int32 p and q, p < q.
        faces: (R, 2) int32 the triangle that runs from p to q and the one that runs from q to p;
            the number of triangles stands for "no triangle".
    """

    vertices: np.ndarray
    faces: np.ndarray


def edge_records(triangles: np.ndarray) -> EdgeRecords:
    """The records of triangles (m, 3).

    Triangles that name a vertex twice never cover anything and take part in no record.
    """
    triangles = np.asarray(triangles, np.int64).reshape(-1, 3)
    starts, ends = triangles, np.roll(triangles, -1, axis=1)
    proper = (starts != ends).all(axis=1)
    p, q = starts[proper].ravel(), ends[proper].ravel()
    back = (p > q).astype(np.int64)
    uses = np.column_stack([np.minimum(p, q), np.maximum(p, q), back])
    faces = np.repeat(np.flatnonzero(proper), 3)

    order = np.lexsort(uses.T[::-1])
    uses, faces = uses[order], faces[order]
    begins = np.flatnonzero(np.diff(uses, axis=0, prepend=-1).any(axis=1))
    rank = np.arange(len(uses)) - np.repeat(begins, np.diff(np.append(begins, len(uses))))
    keys = np.column_stack([uses[:, :2], rank])
    unique, record = np.unique(keys, axis=0, return_inverse=True)
    pairs = np.full((len(unique), 2), len(triangles), np.int32)
    pairs[record.ravel(), uses[:, 2]] = faces
    return EdgeRecords(unique[:, :2].astype(np.int32), pairs)
