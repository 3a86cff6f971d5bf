"""What nothing may break: masking, moving all at once, order, and the frame of a picture."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.energy.evaluator import WeightMaps
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator

SIZES = [(64, 48), (65, 30), (30, 70), (1, 40), (130, 9)]
NEAR_AN_EDGE_PX = 2 / 256
HALF_TURN = np.diag([-1.0, -1, 1])
QUARTER_TURN = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])


def make_body(scenes, rng):
    """Four joints; a closed ball, an open one, a soup, and a finer ball."""
    vertices, triangles = scenes.sphere(4, 7, 0.15, rng)
    pieces = [
        (vertices, triangles),
        (vertices * 0.7, triangles[::2]),
        scenes.soup(rng, 7, 9),
        scenes.sphere(6, 9, 0.2, rng),
    ]
    return scenes.body_of(pieces, rng)


def make_cameras(scenes, rng, sizes=SIZES):
    return [scenes.camera_at(rng.choice([0.4, 1.0, 2.0]), 60, size, rng) for size in sizes]


def carried_by(body, joint):
    """Joints that move with one, itself included."""
    carried = {joint}
    for j, parent in enumerate(body.parents):
        if parent in carried:
            carried.add(j)
    return sorted(carried)


def random_windows(boxes, cameras, rng):
    """(V, 4) windows round boxes (N, V, 4), as far as these lie in the pictures."""
    sizes = np.array([camera.size for camera in cameras])
    low = np.clip(boxes[..., :2].min(axis=0), 0, sizes)
    high = np.clip(boxes[..., 2:].max(axis=0), 0, sizes)
    spare = rng.integers(0, 3, (len(cameras), 4)) * [-1, -1, 1, 1]
    return np.concatenate([low, high], axis=1) + spare


@pytest.mark.parametrize(("joint", "largest"), [(0, 1), (1, 500), (2, 1), (3, 500)])
def test_the_moving_part_alone_gives_the_full_energy_in_images_and_windows(scenes, joint, largest):
    rng = np.random.default_rng([joint, largest])
    body = make_body(scenes, rng)
    cameras = make_cameras(scenes, rng)
    joints = carried_by(body, joint)
    moving = np.flatnonzero(np.isin(body.segment_joints, joints))
    free = np.flatnonzero(np.isin(body.dofs.joints, joints))
    poses = np.repeat(rng.normal(0, 0.3, (1, len(body.dofs))), 9, axis=0)
    # next to the pose, anywhere, and so far off that it leaves the pictures or passes the cameras
    poses[1:, free] += rng.normal(0, 1, (8, len(free))) * np.tile(
        [[0.03], [3], [0.5], [0.1]], (2, 1)
    )
    maps = scenes.maps_for(cameras, largest, rng)
    for evaluator in scenes.exact(body, cameras):
        count = 2 if isinstance(evaluator, ReferenceEvaluator) else 9
        some = poses[-count:]
        weights = evaluator.prepared(maps)
        full = evaluator.energies(weights, some)
        boxes = evaluator.bounds(some, moving)
        for windows in (None, random_windows(boxes, cameras, rng)):
            masked = evaluator.masked(weights, poses[0], moving, windows)
            np.testing.assert_array_equal(evaluator.energies(masked, some, moving), full)
        assert np.ptp(full, axis=0).any()


def test_a_part_may_be_fixed_otherwise_in_every_view(scenes):
    rng = np.random.default_rng(1)
    body = make_body(scenes, rng)
    cameras = make_cameras(scenes, rng)
    leaf = np.flatnonzero(body.dofs.joints == 3)
    poses = np.repeat(rng.normal(0, 0.3, (1, len(cameras), len(body.dofs))), 3, axis=0)
    poses[..., leaf] += rng.normal(0, 0.5, (3, len(cameras), len(leaf)))
    maps = scenes.maps_for(cameras, 1, rng)
    for evaluator in scenes.exact(body, cameras):
        weights = evaluator.prepared(maps)
        masked = evaluator.masked(weights, poses[0], [3])
        full = evaluator.energies(weights, poses)
        np.testing.assert_array_equal(evaluator.energies(masked, poses, [3]), full)


def turned(body, turn):
    """The body in other axes: what a pose means is the same, seen from a world turned back."""
    surface = body.surfaces[0]
    return replace(
        body,
        offsets=body.offsets @ turn.T,
        dofs=replace(body.dofs, axes=body.dofs.axes @ turn.T),
        surfaces=(replace(surface, vertices=surface.vertices @ turn.T),),
    )


def moved(camera, turn, shift):
    """The camera, moved along with a world of which point x goes to turn x + shift."""
    rotation = camera.rotation @ turn.T
    translation = camera.camera_from_world[:, 3] - rotation @ shift
    return replace(camera, camera_from_world=np.column_stack([rotation, translation]))


def both_worlds(scenes, rng, turn, shift):
    """Evaluators of a scene, and of the same one moved."""
    body, cameras = make_body(scenes, rng), make_cameras(scenes, rng)
    other = turned(body, turn)
    offsets = other.offsets.copy()
    offsets[0] += shift
    other = replace(other, offsets=offsets)
    placed = [moved(camera, turn, shift) for camera in cameras]
    return scenes.exact(body, cameras), scenes.exact(other, placed)


@pytest.mark.parametrize(
    ("turn", "shift"),
    [(HALF_TURN, 0.0), (QUARTER_TURN, 0.0), (np.eye(3), 8.0), (QUARTER_TURN, -4.0)],
)
def test_even_turns_and_shifts_of_world_and_cameras_change_no_pixel(scenes, turn, shift):
    rng = np.random.default_rng(2)
    here, there = both_worlds(scenes, rng, turn, np.array([shift, -2 * shift, shift / 2]))
    maps = scenes.maps_for(here[0].cameras, 300, rng)
    poses = rng.normal(0, 0.3, (2, len(here[0].body.dofs)))
    for ours, theirs in zip(here, there, strict=True):
        # half turns only change signs; else sums are rounded differently, by some 1e-13 px, which
        # would have to lead across the middle between two steps
        energies = ours.energies(ours.prepared(maps), poses)
        np.testing.assert_array_equal(theirs.energies(theirs.prepared(maps), poses), energies)
        assert np.ptp(energies, axis=0).any()


@pytest.mark.parametrize("seed", range(3))
def test_any_motion_of_world_and_cameras_changes_pixels_on_an_edge_at_most(scenes, seed):
    rng = np.random.default_rng([3, seed])
    turn = Rotation.random(random_state=seed).as_matrix()
    here, there = both_worlds(scenes, rng, turn, rng.normal(0, 5, 3))
    pose = rng.normal(0, 0.3, len(here[0].body.dofs))
    segments = range(len(here[0].body.segment_names))
    for ours, theirs in zip(here, there, strict=True):
        pairs = zip(ours.silhouettes(pose), theirs.silhouettes(pose), strict=True)
        for view, (picture, twin) in enumerate(pairs):
            differing = np.argwhere(picture != twin)
            assert len(differing) <= 3
            if len(differing):  # vertices are kept in single precision: one step to either side
                distances = scenes.edge_distances_px(here[0], pose, view, segments, differing)
                assert distances.max() < NEAR_AN_EDGE_PX


def test_cameras_in_another_order_give_their_energies_in_that_order(scenes):
    rng = np.random.default_rng(4)
    body = make_body(scenes, rng)
    cameras = make_cameras(scenes, rng, [*SIZES[1:], *SIZES[::-1]])  # more than lie abreast
    maps = scenes.maps_for(cameras, 300, rng)
    order = rng.permutation(len(cameras))
    mixed = WeightMaps(tuple(maps.maps[v] for v in order), maps.constants[order])
    poses = rng.normal(0, 0.3, (2, len(cameras), len(body.dofs)))
    pairs = scenes.exact(body, cameras), scenes.exact(body, [cameras[v] for v in order])
    for ours, theirs in zip(*pairs, strict=True):
        weights, others = ours.prepared(maps), theirs.prepared(mixed)
        for batch, permuted in ((poses[:1], poses[:1, order]), (poses[:1, 0], poses[:1, 0])):
            energies = ours.energies(weights, batch)
            np.testing.assert_array_equal(theirs.energies(others, permuted), energies[:, order])
        boxes = ours.bounds(poses, [0, 2])
        np.testing.assert_array_equal(theirs.bounds(poses[:, order], [0, 2]), boxes[:, order])


@pytest.mark.parametrize("margin", [1, 37, 64])
def test_a_picture_is_the_middle_of_a_larger_one(scenes, margin):
    rng = np.random.default_rng([5, margin])
    body = make_body(scenes, rng)
    small = make_cameras(scenes, rng)
    large = []
    for camera in small:
        matrix = camera.matrix + np.array([[0, 0, margin], [0, 0, margin], [0, 0, 0]])
        size = camera.size[0] + 2 * margin, camera.size[1] + 2 * margin
        large.append(Camera("large", size, matrix, camera.camera_from_world))
    pairs = scenes.exact(body, small), scenes.exact(body, large)
    pose = rng.normal(0, 0.4, len(body.dofs))
    for ours, theirs in zip(*pairs, strict=True):
        wide = theirs.silhouettes(pose)
        for picture, larger in zip(ours.silhouettes(pose), wide, strict=True):
            middle = larger[margin:-margin, margin:-margin]
            np.testing.assert_array_equal(picture, middle)
        assert sum(int(picture.sum()) for picture in wide) > 200
