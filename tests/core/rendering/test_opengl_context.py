"""Contexts without a window, and the evaluator that is taken where there is none."""

import os
import subprocess
import sys

import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.rendering import choice
from silhouette_mocap.core.rendering.fallback import FallbackEvaluator
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.rendering.opengl import context
from silhouette_mocap.core.rendering.opengl.context import GlThread, load_functions, make_context
from silhouette_mocap.core.rendering.opengl.gpu import OpenGLEvaluator
from silhouette_mocap.core.rendering.reference import ReferenceEvaluator


@pytest.fixture
def no_context(monkeypatch):
    """A machine on which no context can be made; its reason."""
    reason = "EGL gives no context without a window"

    def refuse(*_):
        raise context.no_opengl(reason)

    monkeypatch.setattr(context.GlThread.__init__, "__defaults__", (refuse,))
    context.shared_thread.cache_clear()
    yield reason
    context.shared_thread.cache_clear()


def test_a_context_may_be_made_again_and_beside_another(scenes):
    rng = np.random.default_rng(0)
    body = scenes.body_of([scenes.sphere(3, 6, 0.15, rng)], rng)
    cameras = [scenes.camera_at(1.0, 40, (64, 48), rng)]
    pictures = []
    beside = GlThread()
    for _ in range(2):
        thread = GlThread()
        pictures.append(OpenGLEvaluator(body, cameras, thread=thread).silhouettes(body.rest_pose))
        thread.release()
    pictures.append(OpenGLEvaluator(body, cameras, thread=beside).silhouettes(body.rest_pose))
    beside.release()
    assert pictures[0][0].any()
    for picture in pictures[1:]:
        np.testing.assert_array_equal(picture[0], pictures[0][0])


def test_the_context_is_current_in_its_own_thread_alone():
    first, second = GlThread(), GlThread()
    main = make_context()  # as Blender has one in the main thread
    main.make_current()
    try:
        name = load_functions().glGetString(load_functions().GL_RENDERER).decode()
        assert first.renderer == second.renderer == name
        assert first.version >= (3, 3)
        texture = first.call(first.gl.glGenTextures, 1)
        first.call(first.gl.glBindTexture, first.gl.GL_TEXTURE_2D, texture)
        assert first.call(first.gl.glIsTexture, texture)
        assert not second.call(second.gl.glIsTexture, texture)
        assert not load_functions().glIsTexture(texture)
    finally:
        main.release()
        first.release()
        second.release()


def test_what_opengl_refuses_is_one_clear_fault():
    thread = context.shared_thread()
    with pytest.raises(MocapError, match=r"OpenGL cannot be used \(.*error 0x500 of glEnable\)"):
        thread.call(thread.gl.glEnable, 0xFFFF)
    assert thread.call(thread.gl.glGetError) == 0


def test_nothing_imports_pyopengl_until_it_is_asked_for_and_the_environment_stays():
    code = """
import os, sys
from silhouette_mocap.core import pipeline
from silhouette_mocap.core.rendering.choice import Choice
assert Choice(None, print).name == "native"
assert not any(name.split(".")[0] == "OpenGL" for name in sys.modules)
from silhouette_mocap.core.rendering.opengl.context import load_functions
before = dict(os.environ)
load_functions()
assert dict(os.environ) == before and "OpenGL" in sys.modules
"""
    environment = {k: v for k, v in os.environ.items() if k != "PYOPENGL_PLATFORM"}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)


def test_evaluators_are_made_by_name(scenes):
    rng = np.random.default_rng(1)
    body = scenes.body_of([scenes.sphere(3, 6, 0.15, rng)], rng)
    cameras = (scenes.camera_at(1.0, 40, (64, 48), rng),)
    kinds = {"native": NativeEvaluator, "opengl": OpenGLEvaluator, "reference": ReferenceEvaluator}
    assert choice.EVALUATORS.keys() == kinds.keys()
    for name, kind in kinds.items():
        notes, told = [], []
        chosen = choice.Choice(name, told.append)
        chosen.check(cameras, notes.append)
        evaluator = chosen(body, cameras)
        assert type(choice.EVALUATORS[name](body, cameras)) is kind
        assert type(evaluator) is (FallbackEvaluator if name == "opengl" else kind)
        assert chosen.name == name and not told and len(notes) == (name == "opengl")


def test_without_a_context_the_native_evaluator_goes_on_and_one_line_says_why(no_context, scenes):
    rng = np.random.default_rng(2)
    body = scenes.body_of([scenes.sphere(3, 6, 0.15, rng)], rng)
    cameras = (scenes.camera_at(1.0, 40, (64, 48), rng),)
    for checked in (True, False):
        told = []
        chosen = choice.Choice("opengl", told.append)
        if checked:
            chosen.check(cameras, told.append)
        assert [type(chosen(body, cameras)) for _ in range(2)] == [NativeEvaluator] * 2
        assert told == [f"OpenGL cannot be used ({no_context}); the native evaluator goes on"]
        assert chosen.name == "native" and list(chosen.notes) == told


def test_pictures_that_opengl_cannot_draw_are_left_to_the_native_evaluator(scenes):
    cameras = (scenes.camera_at(1.0, 40, (9000, 48), np.random.default_rng(3)),)
    told = []
    chosen = choice.Choice("opengl", told.append)
    chosen.check(cameras, told.append)
    assert chosen.name == "native"
    assert "at most 8192 px, one has 9000" in told[0]
