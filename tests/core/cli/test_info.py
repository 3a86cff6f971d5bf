"""``info``: what it prints, and its sheet."""

import shutil

import pytest
from silhouette_mocap.core.cli import main


@pytest.fixture
def folder(small_take, tmp_path):
    return shutil.copytree(small_take.parent, tmp_path / "session" / "small")


def test_cameras_units_time_memory_and_disk_are_told(small_take, capsys):
    assert main(["info", str(small_take)]) == 0
    lines = capsys.readouterr().out.splitlines()
    told = {line.split()[0]: line for line in lines}
    # a ring of 4 m radius, the second camera 2 m high and 1 m above what it looks at
    name, lens, *numbers = told["cam_02"].replace(" x ", "x").split()
    assert (name, lens, *numbers[:2]) == ("cam_02", "pinhole", "160x120", "160x120")
    view, height, distance, scale = map(float, numbers[2:])
    assert (view, height) == (61, 2.0) and abs(distance - 4.12) < 0.1
    assert scale == pytest.approx(1000 * distance / 137, rel=0.02)
    assert told["units"].endswith("metres, as the take says")
    assert told["time"].split()[1] == "about" and "per frame" in told["time"]
    assert "MB" in told["memory"] and "during the fit" in told["disk"]
    assert sum(line.startswith("footage     cam_") for line in lines) == 5


def test_the_sheet_is_written_even_if_something_is_at_fault(folder, tmp_path, capsys):
    sheet = tmp_path / "sheet.html"
    (folder / "masks" / "cam_02" / "000001.png").write_bytes(b"")
    assert main(["info", str(folder / "take.toml"), "--sheet", str(sheet), "--progress=none"]) == 2
    shown = capsys.readouterr()
    assert shown.err.count("\n") == 1 and f"wrote {sheet}" in shown.out
    assert "cam_02, frame 1" in sheet.read_text("utf-8")


def test_a_sheet_that_cannot_be_written_is_two(small_take, tmp_path, capsys):
    words = ["info", str(small_take), "--sheet", str(tmp_path / "missing" / "sheet.html")]
    assert main(words) == 2
    assert "sheet.html: cannot be written" in capsys.readouterr().err
