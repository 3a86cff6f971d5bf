"""Faults stay readable."""

from silhouette_mocap.core.errors import MocapError


def test_what_damage_has_made_endless_is_shown_without_its_middle():
    fault = MocapError("9" * 5000 + "!", "mend it", camera="n" * 5000, file="a.toml")
    assert len(str(fault)) < 1400
    assert str(fault).startswith("a.toml, camera nnn") and str(fault).endswith("9!; mend it")


def test_ordinary_lines_are_whole():
    assert MocapError("p" * 600).problem == "p" * 600
