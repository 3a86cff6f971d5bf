"""Counts, meshes, mirror symmetry and limits of the bodies made by code."""

import numpy as np
import pytest
from scipy.spatial import KDTree
from silhouette_mocap.core.body.body import POINT_NAMES, DofKind
from silhouette_mocap.core.body.kinematics import (
    clamped,
    points,
    swing_rows,
    within_limits,
    world_vertices,
)
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.body.templates.nine_joint import measures
from silhouette_mocap.core.errors import MocapError

MIRROR = np.array([-1.0, 1.0, 1.0])


def segment_meshes(body, level):
    surface = body.surfaces[level]
    starts = surface.triangle_starts
    for name, a, b in zip(body.segment_names, starts[:-1], starts[1:], strict=True):
        yield name, surface.triangles[a:b]


def other_side(name):
    swap = {"left": "right", "right": "left"}
    side, _, rest = name.partition("_")
    return f"{swap[side]}_{rest}" if side in swap else name


def mirrored_pose(body, pose):
    """The pose whose body is the mirror image, from the axes alone."""
    out = np.zeros_like(pose)
    names = body.dofs.names
    for row, name in enumerate(names):
        axis = body.dofs.axes[row]
        if name != other_side(name):
            sign = 1.0
        elif body.dofs.kinds[row] == DofKind.TRANSLATION:
            sign = 1 - 2 * abs(axis[0])
        else:
            sign = 2 * abs(axis[0]) - 1
        out[names.index(other_side(name))] = sign * pose[row]
    return out


def test_the_performer_has_49_dofs(bodies):
    body = bodies["performer"]
    count = {name: 0 for name in body.joint_names}
    for joint in body.dofs.joints:
        count[body.joint_names[joint]] += 1
    assert len(body.dofs) == 49
    assert [count[name] for name in ("root", "waist", "chest", "neck", "head")] == [6, 3, 3, 3, 2]
    for side in ("left", "right"):
        arm = [count[f"{side}_{name}"] for name in ("clavicle", "shoulder", "elbow", "wrist")]
        leg = [count[f"{side}_{name}"] for name in ("hip", "knee", "ankle", "toes")]
        assert (arm, leg) == ([2, 3, 1, 3], [3, 1, 2, 1])


def test_the_sixteen_segments_have_35_dofs_and_17_joints(bodies):
    body = bodies["sixteen_segment"]
    assert (len(body.dofs), len(body.joint_names), len(body.segment_names)) == (35, 17, 16)


def dofs_by_joint(body):
    return {name: (body.dofs.joints == joint).sum() for joint, name in enumerate(body.joint_names)}


def test_the_eleven_segments_have_ten_joints_of_three_angles_and_a_root_of_six(bodies):
    body = bodies["eleven_segment"]
    assert len(body.segment_names) == 11
    root, *others = dofs_by_joint(body).values()
    assert (root, others) == (6, [3] * 10)
    angles = body.dofs.kinds[body.dofs.joints > 0]
    assert (angles == DofKind.HINGE).all() and not body.cones


def test_the_nine_joints_have_three_dofs_and_the_virtual_foot_moves_besides(bodies):
    body = bodies["nine_joint"]
    count = dofs_by_joint(body)
    assert (count.pop("virtual_foot"), set(count.values()), len(count)) == (6, {3}, 8)
    leg = body.surfaces[0].vertices[slice(*body.surfaces[0].vertex_starts[:2])]
    assert body.segment_names[0] == "virtual_leg"
    assert leg[:, 2].min() == pytest.approx(0, abs=1e-6) and np.ptp(leg[:, 0]) > 0.3


def test_points_without_a_joint_of_their_own_lie_where_they_do_in_the_performer(bodies):
    expected = points(bodies["performer"], bodies["performer"].rest_pose[None])
    for body in bodies.values():
        np.testing.assert_allclose(points(body, body.rest_pose[None]), expected, atol=1e-12)
    lower = dict(zip(POINT_NAMES, bodies["eleven_segment"].point_joints, strict=True))
    names = bodies["eleven_segment"].joint_names
    assert names[lower["left_wrist"]] == "left_elbow" and names[lower["head"]] == "neck"
    assert names[lower["right_ankle"]] == "right_knee"


def test_the_measures_of_nine_joints_are_distances_of_the_14_points(bodies):
    body = bodies["nine_joint"]
    at = dict(zip(POINT_NAMES, points(body, body.rest_pose[None])[0], strict=True))
    back = (at["left_hip"] + at["right_hip"]) / 2
    foot = (at["left_ankle"] + at["right_ankle"]) / 2 * (1, 1, 0)
    expected = {
        "forearm": at["left_elbow"] - at["left_wrist"],
        "arm": at["right_elbow"] - at["right_shoulder"],
        "trunk": back - at["neck"],
        "upper back": back - at["left_shoulder"],
        "virtual leg": back - foot,
    }
    lengths = {name: pytest.approx(np.linalg.norm(line)) for name, line in expected.items()}
    assert measures(body) == lengths


def test_an_unknown_template_is_told_with_the_known_ones():
    with pytest.raises(MocapError, match="'twins'; choose one of eleven_segment, nine_joint, p"):
        template("twins")


@pytest.mark.parametrize("level", [0, 1, 2])
def test_every_segment_is_closed_and_turned_outwards(body, level):
    vertices = body.surfaces[level].vertices.astype(float)
    for name, triangles in segment_meshes(body, level):
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        there = {tuple(edge) for edge in edges.tolist()}
        assert len(there) == len(edges), name
        assert there == {(b, a) for a, b in there}, name
        a, b, c = (vertices[triangles[:, i]] for i in range(3))
        assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0, name


@pytest.mark.parametrize("level", [0, 1, 2])
def test_triangles_use_the_vertices_of_their_own_segment(body, level):
    starts = body.surfaces[level].vertex_starts
    for segment, (_, triangles) in enumerate(segment_meshes(body, level)):
        assert starts[segment] <= triangles.min() <= triangles.max() < starts[segment + 1]


def test_there_is_a_coarse_a_middle_and_a_fine_level(body):
    coarse, middle, fine = (len(surface.triangles) for surface in body.surfaces)
    assert 1900 <= coarse <= 2300
    assert 5500 <= middle <= 6500
    assert fine >= 21422


@pytest.mark.parametrize("level", [0, 1, 2])
def test_both_sides_of_the_body_have_the_same_surface(body, level):
    vertices = world_vertices(body, body.rest_pose, level)
    distances, _ = KDTree(vertices).query(vertices * MIRROR)
    assert distances.max() < 1e-6


def test_the_rest_pose_is_allowed_and_not_on_a_cone(body):
    assert within_limits(body, body.rest_pose[None]).all()
    for joint, cone in body.cones.items():
        poses = np.zeros((8, len(body.dofs)))
        angles = np.arange(8) * np.pi / 4
        poses[:, swing_rows(body, joint)] = 0.05 * np.stack([np.cos(angles), np.sin(angles)], 1)
        assert within_limits(body, poses).all(), cone


def test_cones_are_convex_and_anticlockwise_and_touch_their_intervals(body):
    for joint, cone in body.cones.items():
        edges = np.roll(cone, -1, axis=0) - cone
        following = np.roll(edges, -1, axis=0)
        assert (edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0] > -1e-12).all()
        limits = body.dofs.limits[list(swing_rows(body, joint))]
        np.testing.assert_allclose(np.stack([cone.min(axis=0), cone.max(axis=0)], 1), limits)


def test_swing_axes_are_perpendicular_to_each_other_and_twists_lie_along_the_bone(body):
    for joint in body.cones:
        first, second = body.dofs.axes[list(swing_rows(body, joint))]
        assert abs(first @ second) < 1e-12
    twists = {"left_shoulder_twist", "right_hip_twist", "left_forearm_twist", "left_knee_twist"}
    for name in twists.intersection(body.dofs.names):
        row = body.dofs.names.index(name)
        tail = body.tails[body.dofs.joints[row]]
        assert abs(body.dofs.axes[row] @ tail) == pytest.approx(np.linalg.norm(tail))


def test_the_mirrored_pose_gives_the_mirrored_body(body):
    pose = clamped(body, np.random.default_rng(4).standard_normal((1, len(body.dofs))))[0]
    mirrored = mirrored_pose(body, pose)
    here, there = points(body, np.stack([pose, mirrored]))
    swapped = [POINT_NAMES.index(other_side(name)) for name in POINT_NAMES]
    np.testing.assert_allclose(there[swapped], here * MIRROR, atol=1e-12)
    bounds = world_vertices(body, pose) * MIRROR
    np.testing.assert_allclose(
        np.sort(world_vertices(body, mirrored)[:, 0]), np.sort(bounds[:, 0]), atol=1e-6
    )


def test_limits_spreads_and_directions_are_the_same_on_both_sides(body):
    dofs = body.dofs
    rows = [i for i, name in enumerate(dofs.names) if name.startswith("left_")]
    others = [dofs.names.index(other_side(dofs.names[row])) for row in rows]
    np.testing.assert_array_equal(dofs.limits[rows], dofs.limits[others])
    np.testing.assert_array_equal(dofs.rest_spread[rows], dofs.rest_spread[others])
    assert [dofs.directions[row] for row in rows] == [dofs.directions[row] for row in others]


def test_parts_come_in_the_order_of_the_search(bodies):
    limbs = ["left_arm", "right_arm", "left_leg", "right_leg"]
    ends = ["head", "left_hand", "right_hand", "left_foot", "right_foot"]
    names = {key: [part.name for part in body.parts] for key, body in bodies.items()}
    assert names["performer"] == ["torso", "spine", *limbs, *ends]
    assert names["sixteen_segment"] == ["torso", *limbs, *ends]
    assert names["eleven_segment"] == ["torso", "waist", *limbs, "head"]
    assert names["nine_joint"] == ["torso", "back", *limbs[:2], *ends[:3]]


def test_parts_share_no_dofs_and_cover_all(body):
    rows = [row for part in body.parts for row in part.dofs]
    assert sorted(rows) == list(range(len(body.dofs)))


def test_a_limb_is_gridded_over_three_angles_of_its_ball_and_one_of_its_hinge(body):
    part = next(part for part in body.parts if part.name == "right_arm")
    assert [body.dofs.names[row] for row in part.grid] == [
        "right_shoulder_flexion",
        "right_shoulder_abduction",
        "right_shoulder_twist",
        "right_elbow_flexion",
    ]


def test_exactly_the_segments_of_a_part_move_with_its_dofs(body):
    rng = np.random.default_rng(5)
    rest = world_vertices(body, body.rest_pose, 0)
    starts = body.surfaces[0].vertex_starts
    for part in body.parts:
        pose = body.rest_pose
        pose[list(part.dofs)] = rng.uniform(0.05, 0.2, len(part.dofs))
        shift = np.abs(world_vertices(body, pose, 0) - rest).max(axis=1)
        moved = [s for s in range(len(starts) - 1) if shift[starts[s] : starts[s + 1]].max() > 1e-6]
        assert moved == list(part.segments), part.name
