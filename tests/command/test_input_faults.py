"""What is wrong with the words or files given: one clear line that names it, and exit code 2."""

import shutil
import sys
from pathlib import Path

import pytest
from fault_chapters import CHAPTERS
from faults import Fault, met, table_row
from silhouette_mocap.core import cli
from silhouette_mocap.core.cli import main
from silhouette_mocap.core.motion.motion import read_motion

TABLE = (Path(cli.__file__).parent / "FAULTS.md").read_text("utf-8")
FAULTS = [fault for chapter in CHAPTERS for fault in chapter.faults]


def as_case(fault: Fault):
    marks = [pytest.mark.skipif(bool(fault.unless), reason=fault.unless)] if fault.unless else []
    return pytest.param(fault, id=fault.title.replace(" ", "_"), marks=marks)


@pytest.mark.parametrize("case", [as_case(fault) for fault in FAULTS])
def test_every_fault_is_one_line_and_two(case, small_take, tmp_path):
    told, by_info = met(case, small_take, tmp_path)
    assert told.code == 2, told.error
    assert told.error.count("\n") == 1 and told.error.startswith("silhouette-mocap: ")
    for part in case.says:
        assert part in told.error
    if by_info is not None:
        assert by_info.code == 2 and told.error in by_info.error
    if sys.platform == "linux":
        assert table_row(case, told.shown(tmp_path)) in TABLE, "run .ci/faults.py"


def test_the_table_holds_no_other_faults():
    told_here = [fault for fault in FAULTS if not fault.unless]
    assert sum(line.startswith("| ") for line in TABLE.splitlines()) == (
        len(told_here) + len(CHAPTERS)
    )
    assert len({fault.title for fault in FAULTS}) == len(FAULTS)


def test_a_fault_in_the_middle_of_a_fit_keeps_the_finished_frames(small_take, tmp_path):
    (late,) = (f for f in FAULTS if f.title == "a mask cut short in the middle of a fit")
    met(late, small_take, tmp_path)
    assert read_motion(tmp_path / "out" / "motion.npz").frames.tolist() == [0, 1]


@pytest.fixture
def fault(capsys):
    """The one line that a command complains with."""

    def of(*words) -> str:
        assert main([str(word) for word in words]) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        return error

    return of


@pytest.fixture
def filmed_take(small_take, tmp_path):
    """A copy of the small take whose masks pass for footage that needs a plate."""
    folder = tmp_path / "session" / "small"
    shutil.copytree(small_take.parent, folder)
    text = small_take.read_text("utf-8").replace("silhouettes =", "video =")
    text = text.replace("[performer]", 'plate = "plates/{camera}.png"\n[performer]')
    (folder / "take.toml").write_text(text, "utf-8")
    return folder / "take.toml"


@pytest.mark.parametrize("frames", ["3:1", "9:"])
def test_a_plate_of_no_frames_is_refused(filmed_take, fault, frames):
    line = fault("plate", filmed_take, "--frames", frames)
    assert str(filmed_take) in line and "give frames of the take" in line


def test_cameras_that_plates_know_nothing_of_name_who_names_them(filmed_take, tmp_path, fault):
    recipes = tmp_path / "plates.toml"
    recipes.write_text("[cam_9]\n", "utf-8")
    line = fault("plate", filmed_take, "--recipes", recipes)
    assert f'{recipes}: there is no camera "cam_9"; the cameras are cam_01' in line
    line = fault("plate", filmed_take, "--without", "cam_8")
    assert f'{filmed_take}: there is no camera "cam_8"' in line


def test_a_score_that_cannot_be_written_names_the_file(small_take, tmp_path, fault):
    truth, target = small_take.with_name("truth.npz"), tmp_path / "missing" / "score.json"
    line = fault("score", truth, truth, "--json", target)
    assert str(target) in line and "cannot be written (No such file or directory)" in line


def test_numbers_that_there_are_too_few_frames_for_are_a_dash(small_take, capsys):
    truth = str(small_take.with_name("truth.npz"))
    assert main(["score", truth, truth, "--frames", "0:1"]) == 0
    out = capsys.readouterr().out
    assert "nan" not in out
    removed = next(line for line in out.splitlines() if "offsets removed (" in line)
    assert removed.split()[-4:] == ["-"] * 4


def test_a_fit_too_short_for_offsets_says_so(quick_start, small_take, tmp_path, capsys):
    assert main(["fit", str(small_take), "--out", str(tmp_path), "--frames", "0:1"]) == 0
    out = capsys.readouterr().out
    assert "too few frames to remove constant offsets" in out and "nan" not in out


def test_a_damaged_truth_is_told(small_take, tmp_path, fault):
    damaged = tmp_path / "truth.npz"
    damaged.write_bytes(small_take.with_name("truth.npz").read_bytes()[:-100])
    assert str(damaged) in fault("score", damaged, damaged)


def test_a_finished_fit_is_told_again_when_resumed(quick_start, small_take, tmp_path, capsys):
    words = ["fit", str(small_take), "--out", str(tmp_path), "--frames", ":1", "--progress", "none"]
    assert main(words) == 0
    first = capsys.readouterr().out
    assert main([*words, "--resume"]) == 0
    again = capsys.readouterr().out
    assert again and again == "".join(
        line for line in first.splitlines(True) if not line.startswith("wrote")
    )


@pytest.mark.parametrize("option", ["--sheet", "--log-file"])
@pytest.mark.parametrize("name", ["take.toml", "calibration.toml", "masks/cam_01/000000.png"])
def test_files_of_other_kinds_are_not_written_over(option, name, small_take, tmp_path, fault):
    folder = shutil.copytree(small_take.parent, tmp_path / "session" / "small")
    before = (folder / name).read_bytes()
    line = fault("info", folder / "take.toml", option, folder / name)
    assert f"{folder / name}: is there already" in line and "give another path" in line
    assert (folder / name).read_bytes() == before


@pytest.mark.parametrize("option", ["--sheet", "--log-file"])
@pytest.mark.parametrize("before", [None, b""])
def test_earlier_results_are_written_over(option, before, small_take, tmp_path):
    path = tmp_path / "page.html"
    if before is not None:
        path.write_bytes(before)
    words = ["info", str(small_take), option, str(path)]
    assert main(words) == 0
    first = path.stat().st_size
    # times that are told may be shorter by some digits
    assert main(words) == 0 and path.stat().st_size > 0.99 * first
