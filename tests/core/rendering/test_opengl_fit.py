"""A fit that asks for OpenGL, on machines with it and without."""

import json
from dataclasses import replace

import pytest
from silhouette_mocap.core.cli import main
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.rendering.opengl import context, gpu
from silhouette_mocap.core.results.journal import Journal
from silhouette_mocap.core.take import read_take
from small_take import Notes


def report(out):
    """What was written of the fit."""
    return json.loads((out / "report.json").read_text("utf-8"))


def told_once(out):
    """The one note on OpenGL in both forms of the report."""
    (note,) = (note for note in report(out)["notes"] if "OpenGL" in note)
    assert note in (out / "report.html").read_text("utf-8")
    return note


@pytest.fixture
def no_driver(monkeypatch):
    """No OpenGL; the fault's words."""

    def refuse():
        raise context.no_opengl("no driver")

    monkeypatch.setattr(gpu, "shared_thread", refuse)
    return "OpenGL cannot be used (no driver); the native evaluator goes on"


@pytest.fixture
def failing_opengl(monkeypatch):
    """OpenGL that is out of memory from the frame on that is drawn after the given one."""
    add, energies = Journal.add, gpu.OpenGLEvaluator.energies
    state = {"frames": 0, "calls": 0}

    def counted(self, *arguments):
        state["frames"] += 1
        return add(self, *arguments)

    def fails_soon(self, *arguments):
        state["calls"] += state["frames"] > 0
        if state["calls"] > 5:
            raise context.no_opengl("out of memory")
        return energies(self, *arguments)

    monkeypatch.setattr(Journal, "add", counted)
    monkeypatch.setattr(gpu.OpenGLEvaluator, "energies", fails_soon)


def test_a_fit_by_opengl_says_so_and_is_not_resumed_by_another(quick_start, small_take, tmp_path):
    take, notebook = read_take(small_take), Notes()
    frames = (0, 0)
    result = fit(take, FitRequest(tmp_path, evaluator="opengl", frames=frames), notebook)
    assert result.report["settings"]["evaluator"] == "opengl" and result.report["iou"] > 0.9
    assert result.report["evaluators"] == {"opengl": 1}
    assert sum("OpenGL draws on" in note for note in notebook.told) == 1
    before = (tmp_path / "motion.npz").read_bytes()
    fit(take, FitRequest(tmp_path, evaluator="opengl", frames=frames, resume=True), Notes())
    assert (tmp_path / "motion.npz").read_bytes() == before
    with pytest.raises(MocapError, match=r"evaluator was opengl, now native"):
        fit(take, FitRequest(tmp_path, frames=frames, resume=True), Notes())


def test_a_fit_without_opengl_goes_on_with_the_native_evaluator_and_can_be_resumed(
    quick_start, small_take, tmp_path, no_driver
):
    notebook = Notes()
    request = FitRequest(tmp_path, evaluator="opengl", frames=(0, 0))
    fit(read_take(small_take), request, notebook)
    assert [note for note in notebook.told if "OpenGL" in note] == [no_driver]
    assert report(tmp_path)["settings"]["evaluator"] == "opengl"
    assert report(tmp_path)["evaluators"] == {"native": 1}
    assert told_once(tmp_path) == no_driver
    fit(read_take(small_take), replace(request, resume=True), notebook)
    assert notebook.told[-1].startswith("all frames in")


@pytest.mark.parametrize("progress", ["none", "bar", "json"])
def test_every_kind_of_progress_tells_that_opengl_is_not_used(
    quick_start, small_take, tmp_path, no_driver, progress, capsys
):
    words = ["--evaluator", "opengl", "--frames", "0:0", "--progress", progress]
    assert main(["fit", str(small_take), "--out", str(tmp_path), *words]) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if no_driver in line]
    assert len(lines) == 1
    if progress == "json":
        assert json.loads(lines[0])["event"] == "note"
    else:
        assert lines == [f"silhouette-mocap: {no_driver}"]


def test_opengl_that_fails_on_the_way_leaves_the_frame_to_the_native_evaluator(
    quick_start, small_take, tmp_path, failing_opengl, capsys
):
    words = ["--evaluator", "opengl", "--frames", "0:2", "--progress", "none"]
    assert main(["fit", str(small_take), "--out", str(tmp_path), *words]) == 0
    told = "OpenGL cannot be used (out of memory); the native evaluator goes on"
    assert capsys.readouterr().err == f"silhouette-mocap: {told}\n"
    assert told_once(tmp_path) == told
    found = report(tmp_path)
    assert found["evaluators"] == {"opengl": 1, "native": 2}
    assert found["lost_frames"] == [] and found["iou"] > 0.9
