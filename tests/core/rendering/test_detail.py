"""The levels of detail by what cameras see of them, and the choice among them."""

from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.bench.sequences import sequence
from silhouette_mocap.core.bench.stage import filmed, studio
from silhouette_mocap.core.body.scaling import scaled
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.energy.weight_maps import xor_weight_maps
from silhouette_mocap.core.rendering.detail import (
    OUTLINE_PX,
    drawn_surface,
    level_for,
    pixels_per_metre,
    with_level_for,
)
from silhouette_mocap.core.rendering.native import NativeEvaluator

COARSE, MIDDLE, FULL = range(3)


@pytest.fixture(scope="module", params=["performer", "sixteen_segment"])
def body(request):
    return template(request.param)


@pytest.fixture(scope="module")
def poses(body):
    """(12, D) of slow and fast motion, arms and legs well bent."""
    return np.concatenate([sequence(body, name, 90)[19::13] for name in "AB"])


@pytest.fixture(scope="module")
def evaluators(body):
    return [NativeEvaluator(body, studio(), level) for level in (COARSE, MIDDLE, FULL)]


@pytest.fixture(scope="module")
def masks(evaluators, poses):
    """By level: the pictures of all poses and cameras."""
    return [[m for pose in poses for m in e.silhouettes(pose)] for e in evaluators]


def outline_px(picture):
    """Length by counting unlike neighbours, which an outline crosses 4 / pi times per px."""
    padded = np.pad(picture, 1).astype(np.int8)
    return np.pi / 4 * sum(np.count_nonzero(np.diff(padded, axis=axis)) for axis in (0, 1))


@pytest.mark.parametrize(("level", "share"), [(COARSE, 0.02), (MIDDLE, 0.012)])
def test_at_320x240_no_view_of_any_pose_differs_by_more_of_its_area(masks, level, share):
    pairs = zip(masks[level], masks[FULL], strict=True)
    assert max((mask ^ full).sum() / full.sum() for mask, full in pairs) <= share


def test_energies_differ_by_at_most_three_thousandths_of_the_silhouettes_area(evaluators, poses):
    rng = np.random.default_rng(7)
    for pose in poses[::2]:
        maps = xor_weight_maps(filmed(evaluators[FULL], pose))
        candidates = pose + rng.normal(0, 0.03, (16, len(pose)))
        coarse, full = (
            e.energies(e.prepared(maps), candidates).sum(axis=1)
            for e in (evaluators[COARSE], evaluators[FULL])
        )
        assert np.abs(coarse - full).max() <= 0.003 * maps.constants.sum()


@pytest.mark.parametrize("level", [COARSE, MIDDLE])
def test_a_level_tells_how_far_its_outline_lies_beside_the_finest(body, masks, poses, level):
    differing = sum((a ^ b).sum() for a, b in zip(masks[level], masks[FULL], strict=True))
    distance_px = differing / sum(map(outline_px, masks[FULL]))
    scale = np.mean([pixels_per_metre(body, [c], p) for p in poses for c in studio()])
    told = body.surfaces[level].outline_distance
    assert distance_px / scale == pytest.approx(told, rel=0.15)


def test_the_part_of_a_pixel_is_two_per_cent_of_the_area_in_the_studio(masks):
    area_per_outline = np.mean([mask.sum() / outline_px(mask) for mask in masks[FULL]])
    assert pytest.approx(0.02 * area_per_outline, rel=0.1) == OUTLINE_PX


@pytest.mark.parametrize(
    ("size", "level"),
    [((160, 120), COARSE), ((320, 240), COARSE), ((1920, 1080), MIDDLE), ((7680, 4320), FULL)],
)
def test_larger_pictures_take_a_finer_surface(body, size, level):
    assert level_for(body, studio(size), body.rest_pose) == level


def test_a_performer_twice_as_near_takes_the_surface_of_twice_the_resolution(body):
    # half the body at half the distance looks the same and is to be drawn alike
    for size in ((320, 240), (1920, 1080)):
        near = [
            replace(c, camera_from_world=c.camera_from_world * [1, 1, 1, 0.5]) for c in studio(size)
        ]
        small = scaled(body, 0.5)
        assert level_for(small, near, body.rest_pose) == level_for(
            body, studio(size), body.rest_pose
        )
        px = [drawn_surface(b, c, b.rest_pose) for b, c in ((body, studio(size)), (small, near))]
        assert px[0]["outline_distance_px"] == pytest.approx(px[1]["outline_distance_px"], rel=1e-6)


def test_the_camera_that_shows_the_performer_largest_decides(body):
    far, near = studio((320, 240)), studio((1920, 1080))
    assert level_for(body, (*far, near[3]), body.rest_pose) == MIDDLE


def test_a_body_of_one_surface_and_one_out_of_sight_take_the_first(body):
    single = replace(body, surfaces=body.surfaces[:1])
    assert level_for(single, studio((7680, 4320)), body.rest_pose) == 0
    away = body.rest_pose.copy()
    away[1] = 50.0
    behind = [c for c in studio((7680, 4320)) if c.depths(np.array([0.0, 50.0, 1.0])) < 0]
    assert behind
    assert level_for(body, behind, away) == 0


def test_an_evaluator_gets_the_level_of_its_own_cameras(body):
    made = with_level_for(body.rest_pose, lambda body, cameras, level=9: level)
    assert made(body, studio((1920, 1080))) == MIDDLE
    assert made(body, studio((480, 270))) == COARSE
