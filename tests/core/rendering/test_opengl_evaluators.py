"""Both OpenGL modes against the reference and against themselves.

OpenGL computes in single precision, so equality with the reference is not asked for. Vertices are
snapped to 1/256 px by either; where they come out one step apart, an edge moves by 1/256 px, and
pixels may differ whose centres it passes over. Four steps are allowed, as cutting adds to that.
"""

import gc
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.energy.evaluator import WeightMaps
from silhouette_mocap.core.rendering.opengl.atlas import Atlas
from silhouette_mocap.core.rendering.opengl.gpu import OpenGLEvaluator
from silhouette_mocap.core.rendering.opengl.paper import PaperEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator

MODES = [PaperEvaluator, OpenGLEvaluator]
SIZES = [(64, 48), (65, 30), (64, 48), (1, 40), (40, 1), (30, 70)]
NEAR_AN_EDGE_PX = 4 / 256


def make_cameras(scenes, rng, sizes=SIZES):
    """Some of them in the middle of the body, some far away."""
    return [
        scenes.camera_at(
            rng.choice([0.0, 0.15, 0.4, 0.8, 2.0]), rng.choice([8, 40, 200]), size, rng
        )
        for size in sizes
    ]


def weighed(maps, pictures):
    """(V,) the energy as its definition says it."""
    pairs = zip(maps.maps, pictures, maps.constants, strict=True)
    return [int(c) + int(w.astype(np.int64)[p].sum()) for w, p, c in pairs]


@pytest.mark.parametrize("seed", range(4))
def test_both_modes_agree_with_the_reference_but_for_pixels_on_an_edge(scenes, seed):
    rng = np.random.default_rng(seed)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = make_cameras(scenes, rng)
    reference = ReferenceEvaluator(body, cameras)
    maps = scenes.maps_for(cameras, [1, 300][seed % 2], rng)
    poses = rng.normal(0, 0.4, (3, len(body.dofs)))
    parts = [[0, 1], [2], [3, 1], [0, 1, 2, 3]]
    pictures = [[reference.silhouettes(pose, part) for part in parts] for pose in poses]
    cases = 0
    for mode in MODES:
        evaluator = mode(body, cameras)
        weights = evaluator.prepared(maps)
        for k, part in enumerate(parts):
            energies = evaluator.energies(weights, poses, part)
            for n, pose in enumerate(poses):
                drawn = evaluator.silhouettes(pose, part)
                np.testing.assert_array_equal(energies[n], weighed(maps, drawn))
                for v, picture in enumerate(drawn):
                    differing = np.argwhere(picture != pictures[n][k][v])
                    if len(differing):
                        distances = scenes.edge_distances_px(reference, pose, v, part, differing)
                        assert distances.max() < NEAR_AN_EDGE_PX
            cases += energies.size
    assert cases == 144  # 4 seeds make 576


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("largest", [1, 500])
def test_the_moving_part_alone_gives_the_full_energy_to_the_unit(scenes, mode, largest):
    rng = np.random.default_rng(9)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = [scenes.camera_at(1.5, 40, size, rng) for size in SIZES]
    evaluator = mode(body, cameras)
    weights = evaluator.prepared(scenes.maps_for(cameras, largest, rng))
    pose, moving, poses = scenes.moving_part(body, 40, rng)
    masked = evaluator.masked(weights, pose, moving)
    full = evaluator.energies(weights, poses)
    np.testing.assert_array_equal(evaluator.energies(masked, poses, moving), full)
    assert (masked.constants != weights.constants).any() and np.ptp(full, axis=0).any()


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("largest", [1, 500])
def test_windows_change_nothing_for_a_part_inside_and_drop_weights_outside(scenes, mode, largest):
    rng = np.random.default_rng(10)
    body = scenes.body_of([scenes.sphere(5, 7, 0.2, rng), scenes.sphere(5, 7, 0.1, rng)], rng)
    cameras = [scenes.camera_at(2.0, f, s, rng) for f, s in [(60, (150, 90)), (80, (130, 160))]]
    evaluator, reference = mode(body, cameras), ReferenceEvaluator(body, cameras)
    maps = scenes.maps_for(cameras, largest, rng)
    weights = evaluator.prepared(maps)
    pose = rng.normal(0, 0.05, len(body.dofs))
    poses = pose + rng.normal(0, 0.01, (35, len(pose)))
    boxes = evaluator.bounds(poses, [1])
    windows = np.concatenate([boxes.min(axis=0)[:, :2] - 1, boxes.max(axis=0)[:, 2:] + 1], axis=1)
    whole, narrow = (evaluator.masked(weights, pose, [1], w) for w in (None, windows))
    np.testing.assert_array_equal(
        evaluator.energies(narrow, poses, [1]), evaluator.energies(whole, poses, [1])
    )
    theirs = reference.masked(reference.prepared(maps), pose, [1], windows // 2 * 2 - 20)
    ours = evaluator.masked(weights, pose, [1], windows // 2 * 2 - 20)
    left = reference.energies(theirs, poses[:3], [1]) - theirs.constants
    np.testing.assert_array_equal(
        evaluator.energies(ours, poses[:3], [1]) - ours.constants, left
    )  # equal with this seed: no centre is so near to an edge
    nothing = evaluator.masked(weights, pose, [1], np.array([[5, 5, 5, 9], [900, 0, 999, 9]]))
    np.testing.assert_array_equal(
        evaluator.energies(nothing, poses, [1]), np.tile(nothing.constants, (35, 1))
    )


@pytest.mark.parametrize("mode", MODES)
def test_a_candidate_has_its_energy_wherever_it_stands(scenes, mode):
    rng = np.random.default_rng(11)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = make_cameras(scenes, rng, SIZES * 3)  # more than two stencil buffers hold
    evaluator = mode(body, cameras)
    weights = evaluator.prepared(scenes.maps_for(cameras, 1, rng))
    poses = rng.normal(0, 0.4, (75, len(body.dofs)))
    energies = evaluator.energies(weights, poses)
    order = rng.permutation(75)
    np.testing.assert_array_equal(evaluator.energies(weights, poses[order]), energies[order])
    np.testing.assert_array_equal(evaluator.energies(weights, poses[70:71]), energies[70:71])
    assert evaluator.energies(weights, poses[:0]).shape == (0, 18)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("mode", MODES)
def test_a_candidate_that_is_nowhere_changes_no_other(scenes, mode):
    rng = np.random.default_rng(1)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = [scenes.camera_at(1.5, 40, size, rng) for size in [(64, 48), (90, 33)]]
    evaluator = mode(body, cameras)
    weights = evaluator.prepared(scenes.maps_for(cameras, 300, rng))
    poses = rng.normal(0, 0.2, (6, len(body.dofs)))
    expected = evaluator.energies(weights, poses)
    for value in (np.nan, np.inf, 1e300, 1e100, 1e40, 1e20, 1e15):
        for dof in range(len(body.dofs)):
            mixed = np.concatenate([poses, poses[:1]])
            mixed[-1, dof] = value
            found = evaluator.energies(weights, mixed)
            np.testing.assert_array_equal(found[:-1], expected, err_msg=f"{value} in {dof}")
            if np.isnan(value):
                moved = {int(body.dofs.joints[dof])}
                for joint, parent in enumerate(body.parents):
                    if parent in moved:
                        moved.add(joint)
                others = [s for s, joint in enumerate(body.segment_joints) if joint not in moved]
                left = evaluator.energies(weights, poses[:1], others)
                np.testing.assert_array_equal(found[-1:], left, err_msg=f"{value} in {dof}")


@pytest.mark.parametrize("mode", MODES)
def test_views_are_kept_apart(scenes, mode):
    rng = np.random.default_rng(12)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = make_cameras(scenes, rng, [(50, 40)] * 10 + SIZES)  # a stencil buffer has eight bits
    maps = scenes.maps_for(cameras, 1, rng)
    evaluator = mode(body, cameras)
    weights = evaluator.prepared(maps)
    poses = rng.normal(0, 0.4, (6, len(cameras), len(body.dofs)))
    energies = evaluator.energies(weights, poses)
    for v, camera in enumerate(cameras):
        alone = mode(body, [camera])
        own = alone.prepared(WeightMaps(maps.maps[v : v + 1], maps.constants[v : v + 1]))
        np.testing.assert_array_equal(alone.energies(own, poses[:, v])[:, 0], energies[:, v])
    order = rng.permutation(len(cameras))
    turned = mode(body, [cameras[v] for v in order])
    mixed = WeightMaps(tuple(maps.maps[v] for v in order), maps.constants[order])
    found = turned.energies(turned.prepared(mixed), poses[:, order])
    np.testing.assert_array_equal(found, energies[:, order])
    drawn = evaluator.silhouettes(poses[0])
    np.testing.assert_array_equal(energies[0], weighed(maps, drawn))


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("weight", [32767, -32768])
def test_sums_beyond_32_bits_are_exact(scenes, mode, weight):
    rng = np.random.default_rng(13)
    corners = np.array([[-40.0, -20, 0], [40, -20, 0], [0, 60, 0]])
    body = scenes.body_of([(corners, [[0, 1, 2]])], rng)
    matrix = [[30, 0, 200], [0, 30, 150], [0, 0, 1]]
    shift = [0, 0, 1] - body.offsets[0]
    camera = Camera("far", (400, 300), matrix, np.column_stack([np.eye(3), shift]))
    evaluator = mode(body, [camera])
    maps = WeightMaps((np.full((300, 400), weight, np.int16),), np.array([1 << 40]))
    energies = evaluator.energies(evaluator.prepared(maps), body.rest_pose[None])
    assert energies[0, 0] == (1 << 40) + 300 * 400 * weight  # the triangle fills the picture


@pytest.mark.parametrize("mode", MODES)
def test_a_surface_that_passes_the_camera_is_cut_and_not_mirrored(scenes, mode):
    rng = np.random.default_rng(6)
    corners = np.array([[-1.0, 0.3, -5], [1.0, 0.3, -5], [1.0, 0.3, 5], [-1.0, 0.3, 5]])
    body = scenes.body_of([(corners, [[0, 1, 2], [0, 2, 3]])], rng)
    matrix = [[20, 0, 31.5], [0, 20, 23.5], [0, 0, 1]]
    camera = Camera("inside", (64, 48), matrix, np.column_stack([np.eye(3), -body.offsets[0]]))
    picture = mode(body, [camera]).silhouettes(body.rest_pose)[0]
    # the floor 0.3 m below the axis reaches 5 m far: the horizon lies 20 * 0.3 / 5 px below it
    assert not picture[:25].any()
    assert picture[25, 31] and picture[47, 31]
    reference = ReferenceEvaluator(body, [camera]).silhouettes(body.rest_pose)[0]
    np.testing.assert_array_equal(picture, reference)


def test_blocks_and_batches_that_do_not_fit_at_once_change_nothing(scenes, monkeypatch):
    rng = np.random.default_rng(14)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = make_cameras(scenes, rng)
    maps = scenes.maps_for(cameras, 300, rng)
    poses = rng.normal(0, 0.4, (70, len(body.dofs)))
    evaluator = OpenGLEvaluator(body, cameras)
    energies = evaluator.energies(evaluator.prepared(maps), poses)
    monkeypatch.setattr(Atlas, "most_px", 5000)  # one to three views at once, 32 candidates
    weights = evaluator.prepared(maps)
    assert len(weights.blocks) > 1
    np.testing.assert_array_equal(evaluator.energies(weights, poses), energies)
    narrow = OpenGLEvaluator(body, cameras)
    for one, other in zip(
        narrow.silhouettes(poses[0]), evaluator.silhouettes(poses[0]), strict=True
    ):
        np.testing.assert_array_equal(one, other)


def test_threads_may_call_both_modes_at_once(scenes):
    rng = np.random.default_rng(15)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = make_cameras(scenes, rng)
    maps = scenes.maps_for(cameras, 1, rng)
    poses = rng.normal(0, 0.4, (24, 4, len(body.dofs)))
    evaluators = [mode(body, cameras) for mode in MODES]
    weights = [evaluator.prepared(maps) for evaluator in evaluators]
    expected = [[e.energies(w, p) for p in poses] for e, w in zip(evaluators, weights, strict=True)]

    def run(number):
        mode, batch = number % 2, number // 2
        found = evaluators[mode].energies(weights[mode], poses[batch])
        return np.array_equal(found, expected[mode][batch])

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(run, range(48)))


@pytest.mark.parametrize("per_view", [False, True])
def test_bounds_and_transforms_are_those_of_the_reference(scenes, per_view):
    rng = np.random.default_rng(16)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = make_cameras(scenes, rng)
    evaluator, reference = OpenGLEvaluator(body, cameras), ReferenceEvaluator(body, cameras)
    shape = (5, len(cameras), len(body.dofs)) if per_view else (5, len(body.dofs))
    poses = rng.normal(0, 0.4, shape)
    for part in ([0, 1], [2], []):
        boxes = evaluator.bounds(poses, part)
        np.testing.assert_array_equal(boxes, reference.bounds(poses, part))
    assert evaluator.bounds(poses[:0], [0]).shape == (0, len(cameras), 4)
    if not per_view:
        assert evaluator.transforms(poses[:0]).shape == (0, 4, 3, 4)
        ours, theirs = evaluator.transforms(poses), reference.transforms(poses)
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-14)


def test_weights_that_nobody_holds_any_more_leave_the_device(scenes):
    rng = np.random.default_rng(17)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = make_cameras(scenes, rng)
    evaluator = OpenGLEvaluator(body, cameras)
    weights = evaluator.prepared(scenes.maps_for(cameras, 1, rng))
    textures = [block.weights for block in weights.blocks]
    is_texture = evaluator.thread.gl.glIsTexture
    assert all(evaluator.thread.call(is_texture, name) for name in textures)
    del weights
    gc.collect()
    assert not any(evaluator.thread.call(is_texture, name) for name in textures)


@pytest.mark.parametrize("mode", MODES)
def test_what_cannot_be_drawn_is_refused(scenes, mode):
    rng = np.random.default_rng(18)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    camera = scenes.camera_at(2.0, 60, (40, 30), rng)
    lens = Camera("lens", (40, 30), camera.matrix, camera.camera_from_world, [0.1, 0, 0, 0])
    with pytest.raises(ValueError, match="pinhole"):
        mode(body, [lens])
    evaluator = mode(body, [camera])
    with pytest.raises(ValueError, match="shape"):
        evaluator.energies(evaluator.prepared(scenes.maps_for([camera], 1, rng)), np.zeros((2, 3)))
    with pytest.raises(ValueError, match="shapes"):
        evaluator.prepared(WeightMaps((np.zeros((4, 4), np.int16),), np.zeros(1)))
    with pytest.raises(ValueError, match="segments"):
        evaluator.silhouettes(body.rest_pose, [4])
