"""Progress on a terminal, in a log and for programs."""

import io
import json
import math

import pytest
from silhouette_mocap.core.cli.bar import BarConsole, LineConsole, duration
from silhouette_mocap.core.cli.console import PlainConsole, say
from silhouette_mocap.core.cli.events import JsonConsole
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.progress import FrameFigures


@pytest.fixture
def clock(monkeypatch):
    """Seconds that pass only when told to."""

    class Clock:
        now = 100.0

        def monotonic(self):
            return self.now

    clock = Clock()
    for name in ("console", "bar", "events"):
        monkeypatch.setattr(f"silhouette_mocap.core.cli.{name}.time", clock)
    return clock


def told(console, clock) -> str:
    console.begin("fit", 2)
    console.note("look out")
    clock.now += 1.5
    console.advance(10, FrameFigures(1.25, 9, {"a": 0.8533, "b": 0.8999, "c": math.nan}, {}, False))
    clock.now += 1.5
    console.advance(11, FrameFigures(1.5, 9, {"a": 0.9}, {}, False))
    return console.stream.getvalue()


def test_in_a_log_every_frame_of_a_short_task_is_a_line(clock):
    assert told(LineConsole(io.StringIO()), clock) == (
        "note: look out\n"
        "fit 1/2  frame 10  1.25 s  IoU 0.877  0:02 left\n"
        "fit 2/2  frame 11  1.50 s  IoU 0.900\n"
    )


def test_in_a_log_a_long_task_has_a_line_per_percent(clock):
    console = LineConsole(io.StringIO())
    console.begin("fit", 10_000)
    for frame in range(10_000):
        clock.now += 0.5
        console.advance(frame)
    lines = console.stream.getvalue().splitlines()
    assert len(lines) == 100
    assert lines[0].startswith("fit 100/10000") and lines[-1].startswith("fit 10000/10000")


def test_in_a_log_slow_frames_of_a_long_task_still_show_life_every_minute(clock):
    console = LineConsole(io.StringIO())
    console.begin("fit", 10_000)
    for frame in range(10):
        clock.now += 20.0
        console.advance(frame)
    lines = console.stream.getvalue().splitlines()
    assert [line.split()[1] for line in lines] == ["3/10000", "6/10000", "9/10000"]


def test_on_a_terminal_one_line_grows_and_notes_stand_above_it(clock):
    shown = told(BarConsole(io.StringIO()), clock)
    assert shown.count("\n") == 2 and shown.endswith("IoU 0.900\n")
    assert "note: look out\n" in shown and "############............" in shown
    assert "1.50 s/frame" in shown and "0:02 left" in shown and "\r" in shown


def test_a_bar_is_never_longer_than_the_terminal_is_wide(clock, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    shown = told(BarConsole(io.StringIO()), clock).replace("\x1b[K", "")
    assert max(len(piece) for piece in shown.replace("\n", "\r").split("\r")) == 39


def test_a_bar_is_not_drawn_more_often_than_it_can_be_looked_at(clock):
    console = BarConsole(io.StringIO())
    console.begin("masks", 1000)
    for frame in range(1000):
        clock.now += 0.001
        console.advance(frame)
    assert 8 <= console.stream.getvalue().count("\r") <= 13
    assert console.stream.getvalue().endswith("s/frame\n")


def test_an_empty_bar_stands_before_the_first_frame_and_faults_take_its_place(clock):
    console = BarConsole(io.StringIO())
    console.begin("first pose", 1)
    assert console.stream.getvalue().endswith("first pose [........................] 0/1")
    console.fault(MocapError("the take\nis gone"), 2)
    assert console.stream.getvalue().endswith("\r\x1b[Ksilhouette-mocap: the take is gone\n")


def test_no_progress_means_faults_and_lost_frames_alone(clock):
    console = PlainConsole(io.StringIO())
    assert told(console, clock) == ""
    console.lost([3, 4])
    console.fault(MocapError("broken", "mend it"), 2)
    assert console.stream.getvalue() == (
        "silhouette-mocap: frames lost: 3, 4\nsilhouette-mocap: broken; mend it\n"
    )


def test_programs_get_objects_with_null_for_what_is_not_known(clock):
    events = [json.loads(line) for line in told(JsonConsole(io.StringIO()), clock).splitlines()]
    assert [event["event"] for event in events] == ["begin", "note", "frame", "frame"]
    assert events[2] == {
        "version": 1, "event": "frame", "task": "fit", "frame": 10, "done": 1, "total": 2,
        "elapsed_seconds": 1.5, "remaining_seconds": 1.5,
        "fit": {
            "seconds": 1.25, "evaluations": 9, "iou": {"a": 0.8533, "b": 0.8999, "c": None},
            "mean_iou": 0.8766, "xor_px": {}, "lost": False,
        },
    }  # fmt: skip


def test_work_goes_on_where_nobody_listens_any_more(clock):
    class Closed(io.StringIO):
        def write(self, text):
            raise BrokenPipeError

    for kind in (BarConsole, LineConsole, JsonConsole):
        told(kind(Closed()), clock)


def test_names_that_the_output_has_no_letters_for_are_escaped(monkeypatch):
    raw = io.BytesIO()
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(raw, encoding="ascii"))
    say("wrote böse/\udcff.npz")
    assert raw.getvalue() == b"wrote b\\xf6se/\\udcff.npz\n"


def test_durations_read_as_on_a_clock():
    assert [duration(s) for s in (0.4, 61, 3600 + 62)] == ["0:00", "1:01", "1:01:02"]
