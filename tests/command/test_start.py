"""What the command line loads before it answers: nothing it can do without."""

import subprocess
import sys

import pytest

ALWAYS_TOO_MUCH = {"bpy", "mathutils", "gpu", "matplotlib", "OpenGL", "dask", "tkinter", "pytest"}
HEAVY = {"numpy", "cv2", "scipy"}
PROGRAM = """
import sys
sys.argv[1:] = {words!r}
from silhouette_mocap.__main__ import main
code = main()
print(*sorted(sys.modules), file=sys.stderr)
sys.exit(code)
"""


def loaded(*words: str, code: int = 0) -> set[str]:
    """The modules that are loaded once a command has answered."""
    finished = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(words=[str(word) for word in words])],
        capture_output=True, text=True,
    )  # fmt: skip
    assert finished.returncode == code, finished.stderr
    return set(finished.stderr.splitlines()[-1].split())


@pytest.mark.parametrize("words", [("--version",), ("--help",), ("nonsense",)])
def test_what_needs_no_command_loads_no_command(words):
    modules = loaded(*words, code=2 if words == ("nonsense",) else 0)
    assert not modules & (HEAVY | ALWAYS_TOO_MUCH)


def test_no_command_loads_blender_until_it_exports(small_take, tmp_path):
    words = ("masks", small_take, "--out", tmp_path)
    assert not loaded(*words) & (ALWAYS_TOO_MUCH | {"scipy.interpolate"})
    modules = loaded("fit", "none.toml", "--out", tmp_path, code=2)
    assert modules >= HEAVY and not modules & ALWAYS_TOO_MUCH
