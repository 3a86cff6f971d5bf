"""Progress for programs, held against its description in PROGRESS.md."""

import json
import re
import sys
from pathlib import Path

import pytest
from silhouette_mocap.core.cli import main
from silhouette_mocap.core.errors import MocapError

DESCRIPTION = Path(sys.modules[main.__module__].__file__).with_name("PROGRESS.md")


def is_whole(value) -> bool:
    return type(value) is int


def is_number(value) -> bool:
    return type(value) in (int, float)


TYPES = {
    "text": lambda value: type(value) is str,
    "number": is_number,
    "whole number": is_whole,
    "true or false": lambda value: type(value) is bool,
    "whole numbers": lambda value: type(value) is list and all(map(is_whole, value)),
    "text or null": lambda value: value is None or type(value) is str,
    "number or null": lambda value: value is None or is_number(value),
    "whole number or null": lambda value: value is None or is_whole(value),
    "whole number by camera": lambda value: all(map(is_whole, value.values())),
    "number or null by camera": lambda value: all(
        v is None or is_number(v) for v in value.values()
    ),
    "fit or null": lambda value: value is None or fits(value, "fit"),
}


def described() -> dict[str, dict[str, str]]:
    """Type of every field by event."""
    events = {}
    for line in DESCRIPTION.read_text("utf-8").splitlines():
        if heading := re.fullmatch(r"##+ (\w+)", line):
            fields = events.setdefault(heading[1], {})
        elif row := re.fullmatch(r"\| (\w+) \| ([^|]+) \| .* \|", line):
            fields[row[1]] = row[2]
    for fields in events.values():
        fields.pop("field", None)
    return events


def fits(value: dict, name: str) -> bool:
    """Whether ``value`` has exactly the fields described under ``name``, of these types."""
    fields = described()[name]
    return value.keys() == fields.keys() and all(
        TYPES[kind](value[field]) for field, kind in fields.items()
    )


@pytest.fixture
def events(capsys):
    """What a command tells; every line is as described."""

    def of(*words, code: int = 0) -> list[dict]:
        assert main([str(word) for word in words]) == code
        found = [json.loads(line) for line in capsys.readouterr().err.splitlines()]
        for event in found:
            rest = {key: event[key] for key in event if key not in ("version", "event")}
            assert event["version"] == 1 and fits(rest, event["event"]), event
        assert [found[0]["event"], found[-1]["event"]] == ["start", "end"]
        assert found[-1]["exit_code"] == code
        return found

    return of


def of_kind(events: list[dict], kind: str) -> list[dict]:
    return [event for event in events if event["event"] == kind]


def test_every_event_of_a_fit_is_as_described(quick_start, small_take, tmp_path, events):
    words = ("--progress", "json", "--frames", "0:1", "--verbose", "--export", "trc")
    found = events("fit", small_take, "--out", tmp_path, *words)
    frames = [event for event in of_kind(found, "frame") if event["task"] == "fit"]
    assert [event["frame"] for event in frames] == [0, 1]
    assert [event["remaining_seconds"] == 0 for event in frames] == [False, True]
    assert 0.9 < frames[1]["fit"]["mean_iou"] <= 1 and len(frames[1]["fit"]["iou"]) == 5
    files = {Path(event["file"]).name: event["bytes"] for event in of_kind(found, "file")}
    assert files.keys() >= {"motion.npz", "body.npz", "report.json", "overlay.mp4", "small.trc"}
    assert files["motion.npz"] == (tmp_path / "motion.npz").stat().st_size
    assert of_kind(found, "log")


def test_faults_name_their_place_in_fields_too(small_take, tmp_path, monkeypatch, events):
    fault = MocapError("is\nbroken", "mend it", file="a.png", camera="c", frame=3)

    def failing(arguments, exporter):
        arguments.console.note("look out")
        arguments.console.lost([1, 2])
        raise fault

    monkeypatch.setattr("silhouette_mocap.core.cli.info.run", failing)
    found = events("info", small_take, "--progress=json", code=2)
    assert of_kind(found, "note")[0]["text"] == "look out"
    assert of_kind(found, "lost")[0]["frames"] == [1, 2]
    told = of_kind(found, "fault")[0]
    assert (told["file"], told["camera"], told["frame"]) == ("a.png", "c", 3)
    assert told["line"] == "a.png, camera c, frame 3: is broken; mend it"


@pytest.mark.parametrize(
    "words", [["info", "--progress", "json"], ["--progress", "json", "fit"], ["--progress=json"]]
)
def test_wrong_words_are_events_too(words, events):
    assert "--help" in of_kind(events(*words, code=2), "fault")[0]["remedy"]


def test_interrupts_and_internal_errors_are_events_too(monkeypatch, tmp_path, events):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    for failure, code in ((KeyboardInterrupt(), 130), (ZeroDivisionError("planted"), 1)):

        def failing(arguments, exporter, failure=failure):
            raise failure

        monkeypatch.setattr("silhouette_mocap.core.cli.info.run", failing)
        found = of_kind(events("info", "take.toml", "--progress", "json", code=code), "fault")
        assert [event["exit_code"] for event in found] == [code]
