from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.locks import read_locks, write_locks
from synthetic import dof_values, small_body

BODY = small_body("sixteen_segment")
NAMES = np.array(BODY.dofs.names)


def bent(angle):
    return dof_values(BODY, left_knee_flexion=angle)


def test_what_is_written_is_read(tmp_path):
    locks = {7: bent(0.3), 3: bent(0.1), 20: bent(0.2)}
    write_locks(tmp_path / "locks.npz", BODY, locks)
    found = read_locks(tmp_path / "locks.npz", BODY, (3, 10))
    assert list(found) == [3, 7]
    np.testing.assert_array_equal(found[7], locks[7])


def test_no_path_means_no_locks():
    assert read_locks(None, BODY, (0, 10)) == {}


def test_dofs_may_come_in_any_order_and_only_marked_frames_count(tmp_path):
    order = np.random.default_rng(1).permutation(len(NAMES))
    poses = np.stack([bent(0.1), bent(0.2), bent(0.3)])
    path = tmp_path / "motion.npz"
    marked = np.array([True, False, True])
    np.savez(path, frames=np.arange(3), pose=poses[:, order], dof_names=NAMES[order], locked=marked)
    found = read_locks(path, BODY, (0, 10))
    assert list(found) == [0, 2]
    np.testing.assert_array_equal(found[2], bent(0.3))


def faulty(**changes):
    stored = {"frames": np.arange(2), "pose": np.stack([bent(0.1)] * 2), "dof_names": NAMES}
    return {key: value for key, value in (stored | changes).items() if value is not None}


NOT_A_NUMBER = np.stack([bent(0.1), bent(np.nan)])


@pytest.mark.parametrize(
    ("stored", "told"),
    [
        (faulty(pose=None), "holds no locked poses"),
        (faulty(pose=np.zeros((2, 3))), "do not belong together"),
        (faulty(frames=np.zeros(2, int)), "locks a frame twice"),
        (faulty(frames=np.array([0.5, 1.0])), "frames that are no whole numbers"),
        (faulty(locked=np.array(["yes", "no"])), "by no truth values"),
        (faulty(dof_names=np.char.add(NAMES, "x")), "poses of another body"),
        (faulty(pose=NOT_A_NUMBER), r"frame 1.*left_knee_flexion is no number"),
        (faulty(pose=np.stack([bent(-0.5)] * 2)), r"frame 0.*left_knee_flexion is 0.5 beyond"),
    ],
)
def test_each_fault_is_told_in_a_line(tmp_path, stored, told):
    path = tmp_path / "locks.npz"
    np.savez(path, **stored)
    with pytest.raises(MocapError, match=told) as fault:
        read_locks(path, BODY, (0, 10))
    assert str(path) in str(fault.value)


def test_poses_of_a_body_of_other_size_are_taken(tmp_path):
    write_locks(tmp_path / "locks.npz", BODY, {1: bent(0.1)})
    other = replace(BODY, offsets=BODY.offsets * 1.1)
    np.testing.assert_array_equal(read_locks(tmp_path / "locks.npz", other, (0, 5))[1], bent(0.1))
