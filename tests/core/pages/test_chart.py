"""Charts say what the numbers say."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from silhouette_mocap.core.pages.chart import COLOURS, HEIGHT, WIDTH, Chart, Scale, Series
from silhouette_mocap.core.pages.chart import chart_figure as figure_of


def drawn(chart):
    return ElementTree.fromstring(figure_of(chart))


def values_of(figure, line):
    """(frame, value) of all points of one of the figure's lines, gaps between them dropped."""
    first, last, low, high = (float(figure.get(f"data-{key}")) for key in KEYS)
    found = []
    for shape in line.iter("polyline"):
        for point in shape.get("points").split():
            x, y = map(float, point.split(","))
            frame = first + x / WIDTH * (last - first)
            found.append((frame, high - y / HEIGHT * (high - low)))
    return np.array(found)


KEYS = ("first", "last", "low", "high")
FRAMES = np.arange(100, 160)


def chart_of(values, frames=FRAMES, marked=None, **options):
    marked = np.zeros(len(frames), bool) if marked is None else marked
    series = [Series(f"s{k}", column, k) for k, column in enumerate(np.atleast_2d(values))]
    return Chart("title", "unit", frames, series, marked, **options)


def lines_of(figure):
    return figure.findall("div/svg/g")


def test_points_map_back_to_the_values():
    values = np.random.default_rng(1).uniform(0.6, 0.9, (3, 60))
    figure = drawn(chart_of(values, scale=Scale(high=1.0)))
    for line, series in zip(lines_of(figure), values, strict=True):
        found = values_of(figure, line)
        np.testing.assert_allclose(found[:, 0], FRAMES, atol=0.01)
        # a tenth of a unit of the plot
        np.testing.assert_allclose(found[:, 1], series, atol=0.5 * 0.4 / 10 / HEIGHT)


def test_a_gap_parts_the_line():
    values = np.linspace(0, 1, 60)
    values[[10, 11, 40]] = np.nan
    (line,) = lines_of(drawn(chart_of(values)))
    assert [len(shape.get("points").split()) for shape in line] == [10, 28, 19]


def test_a_lone_value_is_a_dot():
    values = np.full(60, np.nan)
    values[30] = 0.4
    (line,) = lines_of(drawn(chart_of(values)))
    (dot,) = line
    one, other = dot.get("points").split()
    assert one == other and dot.get("class") == "dot"


def test_ten_thousand_frames_stay_small_and_keep_their_extremes():
    frames = np.arange(10_000)
    values = np.random.default_rng(2).uniform(0.8, 0.9, (8, 10_000))
    values[3, 7777], values[5, 1234] = 0.1, 0.97
    chart = chart_of(values, frames)
    assert len(figure_of(chart)) < 8 * 2 * WIDTH * 15
    figure = drawn(chart)
    lines = [values_of(figure, line) for line in lines_of(figure)]
    lowest, highest = lines[3][lines[3][:, 1].argmin()], lines[5][lines[5][:, 1].argmax()]
    np.testing.assert_allclose(lowest, [7777, 0.1], atol=1.1)
    assert lowest[1] == pytest.approx(0.1, abs=1e-3)
    assert highest[1] == pytest.approx(0.97, abs=1e-3)
    assert highest[0] == pytest.approx(1234, abs=1.1)


def test_bands_lie_behind_marked_frames():
    marked = np.zeros(60, bool)
    marked[[0, 20, 21, 22, 59]] = True
    figure = drawn(chart_of(np.ones(60), marked=marked))
    px = WIDTH / 59
    spans = [
        (float(band.get("x")), float(band.get("x")) + float(band.get("width")))
        for band in figure.iter("rect")
    ]
    wanted = [(0, 0.5 * px), (19.5 * px, 22.5 * px), (58.5 * px, WIDTH)]
    np.testing.assert_allclose(spans, wanted, atol=0.11)


def test_the_legend_gives_names_and_means():
    values = np.array([[0.5, np.nan, 1.0], [np.nan] * 3])
    figure = drawn(chart_of(values, np.arange(3)))
    entries = [
        (entry.findtext("span"), entry.findtext("output")) for entry in figure.find("ul") or ()
    ]
    assert entries == [("s0", "0.75"), ("s1", "–")]


def test_names_are_escaped():
    chart = Chart(
        "<b>", '"u"', np.arange(2), [Series("</svg><script>", np.ones(2), 0)], np.zeros(2, bool)
    )
    text = figure_of(chart)
    assert "<script>" not in text and "&lt;/svg&gt;&lt;script&gt;" in text
    assert ElementTree.fromstring(text).findtext("figcaption/b") == "<b>"


def test_many_series_differ_in_colour_or_dash():
    looks = {Series("", np.zeros(0), style).classes for style in range(3 * COLOURS)}
    assert len(looks) == 3 * COLOURS


def test_frame_marks_are_whole_numbers():
    text = figure_of(chart_of(np.arange(2.0), np.array([7, 8])))
    marks = re.findall(r'class="x" style="left:([\d.]+)%">(\d+)<', text)
    assert marks == [("0.00", "7"), ("100.00", "8")]
