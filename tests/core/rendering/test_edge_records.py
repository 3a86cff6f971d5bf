"""Edge records and clusters against the definition of the signed sum."""

from collections import Counter

import numpy as np
from silhouette_mocap.core.rendering.clusters import CLUSTER, RUN, clustered_mesh
from silhouette_mocap.core.rendering.faces import faces_of
from silhouette_mocap.core.rendering.records import edge_records


def signed_sums(records, signs):
    sums = Counter()
    padded = np.append(signs, 0)
    for (p, q), (along, back) in zip(records.vertices.tolist(), records.faces, strict=True):
        sums[p, q] += padded[along] - padded[back]
    return {edge: total for edge, total in sums.items() if total}


def direct_sums(triangles, signs):
    sums = Counter()
    for triangle, sign in zip(triangles.tolist(), signs, strict=True):
        if len(set(triangle)) == 3:
            for p, q in zip(triangle, triangle[1:] + triangle[:1], strict=True):
                sums[min(p, q), max(p, q)] += sign if p < q else -sign
    return {edge: total for edge, total in sums.items() if total}


def test_records_give_the_signed_sum_of_every_edge_of_any_soup():
    rng = np.random.default_rng(0)
    for vertices in (4, 5, 9):
        triangles = rng.integers(0, vertices, (40, 3))
        signs = rng.integers(-1, 2, 40)
        assert signed_sums(edge_records(triangles), signs) == direct_sums(triangles, signs)


def test_a_closed_mesh_has_one_record_for_every_edge(scenes):
    _, triangles = scenes.sphere(5, 8, 1.0, np.random.default_rng(0))
    records = edge_records(triangles)
    assert len(records.vertices) == len(triangles) * 3 // 2
    assert (records.faces < len(triangles)).all()


def test_a_cluster_is_only_passed_over_when_no_record_of_it_is_a_contour(scenes):
    rng = np.random.default_rng(1)
    vertices, triangles = scenes.sphere(18, 36, 1.0, rng, 0.002)
    mesh = clustered_mesh(faces_of(vertices.astype(np.float32), triangles))
    normal, offset = mesh.face_planes[:3].T, mesh.face_planes[3]
    ends = np.cumsum(mesh.run_lengths)
    assert (mesh.run_lengths % RUN == 0).all() and len(mesh.corners) % CLUSTER == 0
    passed = 0
    for camera in rng.normal(0, 4, (50, 3)):
        front = np.append(normal @ camera > offset, [False, False])
        m = mesh.cluster_planes
        side, reach = camera @ m[:3] - m[3], np.linalg.norm(camera) + 1.2
        for cluster in np.flatnonzero(np.abs(side) > reach * m[4] + m[5]):
            run = mesh.records.faces[ends[cluster] - mesh.run_lengths[cluster] : ends[cluster]]
            assert (front[run[:, 0]] == front[run[:, 1]]).all()
            passed += 1
    assert passed > 100
