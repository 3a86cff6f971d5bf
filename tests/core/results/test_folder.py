"""One run at a time in a folder."""

import subprocess
import sys

import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.results.folder import LOCK, occupied

HOLDING = """
import sys
from pathlib import Path
from silhouette_mocap.core.results.folder import occupied
with occupied(Path(sys.argv[1])):
    print("in", flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def other_run(tmp_path):
    """Another process in the folder ``out``."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDING, str(tmp_path / "out")],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout.readline() == "in\n"
    yield process
    process.kill()
    process.wait()


def test_a_second_run_is_refused_with_the_first_one_named(other_run, tmp_path):
    wanted = rf"out: another run writes into this folder \(process {other_run.pid} on .* since"
    with pytest.raises(MocapError, match=wanted), occupied(tmp_path / "out"):
        pass


def test_a_killed_run_frees_its_folder(other_run, tmp_path):
    other_run.kill()
    other_run.wait()
    with occupied(tmp_path / "out"):
        assert (tmp_path / "out" / LOCK).exists()
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


def test_a_run_that_ends_frees_its_folder(other_run, tmp_path):
    other_run.communicate()
    with occupied(tmp_path / "out"):
        pass


def test_a_folder_that_was_made_for_nothing_goes_away(tmp_path):
    with pytest.raises(ZeroDivisionError), occupied(tmp_path / "a" / "b"):
        raise ZeroDivisionError
    assert not (tmp_path / "a").exists() and tmp_path.exists()


def test_a_folder_with_something_in_it_stays(tmp_path):
    with occupied(tmp_path / "a"):
        (tmp_path / "a" / "result").write_text("x", "utf-8")
    assert [path.name for path in (tmp_path / "a").iterdir()] == ["result"]


def test_an_empty_folder_of_the_user_stays(tmp_path):
    (tmp_path / "a").mkdir()
    with occupied(tmp_path / "a"):
        pass
    assert (tmp_path / "a").exists()
