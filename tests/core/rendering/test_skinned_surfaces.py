"""Vertices that follow several joints: native against reference, and against rigid segments."""

from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.body import Body, Skin
from silhouette_mocap.core.body.file import read_body, write_body
from silhouette_mocap.core.body.kinematics import joint_transforms, rest_joints, world_vertices
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.cameras.presets import studio_t
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.opengl.gpu import OpenGLEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator


def skinned(body: Body, rng: np.random.Generator, segments) -> Body:
    """The body with random weights on up to four joints in the given segments, 1 elsewhere."""
    surface = body.surfaces[0]
    own = np.repeat(body.segment_joints, np.diff(surface.vertex_starts))
    joints = np.tile(own[:, None], 4)
    weights = np.tile([1.0, 0, 0, 0], (len(own), 1))
    of = np.repeat(np.arange(len(body.segment_names)), np.diff(surface.vertex_starts))
    soft = np.isin(of, segments)
    joints[soft, 1:] = rng.integers(0, len(body.joint_names), (soft.sum(), 3))
    weights[soft] = rng.uniform(0, 1, (soft.sum(), 4)) * (rng.uniform(0, 1, (soft.sum(), 4)) < 0.7)
    weights[soft, 0] += 0.1
    return replace(body, surfaces=(replace(surface, skin=Skin(joints, weights)),))


def random_scene(scenes, seed):
    rng = np.random.default_rng(seed)
    ball = scenes.sphere(4, 7, 0.15, rng)
    pieces = [ball, (ball[0] * 0.7, ball[1][::2]), scenes.soup(rng, 7, 9), ball]
    body = skinned(scenes.body_of(pieces, rng), rng, [0, 1, 2])
    sizes = [(64, 48), (65, 30), (30, 70)]
    cameras = [scenes.camera_at(rng.choice([0.15, 0.8, 2.0]), 80, s, rng) for s in sizes]
    return body, cameras, rng


@pytest.mark.parametrize("seed", range(8))
def test_kernel_and_reference_agree_on_skinned_surfaces(scenes, seed):
    body, cameras, rng = random_scene(scenes, seed)
    maps = scenes.maps_for(cameras, [1, 200][seed % 2], rng)
    poses = rng.normal(0, 0.3, (3, len(body.dofs)))
    by_view = rng.normal(0, 0.3, (2, len(cameras), len(body.dofs)))
    reference = ReferenceEvaluator(body, cameras)
    theirs = reference.prepared(maps)
    wanted = [
        reference.energies(theirs, p, part) for p in (poses, by_view) for part in (None, [3, 1])
    ]
    for native in scenes.natives(body, cameras):
        ours = native.prepared(maps)
        found = [
            native.energies(ours, p, part) for p in (poses, by_view) for part in (None, [3, 1])
        ]
        for a, b in zip(found, wanted, strict=True):
            np.testing.assert_array_equal(a, b)
        boxes = native.bounds(poses, [0, 3])
        np.testing.assert_array_equal(boxes, reference.bounds(poses, [0, 3]))
        np.testing.assert_array_equal(native.snapped(poses[0]), reference.snapped(poses[0]))


@pytest.mark.parametrize("seed", range(3))
def test_outlines_of_skinned_surfaces_are_the_same_and_lie_where_they_are_seen(scenes, seed):
    body, cameras, rng = random_scene(scenes, 10 + seed)
    pose = rng.normal(0, 0.3, len(body.dofs))
    transforms = joint_transforms(body, pose[None])[0]
    wanted = ReferenceEvaluator(body, cameras).outline(pose)
    for camera, ours, theirs in zip(
        cameras, NativeEvaluator(body, cameras).outline(pose), wanted, strict=True
    ):
        order, other = (np.lexsort(np.round(o.px, 9).T) for o in (ours, theirs))
        np.testing.assert_allclose(ours.px[order], theirs.px[other], atol=1e-9)
        placed = transforms[body.segment_joints[ours.segments]]
        world = (placed[:, :, :3] @ ours.points[..., None])[..., 0] + placed[:, :, 3]
        h = camera.projection @ np.append(world, np.ones((len(world), 1)), 1).T
        assert np.abs(h[:2] / h[2] - ours.px.T).max(initial=0) <= 0.5 / 256 + 1e-6


def test_a_skin_on_one_joint_is_a_rigid_segment(scenes):
    rng = np.random.default_rng(0)
    body = template("sixteen_segment")
    surface = body.surfaces[0]
    own = np.repeat(body.segment_joints, np.diff(surface.vertex_starts))
    skin = Skin(np.tile(own[:, None], 4), np.tile([0.25] * 4, (len(own), 1)))
    fixed = replace(body, surfaces=(replace(surface, skin=skin),))
    cameras = studio_t().cameras
    weights = scenes.maps_for(cameras, 1, rng)
    poses = rng.normal(0, 0.2, (3, len(body.dofs)))
    rigid, same = NativeEvaluator(body, cameras), NativeEvaluator(fixed, cameras)
    assert not same._body.arrays["skinned"].any()
    energies = [e.energies(e.prepared(weights), poses) for e in (rigid, same)]
    np.testing.assert_array_equal(*energies)


def test_a_vertex_lies_between_where_its_joints_would_carry_it(scenes):
    rng = np.random.default_rng(1)
    body, _, _ = random_scene(scenes, 1)
    pose = rng.normal(0, 0.5, len(body.dofs))
    transforms, rest = joint_transforms(body, pose[None])[0], rest_joints(body)
    surface = body.surfaces[0]
    own = np.repeat(body.segment_joints, np.diff(surface.vertex_starts))
    for v, placed in enumerate(world_vertices(body, pose)):
        at_rest = surface.vertices[v] + rest[own[v]]
        carried = [transforms[j] @ [*(at_rest - rest[j]), 1.0] for j in surface.skin.joints[v]]
        np.testing.assert_allclose(placed, surface.skin.weights[v] @ carried, atol=1e-6)


def test_a_skin_survives_the_file(scenes, tmp_path):
    body, _, _ = random_scene(scenes, 2)
    write_body(tmp_path / "body.npz", body)
    skin, read = body.surfaces[0].skin, read_body(tmp_path / "body.npz").surfaces[0].skin
    np.testing.assert_array_equal(read.joints, skin.joints)
    np.testing.assert_array_equal(read.weights, skin.weights)


def test_weights_that_are_negative_or_all_zero_are_refused():
    joints = np.zeros((2, 4), int)
    for row in ([0.5, -0.1, 0.6, 0], [0, 0, 0, 0]):
        with pytest.raises(ValueError, match="weights"):
            Skin(joints, [[1, 0, 0, 0], row])


def test_opengl_leaves_skinned_surfaces_to_the_native_evaluator(scenes):
    body, cameras, _ = random_scene(scenes, 3)
    with pytest.raises(MocapError, match="rigid segments only"):
        OpenGLEvaluator(body, cameras)
