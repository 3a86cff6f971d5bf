"""The library's transforms, and what happens when it is missing or stale."""

import ctypes

import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import joint_transforms
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.native import build, library
from silhouette_mocap.core.rendering.model import body_record


@pytest.mark.parametrize("name", ["sixteen_segment", "performer"])
def test_transforms_are_those_of_the_written_convention(name):
    body = template(name)
    rng = np.random.default_rng(0)
    poses = rng.normal(0, 0.8, (20, len(body.dofs)))
    poses[0] = 0
    poses[1] *= 1e-9  # tiny angles must not lose their digits
    poses[2] *= 10
    record = body_record(body, 0)
    out = np.empty((len(poses), len(body.joint_names), 3, 4))
    code = library.load().sm_transforms(
        ctypes.byref(record), poses.ctypes.data, len(poses), out.ctypes.data
    )
    assert code == 0
    np.testing.assert_allclose(out, joint_transforms(body, poses), rtol=0, atol=1e-12)


def test_a_missing_library_is_refused_with_the_command_that_builds_it(tmp_path, monkeypatch):
    monkeypatch.setattr(library, "FOLDER", tmp_path)
    with pytest.raises(MocapError, match=r"missing; build it: .*build\.py"):
        library.load.__wrapped__()


def test_a_library_built_from_other_sources_is_refused(tmp_path, monkeypatch):
    name = library.library_name(library.host_target())
    (tmp_path / name).write_bytes((library.FOLDER / name).read_bytes())
    for source in library.FOLDER.glob("*.[ch]"):
        (tmp_path / source.name).write_bytes(source.read_bytes())
    monkeypatch.setattr(library, "FOLDER", tmp_path)
    assert library.load.__wrapped__().sm_abi() == library.ABI
    with (tmp_path / "kernel.h").open("a") as header:
        header.write("/* changed */\n")
    with pytest.raises(MocapError, match="built from other sources"):
        library.load.__wrapped__()


def test_a_file_that_is_no_library_is_refused(tmp_path, monkeypatch):
    (tmp_path / library.library_name(library.host_target())).write_bytes(b"not a library")
    monkeypatch.setattr(library, "FOLDER", tmp_path)
    with pytest.raises(MocapError, match="cannot be loaded"):
        library.load.__wrapped__()


def test_a_platform_without_a_kernel_is_refused_with_what_helps(monkeypatch):
    monkeypatch.setenv("SILHOUETTE_MOCAP_TARGET", "amiga-68k")
    with pytest.raises(MocapError, match=r"no native kernel for amiga-68k, .*reference evaluator"):
        library.load.__wrapped__()


def test_line_ends_do_not_change_the_fingerprint(tmp_path):
    (tmp_path / "a.c").write_bytes(b"int x;\nint y;\n")
    unix = build.fingerprint(tmp_path)
    (tmp_path / "a.c").write_bytes(b"int x;\r\nint y;\r\n")
    assert build.fingerprint(tmp_path) == unix != ""
    (tmp_path / "a.c").write_bytes(b"int z;\n")
    assert build.fingerprint(tmp_path) != unix


def test_every_target_has_its_own_library_name_and_unknown_ones_are_named():
    names = [build.library_name(target) for target in build.TARGETS]
    assert len(set(names)) == len(names)
    with pytest.raises(SystemExit, match="no native kernel for amiga"):
        build.library_name("amiga")
