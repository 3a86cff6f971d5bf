from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.fitting.hierarchical import FAITHFUL, HierarchicalTracker
from silhouette_mocap.core.fitting.shares import shares_of
from silhouette_mocap.core.fitting.tracker import Past
from synthetic import dof_values, evaluator, filmed, small_body, small_studio

SETTINGS = replace(FAITHFUL, rounds=2)
STEP = {
    "root_y": -0.05,
    "left_shoulder_abduction": 0.3,
    "right_elbow_flexion": 0.3,
    "left_hip_flexion": 0.2,
    "neck_flexion": 0.2,
}


def fitted(settings, executor=None):
    body, cameras = small_body("sixteen_segment"), small_studio(4)
    silhouettes = filmed(body, cameras, dof_values(body, **STEP))
    tracker = HierarchicalTracker(body, cameras, evaluator, settings, executor)
    return tracker.fit(silhouettes, Past.still(body.rest_pose))


@pytest.mark.parametrize("name", ["performer", "sixteen_segment"])
def test_every_part_is_in_one_share_and_limbs_come_before_their_ends(name):
    body = small_body(name)
    shares = shares_of(body)
    everything = [*shares.trunk, *(p for share in shares.limbs for p in share), *shares.rest]
    assert sorted(p.name for p in everything) == sorted(p.name for p in body.parts)
    assert [p.name for p in shares.rest] == ["head"]
    assert {tuple(p.name for p in share[:2]) for share in shares.limbs} == {
        (f"{side}_{limb}", f"{side}_{end}")
        for side in ("left", "right")
        for limb, end in (("arm", "hand"), ("leg", "foot"))
    }
    dofs = [{dof for p in share for dof in p.dofs} for share in shares.limbs]
    assert sum(map(len, dofs)) == len(set.union(*dofs))


def test_limbs_searched_in_threads_give_bit_for_bit_what_one_after_another_gives():
    shared = replace(SETTINGS, shared_out=True)
    alone = fitted(shared)
    with ThreadPoolExecutor(4) as executor:
        together = fitted(shared, executor)
    assert np.array_equal(alone.pose, together.pose)
    assert alone.energy == together.energy
    assert alone.tally == together.tally


def test_limbs_that_are_shared_out_all_move():
    body = small_body("sixteen_segment")
    pose = fitted(replace(SETTINGS, shared_out=True)).pose
    truth = dof_values(body, **STEP)
    for name in ("left_shoulder_abduction", "right_elbow_flexion", "left_hip_flexion"):
        value, dof = STEP[name], body.dofs.names.index(name)
        assert abs(pose[dof] - truth[dof]) < abs(value) / 2, name


def test_drawing_the_whole_body_for_every_candidate_finds_the_same_pose():
    both = [fitted(replace(SETTINGS, prerendered=chosen)) for chosen in (True, False)]
    assert np.array_equal(both[0].pose, both[1].pose)
    assert both[0].energy == both[1].energy
    assert both[0].tally == both[1].tally
