"""Edge records: which faces meet at every edge of a triangle soup.

Orient every triangle counter-clockwise in the image by a sign s; then an undirected edge p-q carries
the sum over its triangles of s * d, where d is +1 for a triangle that runs from p to q and -1 for
one that runs from q to p. Where the sum vanishes the edge is inside the silhouette of its surface
and need not be drawn; the sum is +-2 at a contour and +-1 at a border. The winding number is
additive, so an edge of k triangles may be cut into ceil(k / 2) records of two triangles each, the
last one with "no triangle" in its second place.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class EdgeRecords:
    """R edge records of one segment.

    Attributes:
        vertices: (R, 2) int32 p and q, p < q.
        faces: (R, 2) int32; the number of triangles stands for "no triangle".
        signs: (R, 2) int8 d of each, 0 for "no triangle".
    """

    vertices: np.ndarray
    faces: np.ndarray
    signs: np.ndarray


def edge_records(triangles: np.ndarray) -> EdgeRecords:
    """The records of triangles (m, 3), ordered by their first triangle.

    Triangles that name a vertex twice never cover anything and take part in no record.
    """
    triangles = np.asarray(triangles, np.int64).reshape(-1, 3)
    starts, ends = triangles, np.roll(triangles, -1, axis=1)
    proper = (starts != ends).all(axis=1)
    faces = np.repeat(np.flatnonzero(proper), 3)
    p, q = starts[proper].ravel(), ends[proper].ravel()
    signs = np.where(p < q, 1, -1)
    low, high = np.minimum(p, q), np.maximum(p, q)
    order = np.lexsort((faces, high, low))
    low, high, faces, signs = low[order], high[order], faces[order], signs[order]

    fresh = np.ones(len(low), bool)
    fresh[1:] = (np.diff(low) != 0) | (np.diff(high) != 0)
    begin = np.flatnonzero(fresh)
    place = np.arange(len(low)) - np.repeat(begin, np.diff(np.append(begin, len(low))))
    first = np.flatnonzero(place % 2 == 0)
    second = np.minimum(first + 1, max(len(low) - 1, 0))
    paired = (second > first) & (place[second] % 2 == 1) if len(low) else np.zeros(0, bool)
    order = np.argsort(faces[first], kind="stable")
    first, second, paired = first[order], second[order], paired[order]
    return EdgeRecords(
        np.stack([low[first], high[first]], axis=1).astype(np.int32),
        np.stack([faces[first], np.where(paired, faces[second], len(triangles))], 1).astype(
            np.int32
        ),
        np.stack([signs[first], np.where(paired, signs[second], 0)], axis=1).astype(np.int8),
    )
