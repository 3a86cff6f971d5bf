"""Archives that are missing, cut short, changed or something else: one clear line for each."""

import numpy as np
import pytest
from silhouette_mocap.core.body.file import read_body
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.geometry.archive import read_archive
from silhouette_mocap.core.motion.formats.trc import read_trc
from silhouette_mocap.core.motion.motion import read_motion
from silhouette_mocap.core.motion.point_track import read_point_track


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "some.npz"
    np.savez_compressed(path, points=np.arange(3000.0), names=("a", "b"))
    return path


def test_arrays_come_back_by_name(path):
    stored = read_archive(path, "some.npz", "give another")
    assert list(stored) == ["points", "names"]
    np.testing.assert_array_equal(stored["points"], np.arange(3000.0))


READERS = pytest.mark.parametrize("reader", [read_body, read_motion, read_point_track])


@READERS
def test_a_damaged_archive_is_told_wherever_the_damage_is(reader, path):
    whole = path.read_bytes()
    for start in range(0, len(whole), 97):
        path.write_bytes(whole[:start] + b"\x55" * 40 + whole[start + 40 :])
        with pytest.raises(MocapError, match=r"some\.npz: "):
            reader(path)
        path.write_bytes(whole[:start])
        with pytest.raises(MocapError, match=r"some\.npz: cannot be read as"):
            reader(path)


@READERS
def test_another_archive_is_told(reader, path):
    with pytest.raises(MocapError, match=r"some\.npz: (is no|holds no points)"):
        reader(path)


@pytest.mark.parametrize("reader", [read_body, read_motion, read_point_track, read_trc])
def test_a_missing_file_is_called_so(reader, tmp_path):
    with pytest.raises(MocapError, match=r"none\.npz: no such file; check the path"):
        reader(tmp_path / "none.npz")
