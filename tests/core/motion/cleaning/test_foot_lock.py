from dataclasses import replace

import numpy as np
import pytest
from moving import rms, stepping
from silhouette_mocap.core.body.kinematics import joint_transforms, within_limits
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.cleaning.block_band import BlockBand
from silhouette_mocap.core.motion.cleaning.contacts import slides, stretches, touching
from silhouette_mocap.core.motion.cleaning.foot_lock import Floor, FootLock
from silhouette_mocap.core.motion.cleaning.soles import Soles
from silhouette_mocap.core.progress import SILENCE
from synthetic import small_body

BODY = small_body("performer")
SOLES = Soles.of(BODY)
RATE = 30.0
SIDES = ("left", "right")


def soles_in(poses, body=BODY):
    return Soles.of(body).places(joint_transforms(body, poses))


def drifting(body=BODY, rate=RATE):
    """Poses of a body that lifts a foot while it drifts and bobs, and which soles stand."""
    poses, left_stands = stepping(body, rate)
    soles = Soles.of(body)
    touched = np.where(soles.feet == 0, left_stands[:, None], True)
    floor = soles_in(poses, body)[..., 2].min()
    time = np.arange(len(poses)) / rate
    poses[:, 0] += 0.03 * np.sin(2 * np.pi * 0.4 * time)
    poses[:, 1] += 0.02 * np.sin(2 * np.pi * 0.6 * time + 1)
    poses[:, 2] += 0.01 * np.sin(2 * np.pi * 0.5 * time) - floor
    return poses, touched


def standing(touched):
    """Points of soles and the stretches in which they touch the floor."""
    return [(p, run) for p in range(touched.shape[1]) for run in stretches(touched[:, p])]


@pytest.fixture(scope="module")
def held():
    """Before, after and which soles stand."""
    poses, touched = drifting()
    lock = FootLock(BODY, SOLES, poses, RATE, np.zeros(len(poses), bool))
    return poses, lock.solved(Floor(0.0, touched), SILENCE), touched


def test_what_stands_slides_less_than_a_tenth_of_a_millimetre(held):
    before, after, touched = held
    assert slides(soles_in(before), touched).max() > 0.02
    assert slides(soles_in(after), touched).max() < 1e-4


def test_what_stands_neither_rises_nor_sinks(held):
    before, after, touched = held
    rises = [
        max(np.ptp(soles_in(poses)[run, point, 2]) for point, run in standing(touched))
        for poses in (before, after)
    ]
    assert rises[1] < 1e-4 < 0.01 < rises[0]


def test_no_sole_is_below_the_floor_and_limits_hold(held):
    before, after, _ = held
    assert soles_in(before)[..., 2].min() < -0.005
    assert soles_in(after)[..., 2].min() > -1e-4
    assert within_limits(BODY, after).all()


def test_nothing_pops_where_a_contact_begins_or_ends(held):
    """The lifted foot's acceleration there is no more than a fifth above its peak before."""
    before, after, touched = held
    ends = np.flatnonzero(np.diff(touched[:, 0].astype(int)))
    near = (np.abs(np.arange(len(before) - 2)[:, None] + 1 - ends) <= 4).any(axis=1)
    left = SOLES.feet == 0
    peaks = [
        np.linalg.norm(np.diff(soles_in(poses)[:, left], 2, axis=0), axis=2)
        for poses in (before, after)
    ]
    assert peaks[1][near].max() < 1.2 * peaks[0].max()


def test_only_the_legs_and_the_place_of_the_root_change(held):
    before, after, _ = held
    moved = {BODY.dofs.names[d] for d in np.flatnonzero(np.abs(after - before).max(axis=0))}
    legs = ("root_x", "root_y", "root_z", "hip", "knee", "ankle", "toes")
    assert moved and all(any(leg in name for leg in legs) for name in moved)


def test_without_contacts_and_above_the_floor_nothing_changes():
    poses, touched = drifting()
    poses[:, 2] += 0.5
    lock = FootLock(BODY, SOLES, poses, RATE, np.zeros(len(poses), bool))
    assert np.abs(lock.solved(Floor(0.0, touched & False), SILENCE) - poses).max() < 1e-12


def test_the_change_is_gone_half_a_second_after_a_contact():
    poses, touched = drifting()
    touched[20:] = False
    poses[:, 2] += 0.1
    lock = FootLock(BODY, SOLES, poses, RATE, np.zeros(len(poses), bool))
    change = np.abs(lock.solved(Floor(0.05, touched), SILENCE) - poses)
    assert change[:20].max() > 0.01 and change[35:].max() < 0.1 * change[:20].max()


def test_a_foot_that_swings_through_the_floor_is_lifted_over_it():
    poses, touched = drifting()
    poses[:, 2] -= 0.03
    lock = FootLock(BODY, SOLES, poses, RATE, np.zeros(len(poses), bool))
    after = lock.solved(Floor(0.0, touched & False), SILENCE)
    assert soles_in(poses)[..., 2].min() < -0.03
    assert -1e-4 < soles_in(after)[..., 2].min() < 1e-3
    assert np.abs(after[:, 2] - poses[:, 2]).max() < 0.03


def test_ankles_that_bend_no_further_leave_the_rest_to_others():
    ankle, count = BODY.dofs.names.index("left_ankle_flexion"), 60
    limits = BODY.dofs.limits.copy()
    limits[ankle] = 0.25, 0.35
    stiff = replace(BODY, dofs=replace(BODY.dofs, limits=limits))
    poses = np.repeat(stepping(BODY, RATE)[0][:1], count, axis=0)
    poses[:, 1] = -0.2 * np.sin(2 * np.pi * np.arange(count) / 60) ** 2
    lock = FootLock(stiff, SOLES, poses, RATE, np.zeros(count, bool))
    everywhere = np.ones((count, len(SOLES.feet)), bool)
    after = lock.solved(Floor(-0.1, everywhere), SILENCE)
    assert after[:, ankle].min() == pytest.approx(0.25) and within_limits(stiff, after).all()
    assert slides(soles_in(after), everywhere).max() < 1e-3


def test_locked_frames_stay_to_the_bit_and_the_feet_still_stand_still():
    poses, touched = drifting()
    locked = np.arange(len(poses)) == 15
    lock = FootLock(BODY, SOLES, poses, RATE, locked)
    found = lock.solved(Floor(-0.05, touched), SILENCE)
    assert np.array_equal(found[locked], poses[locked])
    assert slides(soles_in(found), touched).max() < 1e-4


@pytest.mark.parametrize(("name", "rate"), [("sixteen_segment", 30.0), ("performer", 120.0)])
def test_other_bodies_and_rates_are_held_too(name, rate):
    body = small_body(name)
    poses, touched = drifting(body, rate)
    lock = FootLock(body, Soles.of(body), poses, rate, np.zeros(len(poses), bool))
    after = soles_in(lock.solved(Floor(0.0, touched), SILENCE), body)
    assert slides(after, touched).max() < 1e-3 and after[..., 2].min() > -1e-3


@pytest.mark.parametrize(("name", "ends"), [("performer", 3), ("sixteen_segment", 2)])
def test_soles_lie_on_the_floor_of_the_rest_pose_heel_to_tip(name, ends):
    body = small_body(name)
    soles = Soles.of(body)
    places = soles_in(body.rest_pose[None], body)[0]
    assert np.abs(places[:, 2]).max() < 1e-3
    for foot, sign in ((0, 1), (1, -1)):
        own = places[soles.feet == foot]
        assert len(own) == ends and (sign * own[:, 0] > 0.05).all()
        assert (np.diff(own[:, 1]) < -0.03).all()
        assert 0.2 < np.ptp(own[:, 1]) < 0.32


def test_a_body_without_feet_is_refused():
    joints = [BODY.joint_names.index(f"{side}_{j}") for side in SIDES for j in ("ankle", "toes")]
    elsewhere = np.where(np.isin(BODY.segment_joints, joints), 0, BODY.segment_joints)
    with pytest.raises(MocapError, match="has no feet; clean with --no-contacts"):
        Soles.of(replace(BODY, segment_joints=elsewhere))


def test_a_step_is_found_and_its_swing_is_not_held():
    poses, left_stands = stepping(BODY, RATE)
    poses[:, 2] -= soles_in(poses)[..., 2].min()
    touched = touching(soles_in(poses), 0.0, RATE)
    left = touched[:, SOLES.feet == 0].any(axis=1)
    assert touched[:, SOLES.feet == 1].all()
    assert not left[40:46].any() and (left != left_stands).sum() <= 8


def test_a_band_is_solved_as_the_whole_matrix_would_be():
    rng = np.random.default_rng(6)
    frames, values, points = 7, 3, 4
    band = BlockBand.zero(frames, values)
    stiffness = rng.uniform(1, 2, values)
    here, there = rng.normal(size=(2, frames - 1, points, values))
    slopes, wanted = rng.normal(size=(frames, points, values)), rng.normal(size=(frames, points))
    pairs = rng.normal(size=(frames - 1, points))
    weights, couplings = rng.uniform(0, 3, wanted.shape), rng.uniform(0, 3, pairs.shape)
    band.add_smoothness(stiffness, 5.0)
    band.add_frames(slopes, wanted, weights)
    band.add_pairs(here, there, pairs, couplings)

    def residuals(flat):
        x = flat.reshape(frames, values)
        moved = np.einsum("tpk,tk->tp", there, x[1:]) - np.einsum("tpk,tk->tp", here, x[:-1])
        return np.concatenate(
            [
                (np.sqrt(stiffness) * x).ravel(),
                (np.sqrt(5.0 * stiffness) * np.diff(x, 2, axis=0)).ravel(),
                (np.sqrt(weights) * (np.einsum("tpk,tk->tp", slopes, x) - wanted)).ravel(),
                (np.sqrt(couplings) * (moved - pairs)).ravel(),
            ]
        )

    zero = residuals(np.zeros(frames * values))
    matrix = np.column_stack([residuals(unit) - zero for unit in np.eye(frames * values)])
    expected = np.linalg.lstsq(matrix, -zero, rcond=None)[0].reshape(frames, values)
    assert np.abs(band.solved() - expected).max() < 1e-10
    assert rms(expected) > 0.1
