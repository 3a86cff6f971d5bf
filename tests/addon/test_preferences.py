"""Preferences of the add-on, and what they change."""

import bpy
import pytest

EXTENSION = "bl_ext.user_default.silhouette_mocap"


@pytest.fixture
def preferences():
    """The add-on's preferences, given back as they were."""
    chosen = bpy.context.preferences.addons[EXTENSION].preferences
    before = chosen.evaluator
    yield chosen
    chosen.evaluator = before


def asked_of_core(monkeypatch, words):
    """The words that the command hands on."""
    from bl_ext.user_default.silhouette_mocap.addon import cli
    from bl_ext.user_default.silhouette_mocap.core import cli as core_cli

    handed = []
    monkeypatch.setattr(core_cli, "main", lambda words, *means: handed.append(words) or 0)
    assert cli._run(words) == 0
    return handed[0]


def test_the_evaluator_is_automatic_at_first(preferences, monkeypatch):
    assert preferences.evaluator == "AUTOMATIC"
    words = ["fit", "take.toml", "--out", "out"]
    assert asked_of_core(monkeypatch, words) == words


def test_the_preferred_evaluator_is_the_default_of_fit_alone(preferences, monkeypatch):
    preferences.evaluator = "OPENGL"
    fit, info = ["fit", "take.toml"], ["info", "take.toml"]
    assert asked_of_core(monkeypatch, fit) == [*fit, "--evaluator", "opengl"]
    assert asked_of_core(monkeypatch, info) == info


@pytest.mark.parametrize("named", [["--evaluator", "native"], ["--evaluator=native"]])
def test_words_win_over_preferences(preferences, monkeypatch, named):
    preferences.evaluator = "OPENGL"
    assert asked_of_core(monkeypatch, ["fit", "take.toml", *named])[2:] == named


def test_every_preferred_evaluator_is_known_to_the_command(preferences):
    from bl_ext.user_default.silhouette_mocap.core.rendering.choice import EVALUATORS

    choices = preferences.bl_rna.properties["evaluator"].enum_items
    assert {item.identifier.lower() for item in choices} - {"automatic"} <= set(EVALUATORS)
