"""Files that appear whole or not at all."""

import os
import subprocess
import sys

import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.files import made_folder, whole_file


def test_the_file_appears_at_the_end_only(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old", "utf-8")
    with whole_file(path) as partial:
        partial.write_text("new", "utf-8")
        assert path.read_text("utf-8") == "old"
    assert path.read_text("utf-8") == "new" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("failure", [ValueError, KeyboardInterrupt])
def test_a_failure_leaves_the_file_as_it_was_and_nothing_beside_it(tmp_path, failure):
    path = tmp_path / "a.txt"
    path.write_text("old", "utf-8")
    with pytest.raises(failure), whole_file(path) as partial:
        partial.write_text("half", "utf-8")
        raise failure
    assert path.read_text("utf-8") == "old" and list(tmp_path.iterdir()) == [path]


def test_the_longest_name_that_the_system_takes_can_be_written(tmp_path):
    path = tmp_path / ("n" * 251 + ".txt")
    with whole_file(path) as partial:
        partial.write_text("x", "utf-8")
    assert path.exists()


def test_a_name_that_is_too_long_says_so(tmp_path):
    path = tmp_path / ("n" * 300 + ".txt")
    with pytest.raises(MocapError, match="give a shorter path"), whole_file(path) as partial:
        partial.write_text("x", "utf-8")


def test_a_folder_in_the_place_of_a_file_is_a_fault(tmp_path):
    (tmp_path / "file").write_text("x", "utf-8")
    with pytest.raises(MocapError, match=r"file/sub: cannot be written \(Not a directory\)"):
        made_folder(tmp_path / "file" / "sub")


@pytest.mark.skipif(sys.platform == "win32", reason="limits of another kind")
def test_a_file_that_may_not_grow_further_is_a_fault(tmp_path):
    import resource

    program = (
        "import sys\nfrom pathlib import Path\n"
        "from silhouette_mocap.core.files import whole_file\n"
        "with whole_file(Path(sys.argv[1])) as partial:\n    partial.write_bytes(bytes(100_000))"
    )
    finished = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "big")],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000)),
        env=os.environ, capture_output=True, text=True,
    )  # fmt: skip
    last = finished.stderr.splitlines()[-1]
    assert "cannot be written (File too large); free space on that disk" in last
    assert list(tmp_path.iterdir()) == []
