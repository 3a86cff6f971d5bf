"""Progress on a terminal and elsewhere."""

import io
import math

from silhouette_mocap.core.cli.console import ProgressBar, complain
from silhouette_mocap.core.progress import FrameFigures


class Terminal(io.StringIO):
    def isatty(self):
        return True


def told(stream) -> str:
    bar = ProgressBar(stream)
    bar.begin("fit", 2)
    bar.note("look out")
    bar.advance(10, FrameFigures(1.25, 9, {"a": 0.8533, "b": 0.8999, "c": math.nan}, {}, False))
    bar.advance(11, FrameFigures(1.5, 9, {"a": 0.9}, {}, False))
    return stream.getvalue()


def test_elsewhere_every_frame_is_a_plain_line():
    assert told(io.StringIO()) == (
        "note: look out\n"
        "fit 1/2  frame 10  1.25 s  IoU 0.877\n"
        "fit 2/2  frame 11  1.50 s  IoU 0.900\n"
    )


def test_on_a_terminal_one_line_grows_and_notes_stand_above_it():
    shown = told(Terminal())
    assert shown.count("\n") == 2 and shown.endswith("IoU 0.900\n")
    assert "note: look out\n" in shown and "############............" in shown
    assert "s/frame" in shown and "\r" in shown


def test_an_empty_bar_stands_before_the_first_frame_and_faults_take_its_place(monkeypatch):
    stream = Terminal()
    ProgressBar(stream).begin("first pose", 1)
    assert stream.getvalue().endswith("first pose [........................] 0/1")
    monkeypatch.setattr("sys.stderr", stream)
    complain("the take\nis gone")
    assert stream.getvalue().endswith("\r\x1b[Ksilhouette-mocap: the take is gone\n")
