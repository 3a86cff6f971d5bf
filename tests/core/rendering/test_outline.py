"""Points on the outline: native against reference, and both against what the silhouettes show."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.cameras.presets import studio_t
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator


def rows_of(outline) -> np.ndarray:
    """(P, 8) all numbers of an outline, in an order of their own."""
    columns = outline.segments[:, None], outline.points, outline.px, outline.normals
    rows = np.round(np.concatenate(columns, axis=1), 9) + 0.0
    return rows[np.lexsort(rows.T)]


def random_scene(scenes, seed):
    rng = np.random.default_rng(seed)
    ball = scenes.sphere(4, 7, 0.15, rng)
    pieces = [ball, (ball[0] * 0.7, ball[1][::2]), scenes.soup(rng, 7, 9)]
    body = scenes.body_of(pieces, rng)
    sizes = [(64, 48), (65, 30), (30, 70)]
    cameras = [scenes.camera_at(rng.choice([0.4, 0.8, 2.0]), 80, s, rng) for s in sizes]
    return body, cameras, rng.normal(0, 0.4, len(body.dofs)), rng


@pytest.mark.parametrize("seed", range(6))
def test_native_and_reference_find_the_same_points(scenes, seed):
    body, cameras, pose, rng = random_scene(scenes, seed)
    per_view = pose + rng.normal(0, 0.1, (len(cameras), len(pose)))
    reference, points = ReferenceEvaluator(body, cameras), 0
    for chosen, place, spacing in ((None, pose, 1.0), ([0, 2], pose, 0.3), ([1], per_view, 2.5)):
        wanted = reference.outline(place, chosen, spacing)
        for native in scenes.natives(body, cameras):
            found = native.outline(place, chosen, spacing)
            for ours, theirs in zip(found, wanted, strict=True):
                np.testing.assert_allclose(rows_of(ours), rows_of(theirs), atol=2e-9)
                points += len(ours.px)
    assert points > 100


@pytest.fixture(scope="module")
def studio():
    body, cameras = template("sixteen_segment"), studio_t().cameras
    pose = np.random.default_rng(0).normal(0, 0.15, len(body.dofs))
    evaluator = NativeEvaluator(body, cameras)
    return evaluator, pose, evaluator.outline(pose), evaluator.silhouettes(pose)


def test_points_are_seen_where_their_places_on_the_body_are_projected(studio):
    evaluator, pose, outlines, _ = studio
    transforms = evaluator.transforms(pose[None])[0]
    for camera, outline in zip(evaluator.cameras, outlines, strict=True):
        placed = transforms[evaluator.body.segment_joints[outline.segments]]
        world = placed @ np.append(outline.points, np.ones((len(outline.points), 1)), 1)[..., None]
        h = camera.projection @ np.append(world[..., 0], np.ones((len(world), 1)), 1).T
        # both ends of an edge were snapped by up to half a step each way
        assert np.abs(h[:2] / h[2] - outline.px.T).max() <= 0.5 / 256 + 1e-9


def test_the_points_lie_on_the_silhouettes_edge_and_leave_none_of_it_out(studio):
    _, _, outlines, silhouettes = studio
    for outline, silhouette in zip(outlines, silhouettes, strict=True):
        covered = silhouette.astype(np.uint8)
        inner = covered - cv2.erode(covered, np.ones((3, 3), np.uint8), borderValue=1)
        outer = cv2.dilate(covered, np.ones((3, 3), np.uint8)) - covered
        # px from each pixel to the nearest one of the edge, and from each edge pixel to a point
        edge = np.asarray(inner | outer, np.uint8)
        distances = cv2.distanceTransform(1 - edge, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
        x, y = np.rint(outline.px).astype(int).T
        assert distances[y, x].max() <= 1.5
        apart = np.argwhere(inner)[:, None, ::-1] - outline.px[None]
        nearest = np.hypot(*np.moveaxis(apart, -1, 0)).min(axis=1)
        # in notches of a pixel's width the pixel beside a point is covered: none remains there
        assert nearest.max() <= 3.0
        assert np.mean(nearest <= 1.5) > 0.99


def test_normals_are_unit_vectors_that_leave_the_body(studio):
    _, _, outlines, silhouettes = studio
    for outline, silhouette in zip(outlines, silhouettes, strict=True):
        np.testing.assert_allclose(np.hypot(*outline.normals.T), 1.0, atol=1e-12)
        behind = np.rint(outline.px - outline.normals).astype(int)
        beyond = np.floor(outline.px + 0.75 * outline.normals + 0.5).astype(int)
        assert not silhouette[tuple(beyond.T[::-1])].any()
        # where a part is thinner than a pixel, the pixel behind may be empty, too
        assert silhouette[tuple(behind.T[::-1])].mean() > 0.95


def test_neighbours_on_an_edge_are_no_further_apart_than_asked(scenes):
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    body = scenes.body_of([(vertices, np.array([[0, 1, 2]]))], np.random.default_rng(0))
    camera = studio_t().cameras[0]
    pose = np.zeros(len(body.dofs))
    for spacing in (0.5, 1.0, 7.0):
        outline = NativeEvaluator(body, [camera]).outline(pose, None, spacing)[0]
        ends = ReferenceEvaluator(body, [camera]).snapped(pose)[0] / 256
        around = np.hypot(*(ends - np.roll(ends, 1, axis=0)).T)
        assert len(outline.px) == np.ceil(around / spacing).sum()


def test_outlines_longer_than_the_room_for_them_come_whole(scenes):
    body, cameras, pose, _ = random_scene(scenes, 1)
    evaluator = NativeEvaluator(body, cameras)
    fine, coarse = (evaluator.outline(pose, None, s) for s in (1 / 256, 1.0))
    assert sum(len(outline.px) for outline in fine) > 2000 * len(cameras)
    assert sum(len(outline.px) for outline in coarse) < 2000
