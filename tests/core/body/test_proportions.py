"""Every length and girth is a parameter, and names what it changes."""

import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import joint_positions, rest_height, world_vertices
from silhouette_mocap.core.body.scaling import scaled
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.body.templates.landmarks import landmarks
from silhouette_mocap.core.body.templates.performer import performer
from silhouette_mocap.core.body.templates.proportions import Proportions
from silhouette_mocap.core.body.templates.surfaces import LOFTS, Level

SPANS = {
    "shank": ("left_knee", "left_ankle"),
    "thigh": ("left_hip", "left_knee"),
    "lower_spine": ("root", "waist"),
    "middle_spine": ("waist", "chest"),
    "upper_spine": ("chest", "neck"),
    "neck": ("neck", "head"),
    "skull": ("head", "skull"),
    "crown": ("skull", "head_end"),
    "upper_arm": ("left_shoulder", "left_elbow"),
    "forearm": ("left_elbow", "left_wrist"),
    "hand": ("left_wrist", "left_fingertip"),
    "thumb": ("left_thumb", "left_thumb_tip"),
    "toes": ("left_ball_sole", "left_toe_sole"),
}
COORDINATES = {
    "ankle_height": (None, "left_ankle", 2),
    "hip_half_width": (None, "left_hip", 0),
    "sternum_half_width": (None, "left_clavicle", 0),
    "sternum_drop": ("left_clavicle", "neck", 2),
    "sternum_depth": ("left_clavicle", "neck", 1),
    "shoulder_half_width": (None, "left_shoulder", 0),
    "shoulder_drop": ("left_shoulder", "neck", 2),
    "shoulder_depth": ("left_shoulder", "neck", 1),
}
FLOOR_SPANS = {"heel": ("left_heel_sole", "left_ankle"), "instep": ("left_ankle", "left_ball_sole")}


def longer(name, extra=0.013):
    return Proportions(**{name: getattr(Proportions(), name) + extra})


def measured(name, proportions):
    """The length that the name stands for, read off the landmarks."""
    places = landmarks(proportions)
    if name in SPANS:
        start, end = SPANS[name]
        return np.linalg.norm(places[end] - places[start])
    if name in FLOOR_SPANS:
        start, end = FLOOR_SPANS[name]
        return np.linalg.norm((places[end] - places[start])[:2])
    start, end, axis = COORDINATES[name]
    return places[end][axis] - (places[start][axis] if start else 0)


def test_every_length_has_a_measurement():
    assert {*SPANS, *COORDINATES, *FLOOR_SPANS} == set(Proportions.length_names())


@pytest.mark.parametrize("name", Proportions.length_names())
def test_a_length_changes_what_it_names_and_nothing_else(name):
    assert measured(name, Proportions()) == pytest.approx(getattr(Proportions(), name))
    for other in Proportions.length_names():
        expected = getattr(Proportions(), other) + (0.013 if other == name else 0)
        assert measured(other, longer(name)) == pytest.approx(expected), other


@pytest.mark.parametrize("name", Proportions.length_names())
def test_a_length_moves_joints_or_the_surface_of_the_body(name):
    before, after = (performer(p, (Level(1, 1),)) for p in (Proportions(), longer(name)))
    rest = before.rest_pose
    joints = joint_positions(after, rest[None]) - joint_positions(before, rest[None])
    surface = world_vertices(after, rest) - world_vertices(before, rest)
    moved = np.linalg.norm(np.concatenate([joints[0], surface]), axis=1)
    assert 0.012 < moved.max() < 0.03


@pytest.mark.parametrize("name", sorted(LOFTS))
def test_a_girth_changes_its_own_piece_in_the_named_direction(name):
    levels = (Level(1, 1),)
    before = performer(levels=levels).surfaces[0].vertices
    wide = performer(Proportions().with_girth(name, width=1.2), levels).surfaces[0].vertices
    deep = performer(Proportions().with_girth(name, depth=1.2), levels).surfaces[0].vertices
    ends, front = landmarks(Proportions()), LOFTS[name].front
    axis = ends[LOFTS[name].end] - ends[LOFTS[name].start]
    outer = np.cross(front, axis)
    front = np.cross(axis, outer)
    for moved, direction in ((wide - before, outer), (deep - before, front)):
        direction = direction / np.linalg.norm(direction)
        length = np.linalg.norm(moved, axis=1)
        assert length.max() > 0.001
        along = np.maximum(np.abs(moved @ direction), np.abs(moved @ (direction * (-1, 1, 1))))
        np.testing.assert_allclose(along, length, atol=1e-6)


def test_proportions_are_all_there_is_to_size(body):
    grown = template(body.name, Proportions().scaled(1.1))
    same = scaled(body, 1.1)
    np.testing.assert_allclose(grown.offsets, same.offsets, atol=1e-12)
    np.testing.assert_allclose(grown.tails, same.tails, atol=1e-12)
    np.testing.assert_allclose(grown.point_offsets, same.point_offsets, atol=1e-12)
    for a, b in zip(grown.surfaces, same.surfaces, strict=True):
        np.testing.assert_allclose(a.vertices, b.vertices, atol=1e-6)


def test_scaling_a_body_scales_every_pose_about_the_origin(body):
    pose = 0.2 * np.random.default_rng(7).standard_normal(len(body.dofs))
    pose[:3] = 0
    big = scaled(body, 1.3)
    here, there = joint_positions(body, pose[None]), joint_positions(big, pose[None])
    np.testing.assert_allclose(there, 1.3 * here, atol=1e-12)
    np.testing.assert_allclose(
        world_vertices(big, pose, 0), 1.3 * world_vertices(body, pose, 0), atol=1e-6
    )
    assert rest_height(big) == pytest.approx(1.3 * rest_height(body))
    np.testing.assert_array_equal(big.dofs.limits, body.dofs.limits)


def test_impossible_sizes_are_refused(body):
    with pytest.raises(ValueError, match="expected thigh above 0 m"):
        Proportions(thigh=0.0)
    with pytest.raises(ValueError, match="expected a factor above 0"):
        scaled(body, -1.0)
    with pytest.raises(KeyError):
        Proportions().with_girth("tail", width=2.0)
