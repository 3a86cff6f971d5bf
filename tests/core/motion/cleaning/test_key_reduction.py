from itertools import combinations

import numpy as np
import pytest
from moving import motion_with, swaying
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation
from silhouette_mocap.core.body.kinematics import carried_points, chained, joint_motions, points
from silhouette_mocap.core.motion.cleaning.key_chains import Chains, Track
from silhouette_mocap.core.motion.cleaning.key_reduction import reduced_keys
from silhouette_mocap.core.motion.curves import followed, quaternions
from silhouette_mocap.core.progress import SILENCE
from synthetic import small_body

BODY = small_body("performer")


@pytest.fixture(scope="module")
def motion():
    poses = swaying(BODY, 3.0, 30.0)
    return motion_with(BODY, poses, locked=np.arange(len(poses)) == 41)


@pytest.fixture(scope="module")
def reduced(motion):
    return {mm: reduced_keys(BODY, motion, mm, SILENCE) for mm in (2.0, 10.0)}


def test_no_point_is_further_off_than_was_asked_for(reduced):
    for asked, keys in reduced.items():
        assert 0.3 * asked < keys.points_mm.max() <= asked


def test_more_tolerance_leaves_fewer_keys(motion, reduced):
    few, fewer = (reduced[mm].keyed.mean() for mm in (2.0, 10.0))
    assert fewer < 0.8 * few < 0.4


def test_the_error_told_is_the_error_measured(motion, reduced):
    keyed = reduced[10.0].keyed
    motions = joint_motions(BODY, motion.pose)
    after = np.stack(
        [followed(motions[:, j], np.flatnonzero(keyed[:, j])) for j in range(keyed.shape[1])], 1
    )
    moved = carried_points(BODY, chained(BODY, after)) - points(BODY, motion.pose)
    told = reduced[10.0].as_dict()
    assert told["error_mm"]["max"] == pytest.approx(1000 * np.linalg.norm(moved, axis=2).max())
    turned = Rotation.from_matrix(
        (motions[..., :3].transpose(0, 1, 3, 2) @ after[..., :3]).reshape(-1, 3, 3)
    )
    assert told["error_deg"]["max"] == pytest.approx(np.degrees(turned.magnitude().max()))
    assert told["kept"] == keyed.sum() and told["of"] == keyed.size


def test_ends_and_locked_frames_are_keys_of_all_joints(reduced):
    for keys in reduced.values():
        assert keys.keyed[[0, 41, -1]].all()


def test_a_joint_that_rests_has_no_other_keys(motion, reduced):
    ends = BODY.joint_names.index("left_knee")
    still = motion.pose.copy()
    still[:, BODY.dofs.joints == ends] = 0.3
    found = reduced_keys(BODY, motion_with(BODY, still), 5.0, SILENCE)
    gaps = np.diff(np.flatnonzero(found.keyed[:, ends]))
    assert (gaps == 60).any() and len(gaps) == 2


def test_no_chain_of_curves_has_fewer_keys():
    """All sets of keys of a short motion of one joint, tried one by one."""
    rng = np.random.default_rng(8)
    vectors = np.cumsum(rng.normal(0, 0.05, (9, 3)), axis=0)
    motions = np.zeros((9, 3, 4))
    motions[..., :3] = Rotation.from_rotvec(vectors).as_matrix()
    track = Track.of(motions, 0.5)
    ends = np.isin(np.arange(9), (0, 8))
    chains = Chains.of([track], ends, np.arange(1, 9))
    allowance = 0.02

    values = quaternions(motions[..., :3])
    natural = np.gradient(values, axis=0)

    def displaced(inner):
        keys = np.array([0, *inner, 8])
        curve = CubicHermiteSpline(keys, values[keys], natural[keys])(np.arange(9))
        rotations = Rotation.from_quat(curve[:, [1, 2, 3, 0]])
        return 0.5 * (rotations.inv() * Rotation.from_rotvec(vectors)).magnitude().max()

    fewest = next(
        count
        for count in range(8)
        if any(displaced(inner) <= allowance for inner in combinations(range(1, 8), count))
    )
    found = np.flatnonzero(chains.fewest(allowance)[:, 0])
    assert 1 <= fewest <= 6
    assert len(found) == fewest + 2 and displaced(found[1:-1]) <= allowance


@pytest.mark.parametrize("count", [1, 2])
def test_the_shortest_motions_keep_their_keys(count):
    motion = motion_with(BODY, swaying(BODY, 1.0, 30.0)[:count])
    assert reduced_keys(BODY, motion, 5.0, SILENCE).keyed.all()
