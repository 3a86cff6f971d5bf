"""A fit that asks for OpenGL, on machines with it and without."""

import json

import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.pipeline import FitRequest, fit
from silhouette_mocap.core.progress import Silence
from silhouette_mocap.core.rendering.opengl import context, gpu
from silhouette_mocap.core.take import read_take


class Notebook(Silence):
    """Progress that remembers."""

    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


def settings(out):
    """What the report says the fit was asked for."""
    return json.loads((out / "report.json").read_text("utf-8"))["settings"]


def test_a_fit_by_opengl_says_so_and_is_not_resumed_by_another(quick_start, small_take, tmp_path):
    take, notebook = read_take(small_take), Notebook()
    frames = (0, 0)
    result = fit(take, FitRequest(tmp_path, evaluator="opengl", frames=frames), notebook)
    assert settings(tmp_path)["evaluator"] == "opengl" and result.report["iou"] > 0.9
    assert sum("OpenGL draws on" in note for note in notebook.notes) == 1
    before = (tmp_path / "motion.npz").read_bytes()
    fit(take, FitRequest(tmp_path, evaluator="opengl", frames=frames, resume=True), Notebook())
    assert (tmp_path / "motion.npz").read_bytes() == before
    with pytest.raises(MocapError, match=r"evaluator was opengl, now native"):
        fit(take, FitRequest(tmp_path, frames=frames, resume=True), Notebook())


def test_a_fit_without_opengl_goes_on_with_the_native_evaluator(
    quick_start, small_take, tmp_path, monkeypatch
):
    def refuse():
        raise context.no_opengl("no driver")

    monkeypatch.setattr(gpu, "shared_thread", refuse)
    notebook = Notebook()
    fit(read_take(small_take), FitRequest(tmp_path, evaluator="opengl", frames=(0, 0)), notebook)
    told = "OpenGL cannot be used (no driver); the native evaluator goes on"
    assert [note for note in notebook.notes if "OpenGL" in note] == [told]
    assert settings(tmp_path)["evaluator"] == "native"
