"""The judge of the coarse mesh, judged."""

from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.bench.levels import equal_steps, level_check
from silhouette_mocap.core.bench.stage import studio
from silhouette_mocap.core.body.kinematics import joint_transforms
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.optimisers.evolution import Evolution

QUICK = Evolution(population=40, generations=30, first_step=0.01)


def checked(body):
    return level_check(body, studio(), 1, lambda: None, QUICK)


@pytest.fixture(scope="module")
def body():
    """The coarse surface as coarse and as finest one."""
    whole = template("sixteen_segment")
    coarse = whole.surfaces[0]
    return replace(whole, surfaces=(coarse, replace(coarse, outline_distance=0.0)))


def test_equal_meshes_differ_in_nothing_and_lead_to_the_same_pose(body):
    check = checked(body)
    for values in (check.mask_xor, check.energy_difference, check.pose_change):
        assert values.max() == 0
    assert 0 < check.own_change.mean() < 20


def test_a_surface_that_lies_beside_the_other_is_found_beside_it(body):
    coarse, full = body.surfaces
    aside = replace(coarse, vertices=coarse.vertices + np.float32([0, 0, 0.03]))
    check = checked(replace(body, surfaces=(aside, full)))
    assert check.mask_xor.min() > 0.02
    assert check.energy_difference.max() > 0
    assert 10 < check.best_pose_shift.mean() < 60


def test_a_step_along_any_column_moves_joints_and_bone_ends_as_far(body):
    pose = np.random.default_rng(3).normal(0, 0.2, len(body.dofs))
    steps = equal_steps(body, pose)

    def ends(pose):
        transforms = joint_transforms(body, pose[None])[0]
        tails = (transforms[..., :3] @ body.tails[..., None])[..., 0] + transforms[..., 3]
        return np.concatenate([transforms[..., 3], tails])

    def moved(column):
        change = (ends(pose + 1e-5 * column) - ends(pose)) / 1e-5
        return np.sqrt((change**2).sum(axis=1).mean())

    lengths = np.array([moved(column) for column in steps.T])
    assert (lengths < 1.001).all()
    # but for both arms' and the head's turns about themselves
    assert np.count_nonzero(lengths > 0.97) >= 24
