"""Charts of values over frames: scalable pictures without any library or script.

The plot itself is an SVG stretched to the width at hand, its lines keeping their thickness; marks
and legend are HTML over and below it, so that they stay readable at any width. A legend shows each
series' mean, and under the mouse, where scripts run, its value at the frame.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .axis import Axis, frame_axis, value_axis
from .decimation import decimated, runs
from .markup import Html, element, joined
from .wording import decimal

WIDTH = HEIGHT = 1000
"""Of the plot in its own units; x and y are stretched independently."""
COLOURS = 8
_NARROWEST_BAND = 1.5


@dataclass(frozen=True, eq=False)
class Series:
    """One line of a chart.

    Attributes:
        name: in the legend.
        values: (T,), NaN where there is none.
        style: a number that tells the line from others, the same for one thing in all charts;
            every `COLOURS` numbers the colours come again with another dash. None for the bold
            line of the foreground.
    """

    name: str
    values: np.ndarray
    style: int | None = None

    @property
    def classes(self) -> str:
        """The style's names in the style sheet."""
        if self.style is None:
            return "bold"
        return f"c{self.style % COLOURS} d{self.style // COLOURS % 3}"


@dataclass(frozen=True)
class Scale:
    """How values are shown.

    Attributes:
        low: fixed start of the value axis; None for one that suits the values.
        high: fixed end.
        digits: decimals in the legend.
    """

    low: float | None = None
    high: float | None = None
    digits: int = 2


@dataclass(frozen=True, eq=False)
class Chart:
    """Series over the same frames.

    Attributes:
        title: what is shown.
        unit: of the values, in words.
        frames: (T,) frame numbers, rising, at least one.
        series: in the order of the legend; the last is drawn on top.
        marked: (T,) bool, frames with a band behind.
        scale: of the values.
        flagged: frames with a flag that leads to the element called ``frame-NUMBER``.
    """

    title: str
    unit: str
    frames: np.ndarray
    series: Sequence[Series]
    marked: np.ndarray
    scale: Scale = Scale()
    flagged: Sequence[int] = ()


def chart_figure(chart: Chart) -> Html:
    """The chart with axes and legend."""
    x, y = frame_axis(chart.frames), _values_axis(chart)
    lines = [
        element("g", *_lines(chart.frames, series.values, x, y), class_=f"line {series.classes}")
        for series in chart.series
    ]
    plot = element(
        "svg", _grid(y), *bands(chart.frames, chart.marked, x), *lines,
        viewBox=f"0 0 {WIDTH} {HEIGHT}", preserveAspectRatio="none", role="img",
        aria_label=f"{chart.title} ({chart.unit}) over frames",
    )  # fmt: skip
    around = (*_value_marks(y), *frame_marks(x), *_flags(chart, x))
    return element(
        "figure", caption(chart.title, chart.unit),
        element("div", plot, *around, class_=_plot_class(chart)), _legend(chart),
        class_="chart", data_digits=chart.scale.digits, data_first=x.low, data_last=x.high,
        data_low=y.low, data_high=y.high,
    )  # fmt: skip


def _plot_class(chart: Chart) -> str:
    return "plot dense" if len(chart.frames) > WIDTH else "plot"


def caption(title: str, unit: str) -> Html:
    """What a figure shows, and in which unit."""
    return element("figcaption", element("b", title), " ", element("i", unit))


def _values_axis(chart: Chart) -> Axis:
    values = [series.values for series in chart.series]
    return value_axis(
        np.concatenate(values) if values else np.zeros(0), chart.scale.low, chart.scale.high
    )


def _lines(frames: np.ndarray, values: np.ndarray, x: Axis, y: Axis) -> list[Html]:
    """One polyline for each stretch without a gap."""
    across = x.shares(frames) * WIDTH
    down = (1.0 - y.shares(values)) * HEIGHT
    found = []
    for run in runs(frames, values):
        columns, rows = across[run], down[run]
        kept = decimated(columns.astype(int), rows)
        points = [f"{u:.1f},{v:.1f}" for u, v in zip(columns[kept], rows[kept], strict=True)]
        # a line of one point would not be drawn; one back to itself is a dot
        alone = len(points) == 1
        shape = " ".join(points * 2 if alone else points)
        found.append(element("polyline", points=shape, class_="dot" if alone else None))
    return found


def bands(frames: np.ndarray, marked: np.ndarray, x: Axis) -> list[Html]:
    """Rectangles behind the stretches of ``marked`` (T,) frames, half a frame to either side."""
    found = []
    for run in runs(frames, np.where(marked, 0.0, np.nan)):
        ends = np.array([frames[run.start] - 0.5, frames[run.stop - 1] + 0.5])
        left, right = np.clip(x.shares(ends), 0, 1) * WIDTH
        wide = max(right - left, _NARROWEST_BAND)
        found.append(
            element("rect", x=f"{left:.1f}", y=0, width=f"{wide:.1f}", height=HEIGHT, class_="band")
        )
    return found


def _grid(y: Axis) -> Html:
    rows = (1.0 - y.shares(np.array(y.marks))) * HEIGHT
    return joined(
        element("line", x1=0, x2=WIDTH, y1=f"{row:.1f}", y2=f"{row:.1f}", class_="grid")
        for row in rows
    )


def _value_marks(y: Axis) -> list[Html]:
    return [
        element("span", y.label(mark), class_="y", style=f"top:{100 - 100 * share:.2f}%")
        for mark, share in zip(y.marks, y.shares(np.array(y.marks)), strict=True)
    ]


def frame_marks(x: Axis) -> list[Html]:
    """Frame numbers below a plot."""
    frames = np.array([mark for mark in x.marks if mark == round(mark)])
    marks = [
        element("span", str(round(frame)), class_="x", style=f"left:{100 * share:.2f}%")
        for frame, share in zip(frames, x.shares(frames), strict=True)
    ]
    return [*marks, element("span", "frame", class_="x unit")]


def _flags(chart: Chart, x: Axis) -> list[Html]:
    shares = x.shares(np.array(chart.flagged, float))
    return [
        element(
            "a", "▾", class_="flag", href=f"#frame-{frame}", title=f"frame {frame}",
            style=f"left:{100 * share:.2f}%",
        )
        for frame, share in zip(chart.flagged, shares, strict=True)
    ]  # fmt: skip


def _legend(chart: Chart) -> Html:
    return element(
        "ul", *(_entry(series, chart.scale.digits) for series in chart.series), class_="key"
    )


def _entry(series: Series, digits: int) -> Html:
    finite = series.values[np.isfinite(series.values)]
    mean = decimal(float(finite.mean()) if len(finite) else None, digits)
    return element(
        "li", swatch(series.classes), element("span", series.name),
        element("output", mean, title="mean over all frames"),
    )  # fmt: skip


def swatch(classes: str) -> Html:
    """A piece of a line of the style."""
    line = element("line", x1=1, y1=5, x2=27, y2=5)
    return element(
        "svg", element("g", line, class_=f"line {classes}"), class_="swatch", viewBox="0 0 28 10",
        aria_hidden="true",
    )  # fmt: skip
