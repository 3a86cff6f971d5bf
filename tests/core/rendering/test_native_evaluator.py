"""The native kernel against the reference: equal integers, whatever the mesh, pose and picture."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.energy.evaluator import WeightMaps
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator

SIZES = [(64, 48), (65, 30), (63, 33), (1, 40), (40, 1), (30, 70)]


def check_equal(native, reference, maps, poses, parts):
    ours, theirs = native.prepared(maps), reference.prepared(maps)
    cases = 0
    for part in parts:
        energies = native.energies(ours, poses, part)
        np.testing.assert_array_equal(energies, reference.energies(theirs, poses, part))
        cases += energies.size
    return cases


@pytest.mark.parametrize("seed", range(20))
def test_kernel_and_reference_agree_on_every_pose_camera_and_part(scenes, seed):
    rng = np.random.default_rng(seed)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = [
        scenes.camera_at(
            rng.choice([0.0, 0.15, 0.4, 0.8, 2.0]), rng.choice([8, 40, 200]), size, rng
        )
        for size in SIZES
    ]
    maps = scenes.maps_for(cameras, [1, 300][seed % 2], rng)
    poses = rng.normal(0, 0.4, (3, len(body.dofs)))
    native, reference = NativeEvaluator(body, cameras), ReferenceEvaluator(body, cameras)
    cases = check_equal(native, reference, maps, poses, [[0, 1], [2], [3, 1], None])
    assert cases == 72  # 20 seeds make 1,440


def test_kernel_and_reference_agree_where_clusters_of_faces_are_skipped(scenes):
    rng = np.random.default_rng(3)
    balls = scenes.sphere(16, 24, 0.3, rng, 0.002), scenes.sphere(9, 40, 0.2, rng, 0.0)
    body = scenes.body_of(balls, rng)
    cameras = [
        scenes.camera_at(d, f, s, rng) for d, f, s in [(1.2, 40, (64, 48)), (3, 150, (65, 60))]
    ]
    poses = rng.normal(0, 0.3, (4, len(body.dofs)))
    maps = scenes.maps_for(cameras, 1, rng)
    native, reference = NativeEvaluator(body, cameras), ReferenceEvaluator(body, cameras)
    check_equal(native, reference, maps, poses, [None])
    assert native.silhouettes(poses[0])[0].sum() > 100


def test_kernel_and_reference_agree_on_faces_as_small_as_the_snapping(scenes):
    rng = np.random.default_rng(4)
    body = scenes.body_of([scenes.sphere(14, 20, 0.02, rng)], rng)
    cameras = [scenes.camera_at(2.0, focal, (40, 40), rng) for focal in (10, 60, 400)]
    poses = rng.normal(0, 0.01, (3, len(body.dofs)))
    maps = scenes.maps_for(cameras, 1, rng)
    native, reference = NativeEvaluator(body, cameras), ReferenceEvaluator(body, cameras)
    check_equal(native, reference, maps, poses, [None])


def test_contours_and_single_triangles_give_the_same_picture_of_dense_meshes(scenes):
    rng = np.random.default_rng(16)
    cameras = [scenes.camera_at(2.5, 60, (64, 48), rng), scenes.camera_at(4, 400, (90, 120), rng)]
    for bumps in (0.0, 0.002, 0.02):
        vertices, triangles = scenes.sphere(60, 80, 0.3, rng, bumps)
        # a vertex that no triangle names, far behind the cameras, makes the kernel clip the segment
        far = np.concatenate([vertices, [[1e6, 0, 0]]])
        fast, slow = (
            NativeEvaluator(
                scenes.body_of([(points, triangles)], np.random.default_rng(0)), cameras
            )
            for points in (vertices, far)
        )
        for pose in rng.normal(0, 0.2, (40, len(fast.body.dofs))):
            for picture, twin in zip(fast.silhouettes(pose), slow.silhouettes(pose), strict=True):
                np.testing.assert_array_equal(picture, twin)


def test_rows_with_more_crossings_than_slots_are_still_exact(scenes):
    rng = np.random.default_rng(5)
    body = scenes.body_of([scenes.soup(rng, 60, 60, 0.4)], rng)
    cameras = [scenes.camera_at(2.0, 60, (64, 48), rng)]
    native, reference = NativeEvaluator(body, cameras), ReferenceEvaluator(body, cameras)
    for pose in rng.normal(0, 0.3, (3, len(body.dofs))):
        np.testing.assert_array_equal(native.silhouettes(pose)[0], reference.silhouettes(pose)[0])


def test_a_surface_that_passes_the_camera_is_clipped_and_not_mirrored(scenes):
    rng = np.random.default_rng(6)
    corners = np.array([[-1.0, 0.3, -5], [1.0, 0.3, -5], [1.0, 0.3, 5], [-1.0, 0.3, 5]])
    body = scenes.body_of([(corners, [[0, 1, 2], [0, 2, 3]])], rng)
    matrix = [[20, 0, 31.5], [0, 20, 23.5], [0, 0, 1]]
    camera = Camera("inside", (64, 48), matrix, np.column_stack([np.eye(3), -body.offsets[0]]))
    picture = NativeEvaluator(body, [camera]).silhouettes(body.rest_pose)[0]
    # the floor 0.3 m below the axis reaches 5 m far: the horizon lies 20 * 0.3 / 5 px below it
    assert not picture[:25].any()
    assert picture[25, 31] and picture[47, 31]
    np.testing.assert_array_equal(
        picture, ReferenceEvaluator(body, [camera]).silhouettes(body.rest_pose)[0]
    )


def test_cameras_slightly_off_a_rotation_are_exact_far_from_the_origin(scenes):
    rng = np.random.default_rng(4)
    body = scenes.body_of([scenes.sphere(9, 14, 0.25, rng, 0.02)] * 2, rng)
    pose = rng.normal(0, 0.1, len(body.dofs))
    pose[:3] = 1000 / np.sqrt(3)
    cameras = []
    for k in range(6):
        # R^T is off the inverse of R by 8e-5: 8 cm at 1000 m, a tenth of the way to the surface
        stretch = np.eye(3) + 4e-5 * np.diag(rng.choice([-1, 1], 3))
        rotation = Rotation.random(random_state=k).as_matrix() @ stretch
        place = np.column_stack([rotation, [0, 0, 1.2] - rotation @ pose[:3]])
        cameras.append(Camera("far", (90, 70), [[70, 0, 45], [0, 70, 35], [0, 0, 1]], place))
    reference = ReferenceEvaluator(body, cameras).silhouettes(pose)
    for native in scenes.natives(body, cameras):
        for ours, theirs in zip(native.silhouettes(pose), reference, strict=True):
            np.testing.assert_array_equal(ours, theirs)
            assert theirs.any()


def test_bounds_hold_the_silhouette_and_touch_it(scenes):
    rng = np.random.default_rng(7)
    body = scenes.body_of([scenes.sphere(6, 9, 0.2, rng), scenes.sphere(6, 9, 0.1, rng)], rng)
    cameras = [scenes.camera_at(3.0, 60, (120, 90), rng)]
    native, reference = NativeEvaluator(body, cameras), ReferenceEvaluator(body, cameras)
    poses = rng.normal(0, 0.1, (4, len(body.dofs)))
    boxes = native.bounds(poses, [0, 1])
    np.testing.assert_array_equal(boxes, reference.bounds(poses, [0, 1]))
    for pose, (x0, y0, x1, y1) in zip(poses, boxes[:, 0], strict=True):
        rows, columns = np.nonzero(native.silhouettes(pose)[0])
        assert (x0 <= columns.min() <= x0 + 1) and (x1 - 1 <= columns.max() + 1 <= x1)
        assert (y0 <= rows.min() <= y0 + 1) and (y1 - 1 <= rows.max() + 1 <= y1)


def test_snapped_vertices_lie_within_half_a_step_of_the_projection(scenes):
    rng = np.random.default_rng(8)
    body = scenes.body_of([scenes.sphere(6, 9, 0.2, rng)], rng)
    camera = scenes.camera_at(3.0, 900, (1920, 1080), rng)
    native = NativeEvaluator(body, [camera])
    pose = rng.normal(0, 0.1, len(body.dofs))
    transform = native.transforms(pose[None])[0, 0]
    world = body.surfaces[0].vertices.astype(float) @ transform[:, :3].T + transform[:, 3]
    error_px = native.snapped(pose)[0] / 256 - camera.project(world)
    assert np.abs(error_px).max() <= 0.5 / 256 + 1e-9


@pytest.mark.parametrize("largest", [1, 500])
def test_masked_weights_give_the_full_energy_from_the_moving_part_alone(scenes, largest):
    rng = np.random.default_rng(9)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = [scenes.camera_at(1.5, 40, size, rng) for size in SIZES]
    native = NativeEvaluator(body, cameras)
    weights = native.prepared(scenes.maps_for(cameras, largest, rng))
    pose, moving, poses = scenes.moving_part(body, 8, rng)
    masked = native.masked(weights, pose, moving)
    np.testing.assert_array_equal(
        native.energies(masked, poses, moving), native.energies(weights, poses)
    )
    assert (masked.constants != weights.constants).any()


@pytest.mark.parametrize("largest", [1, 500])
def test_windows_change_nothing_for_a_part_inside_and_drop_weights_outside(scenes, largest):
    rng = np.random.default_rng(10)
    body = scenes.body_of([scenes.sphere(5, 7, 0.2, rng), scenes.sphere(5, 7, 0.1, rng)], rng)
    cameras = [scenes.camera_at(2.0, 60, (150, 90), rng)]
    native, reference = NativeEvaluator(body, cameras), ReferenceEvaluator(body, cameras)
    maps = scenes.maps_for(cameras, largest, rng)
    weights = native.prepared(maps)
    pose = rng.normal(0, 0.1, len(body.dofs))
    tight = native.bounds(pose[None], [1])[0]
    inside = native.masked(weights, pose, [1], tight)
    full = native.masked(weights, pose, [1])
    np.testing.assert_array_equal(
        native.energies(inside, pose[None], [1]), native.energies(full, pose[None], [1])
    )
    cut = tight + np.array([[3, 3, -3, -3]])
    expected = reference.masked(reference.prepared(maps), pose, [1], cut)
    np.testing.assert_array_equal(
        native.energies(native.masked(weights, pose, [1], cut), pose[None], [1]),
        reference.energies(expected, pose[None], [1]),
    )


def test_poses_per_view_are_seen_by_their_own_view_only(scenes):
    rng = np.random.default_rng(11)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = [scenes.camera_at(1.5, 40, size, rng) for size in SIZES[:3]]
    native = NativeEvaluator(body, cameras)
    weights = native.prepared(scenes.maps_for(cameras, 1, rng))
    poses = rng.normal(0, 0.3, (5, 3, len(body.dofs)))
    per_view = native.energies(weights, poses, [0, 2])
    for view in range(3):
        alone = native.energies(weights, poses[:, view], [0, 2])[:, view]
        np.testing.assert_array_equal(per_view[:, view], alone)
    boxes = native.bounds(poses, [0])
    np.testing.assert_array_equal(boxes[:, 1], native.bounds(poses[:, 1], [0])[:, 1])


def test_threads_and_code_paths_give_the_same_integers(scenes):
    rng = np.random.default_rng(12)
    body = scenes.body_of([*scenes.mixed_pieces(rng), scenes.sphere(9, 12, 0.2, rng)], rng)
    cameras = [scenes.camera_at(1.5, 60, size, rng) for size in SIZES]
    maps = scenes.maps_for(cameras, 2, rng)
    poses = rng.normal(0, 0.3, (23, len(body.dofs)))
    spread = [NativeEvaluator(body, cameras, threads=threads) for threads in (1, 3)]
    results = [
        evaluator.energies(evaluator.prepared(maps), poses)
        for evaluator in (*spread, *scenes.natives(body, cameras))
    ]
    for result in results[1:]:
        np.testing.assert_array_equal(result, results[0])


def test_batches_are_the_single_candidates_one_by_one(scenes):
    rng = np.random.default_rng(13)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = [scenes.camera_at(1.5, 40, (64, 48), rng)]
    native = NativeEvaluator(body, cameras)
    weights = native.prepared(scenes.maps_for(cameras, 1, rng))
    poses = rng.normal(0, 0.3, (6, len(body.dofs)))
    singles = [native.energies(weights, pose[None])[0] for pose in poses]
    np.testing.assert_array_equal(native.energies(weights, poses), singles)
    assert native.energies(weights, poses[:0]).shape == (0, 1)


def test_poses_of_nan_cover_nothing(scenes):
    rng = np.random.default_rng(14)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    cameras = [scenes.camera_at(1.5, 40, (64, 48), rng)]
    native = NativeEvaluator(body, cameras)
    maps = scenes.maps_for(cameras, 1, rng)
    for value in (np.nan, np.inf, 1e300):
        poses = np.full((1, len(body.dofs)), value)
        native.bounds(poses, [0])
        np.testing.assert_array_equal(
            native.energies(native.prepared(maps), poses)[0], maps.constants
        )


def test_programmers_mistakes_are_named(scenes):
    rng = np.random.default_rng(15)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    camera = scenes.camera_at(1.5, 40, (64, 48), rng)
    native = NativeEvaluator(body, [camera])
    maps = scenes.maps_for([camera], 1, rng)
    weights = native.prepared(maps)
    with pytest.raises(ValueError, match="expected poses of shape"):
        native.energies(weights, np.zeros((1, 3)))
    with pytest.raises(ValueError, match="weight maps of shapes"):
        native.prepared(WeightMaps((np.zeros((3, 3), np.int16),), np.zeros(1)))
    with pytest.raises(ValueError, match="pinhole"):
        NativeEvaluator(body, [Camera("lens", (9, 9), np.eye(3), np.eye(3, 4), [0.1, 0, 0, 0])])
