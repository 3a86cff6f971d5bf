from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.body import Skin
from silhouette_mocap.core.body.kinematics import (
    joint_transforms,
    points,
    rest_height,
    world_vertices,
)
from silhouette_mocap.core.initialisation.shape_model import ShapeModel
from synthetic import small_body

BODY = small_body("performer")
MODEL = ShapeModel(BODY)
NAMES = [factor.name for factor in MODEL.factors]


def logs_of(**changes):
    logs = np.zeros(len(MODEL))
    for name, value in changes.items():
        logs[NAMES.index(name.replace("_", " "))] = value
    return logs


def between(body, *names):
    joints = [body.joint_names.index(name) for name in names]
    places = joint_transforms(body, body.rest_pose[None])[0, joints, :, 3]
    return np.linalg.norm(places[1] - places[0])


def test_a_bone_made_longer_moves_what_hangs_on_it_on_both_sides():
    longer = MODEL.changed(BODY, logs_of(thigh_length=np.log(1.2)))
    for side in ("left", "right"):
        assert between(longer, f"{side}_hip", f"{side}_knee") == pytest.approx(
            1.2 * between(BODY, f"{side}_hip", f"{side}_knee")
        )
        for bone in (("knee", "ankle"), ("shoulder", "elbow"), ("elbow", "wrist")):
            names = [f"{side}_{joint}" for joint in bone]
            assert between(longer, *names) == pytest.approx(between(BODY, *names))
    taller = rest_height(longer) - rest_height(BODY)
    thigh = between(BODY, "left_hip", "left_knee")
    assert taller == pytest.approx(0.2 * thigh * np.cos(np.radians(4)), abs=1e-3)


def test_the_soles_stay_on_the_floor():
    changed = MODEL.changed(BODY, np.random.default_rng(0).normal(0, 0.1, len(MODEL)))
    assert world_vertices(changed, changed.rest_pose)[:, 2].min() == pytest.approx(
        world_vertices(BODY, BODY.rest_pose)[:, 2].min(), abs=1e-6
    )


def test_a_girth_changes_one_segment_across_its_bone_and_no_joint():
    names = [f"forearm_{kind}_{k}" for kind in ("width", "depth") for k in (1, 2, 3)]
    logs = logs_of(**dict.fromkeys(names, np.log(1.3)))
    thicker = MODEL.changed(BODY, logs)
    assert np.allclose(points(thicker, BODY.rest_pose[None]), points(BODY, BODY.rest_pose[None]))
    segment = BODY.segment_names.index("left_forearm")
    starts = BODY.surfaces[0].vertex_starts
    bone = BODY.tails[BODY.segment_joints[segment]]
    axis = bone / np.linalg.norm(bone)
    radii, lengths = [], []
    for body in (BODY, thicker):
        vertices = body.surfaces[0].vertices[starts[segment] : starts[segment + 1]].astype(float)
        along = vertices @ axis
        radii.append(np.linalg.norm(vertices - along[:, None] * axis, axis=1))
        lengths.append(along)
    assert np.allclose(radii[1], 1.3 * radii[0], atol=1e-6)
    assert np.allclose(lengths[1], lengths[0], atol=1e-6)
    others = np.ones(len(BODY.surfaces[0].vertices), bool)
    for side in ("left", "right"):
        own = BODY.segment_names.index(f"{side}_forearm")
        others[starts[own] : starts[own + 1]] = False
    assert np.array_equal(thicker.surfaces[0].vertices[others], BODY.surfaces[0].vertices[others])


def test_all_factors_alike_scale_the_body():
    scaled = MODEL.changed(BODY, np.full(len(MODEL), np.log(1.1)))
    low = world_vertices(BODY, BODY.rest_pose)[:, 2].min()
    ours = world_vertices(scaled, scaled.rest_pose)
    expected = 1.1 * world_vertices(BODY, BODY.rest_pose)
    assert np.abs(ours - expected - [0, 0, low - 1.1 * low]).max() < 1e-5


@pytest.mark.parametrize("segment", ["chest", "left_upper_arm", "right_shank", "left_foot", "head"])
def test_rates_are_the_finite_differences_of_places(segment):
    rng = np.random.default_rng(len(segment))
    body = MODEL.changed(BODY, rng.normal(0, 0.1, len(MODEL)))
    pose, index = rng.normal(0, 0.3, len(body.dofs)), body.segment_names.index(segment)
    joint = int(body.segment_joints[index])
    part = slice(*body.surfaces[-1].vertex_starts[index : index + 2])
    transforms = joint_transforms(body, pose[None])[0]
    local = body.surfaces[-1].vertices[part].astype(float)
    direction = rng.normal(size=3)
    slopes = np.tile(direction @ transforms[joint, :, :3], (len(local), 1))
    rates = MODEL.point_rates(body, index, local, slopes)
    rates = rates + direction @ MODEL.joint_rates(body, transforms)[joint]
    step = 1e-4
    for factor in range(len(MODEL)):
        places = []
        for sign in (-1, 1):
            logs = np.zeros(len(MODEL))
            logs[factor] = sign * step
            other = MODEL.changed(body, logs)
            # the soles' height moves the root, which the equations leave to the pose
            other = replace(other, offsets=np.concatenate([body.offsets[:1], other.offsets[1:]]))
            moved = joint_transforms(other, pose[None])[0, joint]
            vertices = other.surfaces[-1].vertices[part].astype(float)
            places.append((vertices @ moved[:, :3].T + moved[:, 3]) @ direction)
        difference = (places[1] - places[0]) / (2 * step)
        # vertices are float32: 6e-8 m over steps of 2e-4; hats have kinks
        worst = np.quantile(np.abs(difference - rates[:, factor]), 0.98)
        assert worst < 2e-3, NAMES[factor]


def test_a_skinned_body_keeps_its_proportions():
    skins = [
        Skin(np.zeros((len(s.vertices), 4), int), np.tile([1.0, 0, 0, 0], (len(s.vertices), 1)))
        for s in BODY.surfaces
    ]
    skinned = replace(
        BODY, surfaces=tuple(replace(s, skin=k) for s, k in zip(BODY.surfaces, skins, strict=True))
    )
    model = ShapeModel(skinned)
    assert len(model) == 1
    larger = model.changed(skinned, np.array([np.log(1.25)]))
    assert np.allclose(larger.offsets[1:], 1.25 * skinned.offsets[1:])
    assert np.allclose(larger.surfaces[0].vertices, 1.25 * skinned.surfaces[0].vertices)


def test_people_of_one_build_are_likelier_than_thin_arms_on_a_heavy_trunk():
    girths = np.array([factor.kind == "girth" for factor in MODEL.factors])
    heavy = 0.2 * girths
    odd = np.where([name.startswith("forearm") for name in NAMES], -0.2, heavy)
    assert heavy @ MODEL.precision @ heavy < 0.3 * odd @ MODEL.precision @ odd
