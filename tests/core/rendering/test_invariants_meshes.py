"""Meshes and places that are no textbook's: every evaluator must make the same sense of them."""

from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.opengl.gpu import OpenGLEvaluator
from silhouette_mocap.core.rendering.opengl.paper import PaperEvaluator

SIZE = (72, 50)


def everyone(scenes, body, cameras):
    """The reference, the kernel on every code path, and both modes of OpenGL."""
    return [
        *scenes.exact(body, cameras),
        PaperEvaluator(body, cameras),
        OpenGLEvaluator(body, cameras),
    ]


def still(scenes, vertices, triangles):
    """A body of one segment whose root stands in the origin."""
    body = scenes.body_of([(np.asarray(vertices, float), triangles)], np.random.default_rng(0))
    return replace(body, offsets=np.zeros_like(body.offsets))


def front(distance: float, focal: float = 64.0, size=SIZE) -> Camera:
    """A camera on the z axis, at -distance, looking along it; x to the right, y down."""
    matrix = [[focal, 0, size[0] / 2], [0, focal, size[1] / 2], [0, 0, 1]]
    return Camera("front", size, matrix, np.column_stack([np.eye(3), [0, 0, distance]]))


def pictures_of(evaluators, pose=None):
    """Each evaluator's first picture, at rest or in a pose."""
    return [e.silhouettes(e.body.rest_pose if pose is None else pose)[0] for e in evaluators]


def cylinder(around: int, radius: float, half: float, caps: bool = False):
    """A pipe along the z axis, open at both ends or closed."""
    turn = np.arange(around) * 2 * np.pi / around
    rim = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    ends = [np.column_stack([rim, np.full(around, z)]) for z in (-half, half)]
    vertices = np.concatenate([*ends, [[0, 0, -half], [0, 0, half]]])
    triangles = []
    for k in range(around):
        n = (k + 1) % around
        triangles += [(k, n, around + k), (n, around + n, around + k)]
        if caps:
            triangles += [(2 * around, n, k), (2 * around + 1, around + k, around + n)]
    return vertices, np.array(triangles)


def test_a_camera_inside_a_segment_sees_nothing_else(scenes):
    vertices, triangles = scenes.sphere(6, 9, 0.3, np.random.default_rng(0))
    body = still(scenes, vertices, triangles)
    for place in (0.0, 0.1):
        for picture in pictures_of(everyone(scenes, body, [front(place)])):
            assert picture.all()


def test_what_is_nearer_than_a_centimetre_is_cut_off(scenes):
    # all in front of the camera: the tip at 5 mm would be seen 64 * 2 px right of the middle, but
    # the surface ends where it is 1 cm away, at most 64 px right of it
    corners = [[0.01, 0, 0.005], [-0.005, -0.01, 0.06], [0.01, -0.01, 0.06], [0, 0.01, 0.06]]
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    camera = front(0.0, size=(256, 50))
    for triangles in (faces, faces[:3]):
        body = still(scenes, corners, triangles)
        for picture in pictures_of(everyone(scenes, body, [camera])):
            assert picture[:, 170:180].any() and not picture[:, 193:].any()
        wanted, *others = pictures_of(scenes.exact(body, [camera]))
        for picture in others:
            np.testing.assert_array_equal(picture, wanted)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_far_from_the_origin_what_passes_a_camera_is_cut_all_the_same(scenes, sign):
    # 2^40 m away, where steps of 2^-12 m are left; vertices and cameras lie on whole steps
    vertices, triangles = scenes.sphere(6, 9, 0.25, np.random.default_rng(7))
    body = still(scenes, np.round(vertices * 4096) / 4096, triangles)
    pose = np.zeros(len(body.dofs))
    here = [front(distance, 16.0) for distance in (0.0, 0.125, 0.25, 0.375)]
    wanted = NativeEvaluator(body, here).silhouettes(pose)
    assert any(picture.any() and not picture.all() for picture in wanted)
    pose[:3] = sign * 2**40
    shift = np.outer(pose[:3], [0, 0, 0, 1])
    there = [replace(c, camera_from_world=c.camera_from_world - shift) for c in here]
    for evaluator in scenes.exact(body, there):
        for picture, twin in zip(evaluator.silhouettes(pose), wanted, strict=True):
            np.testing.assert_array_equal(picture, twin)


def test_a_surface_as_small_as_the_steps_of_its_place_is_cut_all_the_same(scenes):
    # whether a ball of three steps passes a camera that it all but touches is a matter of rounding
    rng = np.random.default_rng(8)
    place, step = np.full(3, 2.0**40), 2.0**-12
    vertices, triangles = scenes.sphere(6, 9, 3 * step, rng, 0.0)
    body = still(scenes, vertices, triangles)
    pose = np.concatenate([place, np.zeros(len(body.dofs) - 3)])
    matrix = [[300, 0, 24], [0, 300, 20], [0, 0, 1]]
    cameras = []
    for vertex in rng.choice(vertices, 60):
        z = -vertex / np.linalg.norm(vertex)
        x = np.cross(z, [1, 0.3, 0.2])
        axes = np.stack([x / np.linalg.norm(x), np.cross(z, x) / np.linalg.norm(x), z])
        depth = 0.01 + step * (3 + rng.uniform(-6, 6))
        transform = np.column_stack([axes, [0, 0, depth] - axes @ place])
        cameras.append(Camera("far", (48, 40), matrix, transform))
    wanted, *others = (evaluator.silhouettes(pose) for evaluator in scenes.exact(body, cameras))
    for pictures in others:
        for picture, twin in zip(pictures, wanted, strict=True):
            np.testing.assert_array_equal(picture, twin)


def test_what_lies_behind_a_camera_weighs_nothing(scenes):
    rng = np.random.default_rng(1)
    body = still(scenes, *scenes.sphere(4, 7, 0.3, rng))
    cameras = [front(-1.0), front(-0.35)]
    maps = scenes.maps_for(cameras, 300, rng)
    for evaluator in everyone(scenes, body, cameras):
        energies = evaluator.energies(evaluator.prepared(maps), body.rest_pose[None])
        np.testing.assert_array_equal(energies[0], maps.constants)
        assert not evaluator.silhouettes(body.rest_pose)[0].any()


def test_a_triangle_over_all_borders_fills_the_picture_and_one_over_some_its_part(scenes):
    corners = [[-50, -50, 0], [50, -50, 0], [0, 90, 0]]
    for picture in pictures_of(everyone(scenes, still(scenes, corners, [[0, 1, 2]]), [front(1.0)])):
        assert picture.all()
    # left of x = 0 m, that is of column 36, and above y = 0.125 m, row 33
    corners = [[-9, 0.125, 0], [0, 0.125, 0], [0, -9, 0], [-9, -9, 0]]
    body = still(scenes, corners, [[0, 1, 2], [2, 3, 0]])
    expected = np.zeros(SIZE[::-1], bool)
    expected[:33, :36] = True
    for picture in pictures_of(everyone(scenes, body, [front(1.0)])):
        np.testing.assert_array_equal(picture, expected)


def test_triangles_that_pass_the_camera_and_all_borders_are_the_same_for_all(scenes):
    rng = np.random.default_rng(2)
    covered = 0
    for size in (0.3, 3.0, 300.0):
        body = still(scenes, *scenes.soup(rng, 8, 6, size))
        reference, *native = scenes.exact(body, [front(0.2), front(0.0, 20), front(2.0, 900)])
        for pose in rng.normal(0, 0.5, (2, len(body.dofs))):
            wanted = reference.silhouettes(pose)
            for evaluator in native:
                for picture, twin in zip(evaluator.silhouettes(pose), wanted, strict=True):
                    np.testing.assert_array_equal(picture, twin)
            covered += sum(picture.sum() for picture in wanted)
    assert covered > 1000


def spoilt(vertices, triangles, how, rng):
    """The same surface, written in a way that must not matter."""
    some = triangles[rng.integers(0, len(triangles), 9)]
    if how == "duplicated":
        return vertices, np.concatenate([triangles, some])
    if how == "duplicated and turned over":
        return vertices, np.concatenate([triangles, some[:, ::-1]])
    if how == "all turned over":
        return vertices, triangles[:, ::-1]
    if how == "some turned over":
        turned = rng.random(len(triangles)) < 0.4
        return vertices, np.where(turned[:, None], triangles[:, ::-1], triangles)
    if how == "with points for triangles":
        flat = some[:, [0, 0, 1]], some[:, [2, 2, 2]], some[:, [0, 1, 0]]
        return vertices, np.concatenate([*flat, triangles])
    if how == "with lines for triangles":  # of vertices in the same place
        twins = len(vertices) + np.arange(len(some))
        lines = np.column_stack([some[:, :2], twins])
        return np.concatenate([vertices, vertices[some[:, 0]]]), np.concatenate([triangles, lines])
    if how == "without shared vertices":
        return vertices[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)
    raise ValueError(how)


@pytest.mark.parametrize("is_open", [False, True])
@pytest.mark.parametrize(
    "how",
    [
        "duplicated",
        "duplicated and turned over",
        "all turned over",
        "some turned over",
        "with points for triangles",
        "with lines for triangles",
        "without shared vertices",
    ],
)
def test_the_same_surface_written_otherwise_is_the_same_silhouette(scenes, how, is_open):
    rng = np.random.default_rng(3)
    vertices, triangles = scenes.sphere(6, 11, 0.3, rng)
    triangles = triangles[::2] if is_open else triangles
    cameras = [front(1.2), front(0.4, 20), front(0.05)]
    plain = still(scenes, vertices, triangles)
    other = still(scenes, *spoilt(vertices, triangles, how, rng))
    for pose in rng.normal(0, 0.2, (2, len(plain.dofs))):
        wanted = NativeEvaluator(plain, cameras).silhouettes(pose)
        for evaluator in scenes.exact(other, cameras):
            for picture, twin in zip(evaluator.silhouettes(pose), wanted, strict=True):
                np.testing.assert_array_equal(picture, twin)
        assert wanted[0].any()


def test_opengl_takes_duplicated_and_flat_faces_like_any(scenes):
    rng = np.random.default_rng(4)
    vertices, triangles = scenes.sphere(4, 7, 0.3, rng)
    cameras = [front(1.2)]
    pose = rng.normal(0, 0.2, 15)
    for mode in (PaperEvaluator, OpenGLEvaluator):
        wanted = mode(still(scenes, vertices, triangles), cameras).silhouettes(pose)[0]
        for how in ("duplicated and turned over", "with points for triangles"):
            other = still(scenes, *spoilt(vertices, triangles, how, rng))
            np.testing.assert_array_equal(mode(other, cameras).silhouettes(pose)[0], wanted)


def test_a_t_junction_leaves_no_gap_and_covers_no_more(scenes):
    square = [[-0.25, -0.25, 0], [0.25, -0.25, 0], [0.25, 0.25, 0], [-0.25, 0.25, 0]]
    middle = [0.0, 0.0, 0.0]  # on the diagonal: a vertex of one half only
    whole = still(scenes, square, [[0, 1, 2], [0, 2, 3]])
    split = still(scenes, [*square, middle], [[0, 1, 2], [0, 4, 3], [4, 2, 3]])
    expected = np.zeros(SIZE[::-1], bool)
    expected[9:41, 20:52] = True  # 64 px to the metre: 32 x 32 px
    for body in (whole, split):
        for picture in pictures_of(everyone(scenes, body, [front(1.0)])):
            np.testing.assert_array_equal(picture, expected)


def test_a_box_on_pixel_centres_covers_its_left_and_top_but_not_its_right_and_bottom(scenes):
    corners = [(x, y, z) for x in (-0.25, 0.25) for y in (-0.25, 0.25) for z in (0.0, 0.5)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    expected = np.zeros(SIZE[::-1], bool)
    expected[9:41, 20:52] = True  # the near side, 64 px to the metre
    for picture in pictures_of(everyone(scenes, still(scenes, corners, faces), [front(1.0)])):
        np.testing.assert_array_equal(picture, expected)


def test_an_open_cylinder_is_seen_through_and_a_closed_one_is_not(scenes):
    pipe, can = (still(scenes, *cylinder(24, 0.25, 0.3, caps)) for caps in (False, True))
    for hollow, full in zip(
        pictures_of(everyone(scenes, pipe, [front(1.0)])),
        pictures_of(everyone(scenes, can, [front(1.0)])),
        strict=True,
    ):
        # the far end's radius is 64 * 0.25 / 1.3 = 12.3 px, the near one's 64 * 0.25 / 0.7 = 22.9
        y, x = np.mgrid[: SIZE[1], : SIZE[0]]
        radius = np.hypot(x - SIZE[0] / 2, y - SIZE[1] / 2)
        assert not hollow[radius < 12].any() and hollow[(radius > 13) & (radius < 22)].all()
        assert full[radius < 22].all() and not (full | hollow)[radius > 23].any()


def test_open_cylinders_are_the_same_for_all_from_every_side_and_from_inside(scenes):
    rng = np.random.default_rng(5)
    body = still(scenes, *cylinder(17, 0.25, 0.4))
    cameras = [front(1.0), front(0.1), front(0.6, 30), front(5.0, 300)]
    reference, *native = scenes.exact(body, cameras)
    for pose in rng.normal(0, 0.8, (4, len(body.dofs))) * np.repeat([0.1, 1], [3, 12]):
        wanted = reference.silhouettes(pose)
        for evaluator in native:
            for picture, twin in zip(evaluator.silhouettes(pose), wanted, strict=True):
                np.testing.assert_array_equal(picture, twin)


def test_outlines_of_triangles_apart_have_all_their_edges(scenes):
    rng = np.random.default_rng(6)
    starts = rng.normal(0, 0.3, (50, 1, 3))
    vertices = (starts + rng.normal(0, 0.04, (50, 3, 3))).reshape(-1, 3)
    body = still(scenes, vertices, np.arange(150).reshape(-1, 3))
    reference, *native = scenes.exact(body, [front(2.0, 300, (300, 200))])
    wanted = reference.outline(body.rest_pose)[0]
    assert len(wanted.px) > 500
    for evaluator in native:
        found = evaluator.outline(body.rest_pose)[0]
        ours, theirs = (o.px[np.lexsort(o.px.T)] for o in (found, wanted))
        np.testing.assert_allclose(ours, theirs, atol=1e-9)
