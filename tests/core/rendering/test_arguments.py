"""Mistakes of a caller that no evaluator lets pass, and what all of them accept."""

from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.energy.evaluator import WeightMaps
from silhouette_mocap.core.rendering.model import views_record
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.opengl.gpu import OpenGLEvaluator
from silhouette_mocap.core.rendering.opengl.paper import PaperEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator

KINDS = [ReferenceEvaluator, NativeEvaluator, OpenGLEvaluator, PaperEvaluator]


@pytest.fixture
def scene(scenes):
    """A body of four segments and two cameras."""
    rng = np.random.default_rng(4)
    body = scenes.body_of(scenes.mixed_pieces(rng), rng)
    return body, [scenes.camera_at(1.5, 40, size, rng) for size in [(64, 48), (90, 33)]]


@pytest.mark.parametrize("kind", KINDS)
def test_weights_of_other_cameras_or_evaluators_are_refused(kind, scenes, scene):
    body, cameras = scene
    rng = np.random.default_rng(5)
    evaluator, pose = kind(body, cameras), body.rest_pose
    maps = scenes.maps_for(cameras, 1, rng)
    foreign = [
        kind(body, cameras[:1]).prepared(WeightMaps(maps.maps[:1], maps.constants[:1])),
        kind(body, cameras[::-1]).prepared(WeightMaps(maps.maps[::-1], maps.constants)),
        *(other(body, cameras).prepared(maps) for other in KINDS if other is not kind),
    ]
    for weights in foreign:
        with pytest.raises(ValueError, match="expected weights prepared for"):
            evaluator.energies(weights, pose[None])
        with pytest.raises(ValueError, match="expected weights prepared for"):
            evaluator.masked(weights, pose, [1])
    # cameras elsewhere and other surfaces do not matter
    own = kind(body, [scenes.camera_at(2.0, 60, c.size, rng) for c in cameras]).prepared(maps)
    wanted = evaluator.energies(evaluator.prepared(maps), pose[None])
    np.testing.assert_array_equal(evaluator.energies(own, pose[None]), wanted)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("segments", [[1.7], [2**40], [-1], [99], ["1"], [np.nan]])
def test_segments_that_are_none_are_refused(kind, segments, scenes, scene):
    body, cameras = scene
    evaluator, pose = kind(body, cameras), body.rest_pose
    weights = evaluator.prepared(scenes.maps_for(cameras, 1, np.random.default_rng(6)))
    for call in (
        lambda: evaluator.energies(weights, pose[None], segments),
        lambda: evaluator.masked(weights, pose, segments),
        lambda: evaluator.silhouettes(pose, segments),
        lambda: evaluator.outline(pose, segments),
        lambda: evaluator.bounds(pose[None], segments),
    ):
        with pytest.raises(ValueError, match="segments"):
            call()


@pytest.mark.parametrize("kind", KINDS)
def test_segments_may_be_any_whole_numbers(kind, scene):
    body, cameras = scene
    evaluator, pose = kind(body, cameras), body.rest_pose
    wanted = evaluator.bounds(pose[None], [0, 2])
    for segments in ((0, 2), np.array([0, 2]), [np.int64(0), np.uint8(2)], {2: "", 0: ""}.keys()):
        np.testing.assert_array_equal(evaluator.bounds(pose[None], segments), wanted)


@pytest.mark.parametrize("kind", KINDS)
def test_weights_that_16_bits_do_not_hold_are_refused(kind, scenes, scene):
    body, cameras = scene
    evaluator = kind(body, cameras)
    maps = scenes.maps_for(cameras, 300, np.random.default_rng(7))
    for weight in (40000, -32769, 2**40, 0.5, 1.0, np.nan, True):
        wrong = WeightMaps((maps.maps[0], np.full((33, 90), weight)), maps.constants)
        with pytest.raises(ValueError, match="expected weights"):
            evaluator.prepared(wrong)
    with pytest.raises(ValueError, match="expected one constant per view"):
        evaluator.prepared(WeightMaps(maps.maps, np.array([0.5, 1.7])))
    with pytest.raises(ValueError, match="expected one constant per view"):
        evaluator.prepared(WeightMaps(maps.maps, maps.constants[:1]))
    wide = WeightMaps(tuple(m.astype(np.int64) for m in maps.maps), maps.constants.tolist())
    wanted, found = (
        evaluator.energies(evaluator.prepared(m), body.rest_pose[None]) for m in (maps, wide)
    )
    np.testing.assert_array_equal(found, wanted)


@pytest.mark.parametrize("kind", KINDS)
def test_levels_and_cameras_that_cannot_be_are_refused(kind, scenes, scene):
    body, cameras = scene
    body = replace(body, surfaces=body.surfaces * 2)
    assert kind(body, cameras, 1).level == 1
    for level in (-1, 2):
        with pytest.raises(ValueError, match="expected a level below 2"):
            kind(body, cameras, level)
    with pytest.raises(ValueError, match="at least one camera"):
        kind(body, [])
    for size in ((16001, 7), (7, 16001)):
        wide = [cameras[0], scenes.camera_at(1.5, 40, size, np.random.default_rng(8))]
        with pytest.raises(ValueError, match="at most 16000 px, got 16001"):
            kind(body, wide)
        with pytest.raises(ValueError, match="at most 16000 px, got 16001"):
            views_record(wide, 1)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("spacing", [0, -1.0, np.nan])
def test_outlines_without_a_spacing_are_refused(kind, spacing, scene):
    body, cameras = scene
    with pytest.raises(ValueError, match=r"spacing|sizes"):
        kind(body, cameras).outline(body.rest_pose, spacing_px=spacing)


def test_no_threads_are_refused(scene):
    for threads in (0, -3):
        with pytest.raises(ValueError, match="at least one thread"):
            NativeEvaluator(*scene, threads=threads)


@pytest.mark.parametrize("kind", [ReferenceEvaluator, NativeEvaluator])
def test_the_largest_pictures_are_covered_up_to_their_last_pixels(kind, scenes):
    rng = np.random.default_rng(9)
    body = scenes.body_of([scenes.sphere(4, 6, 0.2, rng)], rng)
    for x, y, size in ((15999, 3, (16000, 7)), (3, 15999, (7, 16000))):
        camera = scenes.camera_at(2.0, 200, size, rng)
        camera = replace(
            camera,
            matrix=np.array([[200.0, 0, x], [0, 200, y], [0, 0, 1]]),
            camera_from_world=np.column_stack([np.eye(3), [0, 0, 2] - body.offsets[0]]),
        )
        assert kind(body, [camera]).silhouettes(body.rest_pose)[0][y, x]
