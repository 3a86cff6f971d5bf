"""A fit's result cleaned in its folder."""

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.file import read_body, write_body
from silhouette_mocap.core.body.scaling import scaled
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.cleaning.settings import CleanSettings
from silhouette_mocap.core.motion.motion import read_motion, write_motion
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import SILENCE
from silhouette_mocap.core.results.cleaning import clean_result, read_result, undo_result
from silhouette_mocap.core.results.exporting import export
from silhouette_mocap.core.take import read_take
from small_take import Notes

SETTINGS = CleanSettings(keys_mm=5.0)


@pytest.fixture(scope="module")
def fitted(tmp_path_factory, small_take):
    """A fitted take, for copying."""
    folder = tmp_path_factory.mktemp("fitted") / "small"
    with pytest.MonkeyPatch.context() as patch:
        from small_take import known_start

        patch.setattr("silhouette_mocap.core.beginning.initialised", known_start)
        fit(read_take(small_take), FitRequest(folder), SILENCE)
    return folder


@pytest.fixture
def out(fitted, tmp_path):
    return shutil.copytree(fitted, tmp_path / "out")


def contents(folder) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def test_undoing_gives_back_every_file_to_the_bit(out, fitted):
    clean_result(read_result(out), SETTINGS, None, SILENCE)
    assert contents(out) != contents(fitted) and (out / "clean.html").exists()
    undo_result(read_result(out), SILENCE)
    assert contents(out) == contents(fitted)
    undo_result(read_result(out), SILENCE)
    assert contents(out) == contents(fitted)


def test_cleaning_twice_writes_the_same_files(out):
    clean_result(read_result(out), SETTINGS, None, SILENCE)
    once = contents(out)
    clean_result(read_result(out), SETTINGS, None, SILENCE)
    assert contents(out) == once


def test_the_report_tells_of_it_and_undoing_takes_that_out(out):
    found, files = clean_result(read_result(out), SETTINGS, None, SILENCE)
    report = json.loads((out / "report.json").read_text("utf-8"))
    assert report["clean"]["settings"]["smooth_hz"] == 6.0
    assert report["clean"]["feet"]["floor"] == 0.0
    assert [path.name for path in files] == ["motion.npz", "report.json", "clean.html"]
    page = (out / "clean.html").read_text("utf-8")
    assert "Raw against clean" in page and page.count("<figure") == 4
    assert np.array_equal(found.motion.pose, read_motion(out / "motion.npz").pose)


def test_a_cleaned_fit_is_still_a_finished_one(out, small_take, quick_start):
    clean_result(read_result(out), SETTINGS, None, SILENCE)
    before, notes = contents(out), Notes()
    result = fit(read_take(small_take), FitRequest(out, resume=True), notes)
    assert not notes.frames and "were finished before" in notes.told[0]
    assert contents(out) == before and "clean" in result.report


def test_a_motion_that_the_report_does_not_belong_to_is_not_made_to(out):
    motion = read_motion(out / "motion.npz")
    write_motion(out / "motion.npz", replace(motion, iou=motion.iou / 2))
    before = json.loads((out / "report.json").read_text("utf-8"))["digests"]
    clean_result(read_result(out), SETTINGS, None, SILENCE)
    assert json.loads((out / "report.json").read_text("utf-8"))["digests"] == before


def test_exports_take_the_clean_motion_and_older_ones_are_named(out, small_take):
    (out / "small.fbx").write_bytes(b"")
    notes = Notes()
    clean_result(read_result(out), SETTINGS, None, notes)
    assert notes.told == ["small.fbx show the motion before; export again for new ones"]
    requests = []
    take = read_take(small_take)
    export(take, out, ("fbx",), lambda request: requests.append(request) or ())
    clean = read_motion(out / "motion.npz")
    assert np.array_equal(requests[0].motion.pose, clean.pose)
    assert not np.array_equal(clean.pose, clean.pose_raw)


def test_the_floor_is_the_takes_unless_told_otherwise(out):
    result = read_result(out)
    low, _ = clean_result(result, SETTINGS, -0.5, SILENCE)
    assert low.feet.floor == -0.5 and not low.feet.contacts
    result.report["inputs"]["floor"] = "0.25"
    assert result.floor == 0.25


def test_files_from_before_cleaning_was_known_can_be_cleaned(out):
    with np.load(out / "motion.npz") as stored:
        older = {n: stored[n] for n in stored.files if n not in ("confidence_raw", "keyed")}
    np.savez_compressed(out / "motion.npz", **older)
    found, _ = clean_result(read_result(out), SETTINGS, None, SILENCE)
    assert np.array_equal(found.raw.confidence, older["confidence"])


def test_a_motion_beside_another_body_is_refused(out):
    body = read_body(out / "body.npz")
    write_body(out / "body.npz", scaled(body, 1.1))
    with pytest.raises(MocapError, match="of different fits; run fit again"):
        read_result(out)


@pytest.mark.parametrize("failing", ["report.json", "motion.npz", "clean.html"])
def test_a_file_that_cannot_be_written_leaves_all_as_they_were(out, fitted, monkeypatch, failing):
    from silhouette_mocap.core.results import cleaning

    def refuse(path, *rest):
        raise OSError(28, "No space left on device")

    writers = {"report.json": "write_report", "motion.npz": "write_motion"}
    monkeypatch.setattr(cleaning, writers.get(failing, "write_clean_page"), refuse)
    with pytest.raises(MocapError, match="cannot be written"):
        clean_result(read_result(out), SETTINGS, None, SILENCE)
    assert contents(out) == contents(fitted)
