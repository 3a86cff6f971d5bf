import numpy as np
import pytest
from silhouette_mocap.core.bench.sequences import sequence
from silhouette_mocap.core.body.kinematics import joint_transforms, within_limits
from silhouette_mocap.core.fitting.torso_volume import TorsoVolume
from synthetic import small_body


@pytest.mark.parametrize(("name", "most_deg"), [("A", 12), ("B", 35)])
def test_sequences_are_possible_motions_that_their_grids_can_follow(name, most_deg):
    body = small_body("sixteen_segment")
    poses = sequence(body, name, 120)
    assert np.array_equal(poses[0], body.rest_pose)
    assert within_limits(body, poses).all()
    volume, transforms = TorsoVolume.of(body), joint_transforms(body, poses)
    for part in body.parts:
        if part.role in ("limb", "end"):
            assert not volume.holds_part(transforms, part).any(), part.name
    gridded = sorted({dof for part in body.parts for dof in part.grid})
    steps = np.degrees(np.abs(np.diff(poses[:, gridded], axis=0)))
    assert 0.5 * most_deg < steps.max() < most_deg


def test_the_dancer_is_faster():
    body = small_body("sixteen_segment")
    slow, fast = (np.abs(np.diff(sequence(body, name, 90), axis=0)).mean() for name in "AB")
    assert fast > 1.8 * slow
