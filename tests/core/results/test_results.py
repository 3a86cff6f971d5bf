"""What a fit leaves in its folder, whatever happens meanwhile."""

import json
import shutil
import tomllib
from contextlib import contextmanager

import numpy as np
import pytest
from silhouette_mocap.core import beginning
from silhouette_mocap.core.fitting import passes
from silhouette_mocap.core.footage.pictures import write_picture
from silhouette_mocap.core.motion.motion import read_motion
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.results import writing
from silhouette_mocap.core.take import read_take


class Notes(Silence):
    """Progress that remembers what was told."""

    def __init__(self):
        self.told = []

    def note(self, text):
        self.told.append(text)


@pytest.fixture
def take_file(quick_start, small_take, tmp_path):
    """A small take of one's own, whose fits start at once."""
    return shutil.copytree(small_take.parent, tmp_path / "session" / "small") / "take.toml"


def kept_frames(path) -> list[int]:
    return read_motion(path).frames.tolist()


def unfinished(take_file, out, count, monkeypatch, failure=KeyboardInterrupt, **request) -> Notes:
    """The notes of a fit that fails after ``count`` frames."""
    track, notes = passes.track, Notes()

    def failing(*search):
        for number, found in enumerate(track(*search)):
            if number == count:
                raise failure
            yield found

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr(passes, "track", failing)
        fit(read_take(take_file), FitRequest(out, **request), notes)
    return notes


def write_wrong_keys(path):
    np.savez(path, places=np.zeros(3))


def write_foreign_points(path):
    np.savez(path, points=np.zeros((4, 1, 3)), point_names=["antenna"], frames=np.arange(4))


@pytest.mark.parametrize(
    "write",
    [
        lambda path: path.write_bytes(b"PK\x03\x04 junk"),
        lambda path: path.write_bytes(b""),
        write_wrong_keys,
        write_foreign_points,
    ],
)
def test_a_truth_that_is_of_no_use_is_a_note(take_file, tmp_path, write):
    write(take_file.with_name("truth.npz"))
    notes = Notes()
    result = fit(read_take(take_file), FitRequest(tmp_path, frames=(0, 0)), notes)
    assert result.report["error_mm"] is None and kept_frames(tmp_path / "motion.npz") == [0]
    assert "no error to the truth: " in notes.told[-1] and notes.told[-1] in result.report["notes"]


def test_a_report_that_cannot_be_made_costs_no_frame(take_file, tmp_path, monkeypatch):
    def failing(motion, fits):
        raise ZeroDivisionError

    monkeypatch.setattr(writing, "fit_quality", failing)
    with pytest.raises(ZeroDivisionError):
        fit(read_take(take_file), FitRequest(tmp_path, frames=(0, 1)), Silence())
    assert kept_frames(tmp_path / "motion.npz") == [0, 1] and (tmp_path / "body.npz").exists()


def test_a_camera_that_looks_away_has_no_scale(take_file, tmp_path, monkeypatch):
    monkeypatch.setattr(beginning, "check_first_look", lambda *_: ())
    path = take_file.with_name("calibration.toml")
    cameras = tomllib.loads(path.read_text("utf-8"))
    # the performer's distance with the other sign
    away = cameras["cam_05"]["translation"].copy()
    away[2] = -away[2]
    text = path.read_text("utf-8").replace(str(cameras["cam_05"]["translation"]), str(away))
    path.write_text(text, "utf-8")
    fit(read_take(take_file), FitRequest(tmp_path, frames=(0, 0)), Silence())
    facts = json.loads((tmp_path / "report.json").read_text("utf-8"))["cameras"]
    assert facts["cam_05"]["mm_per_px"] is None and facts["cam_01"]["mm_per_px"] > 20


def test_an_interrupt_just_before_the_last_save_costs_no_frame(take_file, tmp_path):
    entered = []

    @contextmanager
    def shield():
        entered.append(1)
        if len(entered) == 1:
            raise KeyboardInterrupt
        yield

    with pytest.raises(KeyboardInterrupt):
        fit(read_take(take_file), FitRequest(tmp_path, frames=(0, 1), shield=shield), Silence())
    assert kept_frames(tmp_path / "motion.npz") == [0, 1]


def test_an_interrupt_that_waited_for_the_save_does_not_silence_its_note(
    take_file, tmp_path, monkeypatch
):
    @contextmanager
    def shield():
        yield
        raise KeyboardInterrupt

    notes = unfinished(take_file, tmp_path, 2, monkeypatch, OSError("planted"), shield=shield)
    path = tmp_path / "motion.npz"
    assert notes.told == [f"the 2 finished frames are kept in {path}; --resume goes on"]


def test_an_unfinished_fit_spares_a_longer_one(take_file, tmp_path, monkeypatch):
    fit(read_take(take_file), FitRequest(tmp_path, frames=(0, 2)), Silence())
    before = {path.name: path.read_bytes() for path in tmp_path.glob("*.*")}
    notes = unfinished(take_file, tmp_path, 2, monkeypatch)
    partial = tmp_path / "motion.partial.npz"
    assert notes.told == [
        f"the 2 finished frames are kept in {partial}, "
        "beside the motion.npz of an earlier fit; --resume goes on"
    ]
    assert kept_frames(partial) == [0, 1]
    assert {name: (tmp_path / name).read_bytes() for name in before} == before
    assert (tmp_path / "body.partial.npz").exists() and (tmp_path / "report.partial.json").exists()


def test_an_unfinished_fit_replaces_one_of_no_more_frames(take_file, tmp_path, monkeypatch):
    unfinished(take_file, tmp_path, 1, monkeypatch)
    unfinished(take_file, tmp_path, 2, monkeypatch)
    assert kept_frames(tmp_path / "motion.npz") == [0, 1]
    assert not (tmp_path / "motion.partial.npz").exists()


def test_an_unfinished_fit_spares_what_it_cannot_read(take_file, tmp_path, monkeypatch):
    (tmp_path / "motion.npz").write_bytes(b"of a later version")
    unfinished(take_file, tmp_path, 1, monkeypatch)
    assert (tmp_path / "motion.npz").read_bytes() == b"of a later version"
    assert kept_frames(tmp_path / "motion.partial.npz") == [0]


def test_what_an_earlier_fit_left_is_named(take_file, tmp_path, monkeypatch):
    for name in ("small.fbx", "small.trc", "other.fbx", "overlay.mp4"):
        (tmp_path / name).write_text("old", "utf-8")
    notes = Notes()
    fit(read_take(take_file), FitRequest(tmp_path, frames=(0, 0)), notes)
    assert notes.told == ["from an earlier fit, unless written again now: small.fbx, small.trc"]
    notes = unfinished(take_file, tmp_path, 2, monkeypatch)
    assert notes.told[-1].endswith("now: overlay.mp4, small.fbx, small.trc")


def test_what_is_wrong_with_a_camera_is_told_once_and_reported(take_file, tmp_path):
    for frame in (2, 3):
        path = take_file.parent / "masks" / "cam_02" / f"{frame:06d}.png"
        write_picture(path, np.zeros((120, 160), np.uint8))
    notes = Notes()
    result = fit(read_take(take_file), FitRequest(tmp_path), notes)
    (finding,) = result.report["camera_findings"]
    assert (finding["camera"], finding["kind"], finding["frames"]) == ("cam_02", "dead", [2, 3])
    assert "cam_02 is dead in frames 2 to 3" in finding["text"]
    assert notes.told.count(finding["text"]) == 1 and finding["text"] in result.report["notes"]
    page = (tmp_path / "report.html").read_text("utf-8")
    assert finding["text"] in page.split('id="cameras"')[1].split("<table")[0]
