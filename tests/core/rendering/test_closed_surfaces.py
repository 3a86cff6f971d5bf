"""Closed surfaces have a way of their own through the kernel: each turn against the reference."""

from functools import reduce

import numpy as np
import pytest
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.rendering.edges import closed_edges
from silhouette_mocap.core.rendering.faces import faces_of
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator


def star(points: int, depth: float = 0.75, height: float = 0.1):
    """A closed prism over a star; from above, a row crosses up to ``points`` of its points."""
    turn = np.arange(2 * points) * np.pi / points
    radius = np.where(np.arange(2 * points) % 2, 1 - depth, 1.0) * 0.3
    rim = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1)
    vertices = np.concatenate(
        [np.column_stack([rim, np.full(len(rim), z)]) for z in (-height, height)]
        + [[[0, 0, -height], [0, 0, height]]]
    )
    n = len(rim)
    triangles = []
    for k in range(n):
        m = (k + 1) % n
        triangles += [(k, m, n + k), (m, n + m, n + k), (2 * n, m, k), (2 * n + 1, n + k, n + m)]
    return vertices, np.array(triangles)


def box(size, centre):
    """A closed box of eight vertices."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return corners * np.array(size) / 2 + centre, np.array(faces)


def beside(one, two):
    """Two closed surfaces as one segment."""
    return np.concatenate([one[0], two[0]]), np.concatenate([one[1], two[1] + len(one[0])])


def comb(teeth: int):
    """Closed boxes side by side, far apart, as one segment."""
    first, step = np.array([0.01 - 0.025 * teeth, 0, 0.01]), np.array([0.05, 0.03, 0])
    return reduce(beside, [box((0.02, 0.4, 0.02), first + step * k) for k in range(teeth)])


def above(distance: float, focal: float, size) -> Camera:
    """A camera on the z axis, looking down it."""
    width, height = size
    matrix = [[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]]
    return Camera(
        "above", size, matrix, np.column_stack([np.diag([1.0, -1, -1]), [0, 0, distance]])
    )


def check_equal(scenes, pieces, cameras, seed: int, largest: int = 1, spread: float = 0.3):
    """Native and reference energies of a few poses, on every code path of this processor."""
    rng = np.random.default_rng(seed)
    body, maps = scenes.body_of(pieces, rng), scenes.maps_for(cameras, largest, rng)
    poses = rng.normal(0, spread, (3, len(body.dofs)))
    poses[0] = 0
    reference = ReferenceEvaluator(body, cameras)
    wanted = reference.energies(reference.prepared(maps), poses)
    for native in scenes.natives(body, cameras):
        assert all(np.diff(native._body.arrays["edge_starts"]) > 0), "expected closed segments"
        np.testing.assert_array_equal(native.energies(native.prepared(maps), poses), wanted)


@pytest.mark.parametrize("points", [3, 5, 9, 13, 25])
def test_surfaces_that_fold_over_themselves_are_counted_or_left_to_the_slots(scenes, points):
    cameras = [above(2.0, 200, (90, 80)), above(1.5, 60, (64, 48))]
    check_equal(scenes, [star(points), star(points, 0.5, 0.4)], cameras, points, spread=0.05)


@pytest.mark.parametrize("teeth", [2, 4, 9])
def test_pieces_of_one_segment_need_not_hang_together(scenes, teeth):
    rng = np.random.default_rng(1)
    cameras = [above(1.5, 90, (70, 66)), scenes.camera_at(1.2, 60, (65, 40), rng)]
    check_equal(scenes, [comb(teeth)], cameras, teeth)


def joined(one, two):
    """Two closed surfaces as one, hung together by a tube far thinner than a step of the image."""
    vertices, triangles = beside(one, two)
    triangles = triangles.tolist()
    holes = [triangles.pop(len(one[1])), triangles.pop(0)][::-1]
    rings = []
    for hole in holes:
        middle = vertices[hole].mean(axis=0)
        ring = len(vertices) + np.arange(3)
        vertices = np.concatenate([vertices, middle + 1e-9 * (vertices[hole] - middle)])
        triangles += _band(hole, ring)
        rings.append(ring)
    return vertices, np.array(triangles + _band(rings[0], rings[1][[0, 2, 1]]))


def _band(outer, inner):
    """Six triangles between two rings of three."""
    pairs = [(k, (k + 1) % 3) for k in range(3)]
    return [t for k, m in pairs for t in (
        (outer[k], outer[m], inner[k]), (outer[m], inner[m], inner[k])
    )]  # fmt: skip


@pytest.mark.parametrize("join", [False, True])
def test_rows_that_nothing_crosses_make_up_for_no_row_that_is_crossed_too_often(scenes, join):
    # below four plates, one behind the other, hangs a box: the rows between them, empty or crossed
    # by faces without area alone, must not count as crossed twice, nor four windings as none
    plates = [box((0.2, 0.15, 0.02), (0, 0, 0.1 * k)) for k in range(4)]
    pieces = [*plates, box((0.1, 0.1, 0.1), (0.2, -2.2, 0))]
    segment, cameras = reduce(joined if join else beside, pieces), [above(4.0, 200, (60, 300))]
    check_equal(scenes, [segment], cameras, 9, spread=0.01)


def test_edges_through_the_centres_of_pixels_leave_them_to_the_right_hand_side(scenes):
    ring = [(0.5, 0, 0), (0, 0.5, 0), (-0.5, 0, 0), (0, -0.5, 0)]
    vertices = np.array([*ring, (0, 0, -0.3), (0, 0, 0.3)])
    triangles = [(k, (k + 1) % 4, 5) for k in range(4)] + [((k + 1) % 4, k, 4) for k in range(4)]
    cameras = [above(2.0, focal, (64, 64)) for focal in (64, 32, 96)]
    body = scenes.body_of([(vertices, np.array(triangles))], np.random.default_rng(0))
    shift = np.zeros(len(body.dofs))
    shift[:3] = -body.offsets[0]
    reference = ReferenceEvaluator(body, cameras)
    for native in scenes.natives(body, cameras):
        for ours, theirs in zip(
            native.silhouettes(shift), reference.silhouettes(shift), strict=True
        ):
            np.testing.assert_array_equal(ours, theirs)


@pytest.mark.parametrize("distance", [3.0, 12.0, 60.0, 400.0])
def test_faces_down_to_a_fraction_of_a_step_are_exact(scenes, distance):
    rng = np.random.default_rng(2)
    pieces = [scenes.sphere(7, 12, 0.2, rng, 0.0), scenes.sphere(5, 9, 0.02, rng, 0.2)]
    cameras = [scenes.camera_at(distance, 60, (48, 40), rng) for _ in range(3)]
    check_equal(scenes, pieces, cameras, 3)


@pytest.mark.parametrize("largest", [1, 300])
def test_surfaces_wider_than_a_word_and_than_the_picture_are_exact(scenes, largest):
    rng = np.random.default_rng(4)
    pieces = [scenes.sphere(6, 10, 0.35, rng), scenes.sphere(4, 6, 0.1, rng)]
    sizes = [(200, 90), (129, 64), (64, 150), (300, 31)]
    cameras = [scenes.camera_at(d, f, s, rng) for s in sizes for d, f in ((1.6, 190), (0.8, 330))]
    check_equal(scenes, pieces, cameras, 5, largest)


def test_pictures_of_more_rows_than_the_fraction_carries_go_the_general_way(scenes):
    rng = np.random.default_rng(6)
    pieces = [scenes.sphere(3, 5, 0.2, rng)]
    check_equal(scenes, pieces, [scenes.camera_at(1.0, 9000, (3, 8200), rng)], 7)


def test_an_edge_without_a_second_face_takes_the_segment_out(scenes):
    vertices, triangles = scenes.sphere(4, 6, 0.2, np.random.default_rng(0))
    assert len(closed_edges(faces_of(vertices, triangles)).sides) > 0
    assert len(closed_edges(faces_of(vertices, triangles[1:])).sides) == 0


def test_each_edge_stands_once_between_its_two_faces(scenes):
    vertices, triangles = scenes.sphere(4, 6, 0.2, np.random.default_rng(0))
    edges = closed_edges(faces_of(vertices, triangles))
    real = edges.corners.reshape(-1, 4)[edges.sides[:, :3].any(axis=1).ravel()]
    assert len(real) == 3 * len(triangles) // 2
    faces = {tuple(np.roll(t, k)) for t in triangles.tolist() for k in range(3)}
    for p, q, r, s in real.tolist():
        assert (p, q, r) in faces
        assert (q, p, s) in faces


def test_what_stands_still_from_pose_to_pose_is_placed_all_the_same(scenes):
    rng = np.random.default_rng(8)
    body = scenes.body_of([scenes.sphere(4, 6, 0.15, rng) for _ in range(4)], rng)
    cameras = [scenes.camera_at(1.5, 60, (64, 48), rng) for _ in range(9)]
    native = NativeEvaluator(body, cameras)
    weights = native.prepared(scenes.maps_for(cameras, 1, rng))
    poses = np.repeat(rng.normal(0, 0.3, (1, len(body.dofs))), 40, axis=0)
    for pose in poses:
        pose[rng.integers(0, len(pose), 2)] += rng.normal(0, 0.2, 2)
    alone = [native.energies(weights, pose[None])[0] for pose in poses]
    np.testing.assert_array_equal(native.energies(weights, poses), alone)
    per_view = np.stack([np.roll(poses, k, axis=0) for k in range(9)], axis=1)
    by_view = native.energies(weights, per_view)
    for view in range(9):
        np.testing.assert_array_equal(by_view[:, view], np.roll(alone, view, axis=0)[:, view])
