import dataclasses

import numpy as np
import pytest
from silhouette_mocap.core.body.file import read_body, write_body
from silhouette_mocap.core.body.table import dof_table
from silhouette_mocap.core.errors import MocapError


def assert_same(a, b):
    """Equality of everything in two values, however deep."""
    assert type(a) is type(b)
    if dataclasses.is_dataclass(a):
        for field in dataclasses.fields(a):
            assert_same(getattr(a, field.name), getattr(b, field.name))
    elif isinstance(a, dict):
        assert list(a) == list(b)
        assert_same(list(a.values()), list(b.values()))
    elif isinstance(a, list | tuple):
        assert len(a) == len(b)
        for x, y in zip(a, b, strict=True):
            assert_same(x, y)
    elif isinstance(a, np.ndarray):
        assert a.dtype == b.dtype
        np.testing.assert_array_equal(a, b)
    else:
        assert a == b


def rewritten(path, **changes):
    """The file with entries changed, or left out where None."""
    with np.load(path) as data:
        values = {name: data[name] for name in data.files} | changes
    np.savez(path, **{name: value for name, value in values.items() if value is not None})


@pytest.fixture
def path(tmp_path, performer_body):
    path = tmp_path / "body.npz"
    write_body(path, performer_body)
    return path


def test_a_body_comes_back_from_its_file_with_everything(tmp_path, body):
    path = tmp_path / "body.npz"
    write_body(path, body)
    assert_same(read_body(path), body)
    assert [p.name for p in tmp_path.iterdir()] == ["body.npz"]


def test_a_body_without_cones_and_parts_comes_back_too(tmp_path, performer_body):
    bare = dataclasses.replace(performer_body, cones={}, parts=())
    write_body(tmp_path / "body.npz", bare)
    assert_same(read_body(tmp_path / "body.npz"), bare)


def test_a_file_of_old_tells_no_outline_distances_and_is_drawn_with_its_first_surface(path):
    gone = {f"surface_{level}_outline_distance": None for level in range(3)}
    rewritten(path, **gone)
    assert [surface.outline_distance for surface in read_body(path).surfaces] == [0, 0, 0]


def test_nothing_in_the_file_is_pickled(path):
    with np.load(path, allow_pickle=False) as data:
        assert all(data[name].dtype != object for name in data.files)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(MocapError, match=r"none\.npz: no such file"):
        read_body(tmp_path / "none.npz")


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut short", b"not a body"])
def test_a_file_that_is_no_archive_is_told(tmp_path, content):
    path = tmp_path / "body.npz"
    path.write_bytes(content)
    with pytest.raises(MocapError, match="cannot be read"):
        read_body(path)


def test_a_lone_array_is_told(tmp_path):
    path = tmp_path / "body.npz"
    with path.open("wb") as stream:
        np.save(stream, np.zeros(3))
    with pytest.raises(MocapError, match="cannot be read"):
        read_body(path)


def test_a_truncated_file_is_told(path):
    path.write_bytes(path.read_bytes()[:-3000])
    with pytest.raises(MocapError, match="cannot be read"):
        read_body(path)


def test_another_archive_is_told(tmp_path):
    path = tmp_path / "motion.npz"
    np.savez(path, version=1, pose=np.zeros((2, 3)))
    with pytest.raises(MocapError, match="is no body file"):
        read_body(path)


def test_another_version_is_told(path):
    rewritten(path, version=99)
    with pytest.raises(MocapError, match="version 99, not 1"):
        read_body(path)


@pytest.mark.parametrize(
    "changes",
    [
        {"offsets": None},
        {"parents": np.full(21, 5, np.int32)},
        {"segment_joints": np.full(21, 99, np.int32)},
        {"part_dofs": np.full(49, 77, np.int32)},
        {"cone_starts": np.zeros(2, np.int32)},
        {"dof_kinds": np.full(49, 2, np.int32)},
        {"surface_0_outline_distance": np.nan},
    ],
)
def test_a_damaged_file_is_told_before_anything_uses_it(path, changes):
    rewritten(path, **changes)
    with pytest.raises(MocapError, match="is a damaged body file"):
        read_body(path)


def test_a_triangle_without_its_vertex_is_told(path, performer_body):
    triangles = performer_body.surfaces[0].triangles.copy()
    triangles[7, 1] = 10**6
    rewritten(path, surface_0_triangles=triangles)
    with pytest.raises(MocapError, match="expected triangles from 0 to"):
        read_body(path)


def test_the_table_has_a_line_for_every_dof(body):
    lines = dof_table(body).splitlines()
    assert len(lines) == len(body.dofs) + 2
    assert len({line.count("|") for line in lines}) == 1
    elbow = next(line for line in lines if "left_elbow_flexion" in line)
    assert "| hinge | -0.71, 0.00, -0.71 | 0° | 150° | — | bends the forearm forwards |" in elbow
    assert f"| root_x | {body.joint_names[0]} | translation | 1.00, 0.00, 0.00 | — |" in lines[2]
