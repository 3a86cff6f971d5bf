"""A folder that looks like the prototypes': how it is compiled, imported and left alone."""

import sys

import numpy as np
import pytest
from silhouette_mocap.core.bench.prototypes import FILES, Prototypes, are_in, their_poses
from silhouette_mocap.core.errors import MocapError

SCENE = """
import numba as nb

@nb.njit(cache=True)
def slow(x):
    return 2 * x

@nb.njit
def plain(x):
    return 3 * x

def build(lod=False):
    return (slow(1), plain(1), lod)
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name in ("scene", "ck"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    path = tmp_path / "prototypes"
    path.mkdir()
    texts = {"scene.py": SCENE, "ck.py": "import scene", "gl_eval.py": "", "kern.c": "int one;"}
    for name, text in texts.items():
        (path / name).write_text(text)
    yield path
    for name in ("scene", "ck"):
        sys.modules.pop(name, None)


def test_a_folder_holds_the_prototypes_if_all_files_are_there(folder):
    assert are_in(folder)
    (folder / "ck.py").unlink()
    assert not are_in(folder)
    assert not are_in(None)


def test_they_are_imported_without_numba_and_without_a_trace(folder, tmp_path, monkeypatch):
    real = object()
    monkeypatch.setitem(sys.modules, "numba", real)
    before = list(sys.path)
    prototypes = Prototypes(folder, tmp_path)
    assert prototypes.meshes == {"full": (2, 3, False), "coarse": (2, 3, True)}
    assert (tmp_path / "kern_native.so").is_file()
    assert sys.modules["numba"] is real
    assert sys.path == before
    assert {path.name for path in folder.iterdir()} == set(FILES)


def test_a_kernel_that_cannot_be_compiled_is_a_fault_in_one_line(folder, tmp_path):
    (folder / "kern.c").write_text("no C at all")
    with pytest.raises(MocapError, match=r"kern\.c: cannot be compiled .*error"):
        Prototypes(folder, tmp_path)


def test_poses_go_to_their_order_and_back():
    poses = np.arange(70.0).reshape(2, 35)
    theirs = their_poses(poses)
    assert theirs[0, :7].tolist() == [0, 1, 2, 5, 4, 3, 6]
    assert np.array_equal(their_poses(theirs), poses)
