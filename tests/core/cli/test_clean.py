"""What the command ``clean`` prints and writes."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.cli import main
from silhouette_mocap.core.motion.motion import read_motion, write_motion


@pytest.fixture
def out(quick_start, small_take, tmp_path, capsys):
    """The folder of a finished fit."""
    words = ["fit", str(small_take), "--out", str(tmp_path / "out"), "--progress", "none"]
    assert main(words) == 0
    capsys.readouterr()
    return tmp_path / "out"


def test_it_sums_up_what_was_done_and_names_what_was_written(out, capsys):
    assert main(["clean", str(out), "--keys", "5", "--progress", "none"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("4 frames by refit at 6 Hz: points moved ")
    assert "contacts with the floor: feet slid by" in lines[1]
    assert lines[2].startswith("keys: ") and " of 68, which cost at most " in lines[2]
    names = ("motion.npz", "report.json", "clean.html")
    assert lines[3:] == [f"wrote {out / name}" for name in names]


def test_the_motion_may_be_named_in_place_of_its_folder(out, tmp_path, capsys):
    other = shutil.copytree(out, tmp_path / "other")
    assert main(["clean", str(out), "--filter", "one-euro", "--no-contacts"]) == 0
    assert main(["clean", str(other / "motion.npz"), "--filter", "one-euro", "--no-contacts"]) == 0
    said = capsys.readouterr().out
    assert "by one-euro at 3 Hz" in said and "contacts" not in said
    assert (out / "motion.npz").read_bytes() == (other / "motion.npz").read_bytes()


def test_lost_frames_that_were_filled_are_named(out, capsys):
    motion = read_motion(out / "motion.npz")
    write_motion(out / "motion.npz", replace(motion, lost=np.array([False, True, True, False])))
    assert main(["clean", str(out)]) == 0
    assert "lost frames filled: 1 to 2\n" in capsys.readouterr().out


def test_undo_puts_everything_back(out, capsys):
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    assert main(["clean", str(out)]) == 0
    assert main(["clean", str(out), "--undo"]) == 0
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
    assert capsys.readouterr().out.endswith(f"wrote {out / 'report.json'}\n")
