"""The benchmark of shape with a take so small that it is done in seconds."""

import json

import pytest
from silhouette_mocap.core.bench import shape
from silhouette_mocap.core.cli import main
from small_take import known_start


def test_the_command_compares_three_bodies_limb_by_limb(small_take, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(shape, "initialised", known_start)
    file = tmp_path / "shape.json"
    words = ["bench", "shape", str(small_take), "--json", str(file), "--out", str(tmp_path)]
    assert main(words) == 0
    assert shape.SCALED in capsys.readouterr().err
    rows = json.loads(file.read_text("utf-8"))["rows"]
    assert [row["body"] for row in rows] == [shape.SCALED, shape.INITIAL, shape.BENT]
    # the take shows the template itself
    assert rows[0]["off"] == pytest.approx(dict.fromkeys(shape.LENGTHS, 0.0), abs=1e-6)
    for row in rows:
        assert max(map(abs, row["off"].values())) < 0.05
        # of a px of 29 mm
        assert row["initial_mm"] < 29 and row["score"]["absolute"]["mean"] < 29
    table = (tmp_path / "shape.md").read_text("utf-8")
    worst = max(abs(off) for row in rows for off in row["off"].values())
    limbs = table.split("Limbs against")[1]
    assert f"{worst:.1%}" in limbs.splitlines()[4]
