"""The figures as SVG pictures that stand alone, on light and on dark pages."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..pages.axis import Axis, value_axis
from ..pages.markup import Html, element
from .cameras import CameraCosts
from .energy import EnergyFigures
from .table1 import PAPER_RATES, PARTS, PRERENDERED
from .table2 import PAPER_SECONDS

PLOTS = {
    "speed": "Evaluations per second at 320x240, parts that stand still pre-rendered",
    "cameras": "Microseconds for one candidate against the number of cameras, best turns",
    "fitting": "Seconds per frame with the paper's settings",
}
"""Name of the file and what it shows."""
_WIDTH, _LEFT, _RIGHT, _TOP, _BOTTOM = 860, 290, 70, 44, 42
_BAR, _GAP = 13, 16
_COLOURS = ("#0072b2", "#d55e00", "#009e73")
_STYLE = (
    "text{font:12px system-ui,sans-serif;fill:#16191f}.title{font-weight:600;font-size:14px}"
    ".soft{fill:#5b6472}.grid{stroke:#dde1e7}.paper{fill:#fff}"
)


@dataclass(frozen=True)
class Bars:
    """Groups of bars along a logarithmic axis.

    Attributes:
        title: above all.
        unit: of the values.
        groups: row to series to value; None where there is none.
        digits: decimals of the values shown beside the bars.
    """

    title: str
    unit: str
    groups: Mapping[str, Mapping[str, float | None]]
    digits: int = 0


def pictures(figures: EnergyFigures) -> dict[str, str]:
    """SVG by the names of `PLOTS`."""
    return {
        "speed": bars_picture(_speed(figures)),
        "cameras": cameras_picture(figures.cameras, figures.titles),
        "fitting": bars_picture(_fitting(figures)),
    }


def bars_picture(bars: Bars) -> str:
    """The bars as a picture."""
    series = list(dict.fromkeys(name for group in bars.groups.values() for name in group))
    values = [v for group in bars.groups.values() for v in group.values() if v]
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    axis = Axis(float(low), float(max(high, low + 1)))
    across = _WIDTH - _LEFT - _RIGHT
    step = len(series) * _BAR + _GAP
    height = _TOP + 20 + step * len(bars.groups) + _BOTTOM
    marks = [_power_line(power, axis, across, height) for power in range(low, int(axis.high) + 1)]
    shapes: list[Html] = []
    for row, (name, group) in enumerate(bars.groups.items()):
        top = _TOP + 20 + row * step
        middle = top + len(series) * _BAR / 2 + 4
        shapes.append(_text(name, _LEFT - 8, middle, "end"))
        for k, key in enumerate(series):
            value = group.get(key)
            if value:
                share = float(axis.shares(np.array(math.log10(value))))
                shapes += _bar(top + k * _BAR, across * share, k, f"{value:,.{bars.digits}f}")
    return _picture(
        bars.title, height, [*marks, *_legend(series), *shapes, _unit(bars.unit, height)]
    )


def cameras_picture(costs: Mapping[str, CameraCosts], titles: Mapping[str, str]) -> str:
    """Measured costs as dots and the fitted lines, each row with an axis of its own."""
    panel, height = 250, _TOP + 20 + 190 + _BOTTOM
    shapes: list[Html] = []
    for k, (name, cost) in enumerate(costs.items()):
        left = 60 + k * (panel + 30)
        shapes += _panel(cost, titles[name], left, panel - 20, _COLOURS[k % len(_COLOURS)])
    return _picture(PLOTS["cameras"], height, [*shapes, _unit("cameras", height)])


def _panel(cost: CameraCosts, title: str, left: float, wide: float, colour: str) -> list[Html]:
    top, tall = _TOP + 24, 180.0
    micro = 1e6 * cost.seconds
    y, x = value_axis(micro, low=0.0), Axis(0.0, float(cost.counts.max()))

    def place(counts, seconds) -> list[tuple[float, float]]:
        rows = top + tall * (1 - y.shares(np.asarray(seconds, float)))
        columns = left + wide * x.shares(np.asarray(counts, float))
        return list(zip(columns.tolist(), rows.tolist(), strict=True))

    shapes = [_text(title, left, top - 8, "start")]
    for mark in y.marks:
        (_, row), *_ = place([0], [mark])
        shapes.append(_line(left, row, left + wide, row))
        shapes.append(_text(f"{mark:,.0f}", left - 6, row + 4, "end", "soft"))
    for count in cost.counts.tolist():
        (column, row), *_ = place([count], [0])
        shapes.append(_text(str(count), column, row + 16, "middle", "soft"))
    ends = cost.counts[[0, -1]]
    points = place(ends, 1e6 * (cost.fixed + cost.per_camera * ends))
    path = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
    shapes.append(element("polyline", points=path, fill="none", stroke=colour, stroke_width=1.5))
    for column, row in place(cost.counts, micro):
        shapes.append(element("circle", cx=f"{column:.1f}", cy=f"{row:.1f}", r=3.5, fill=colour))
    words = f"largest distance {cost.largest_residual:.1%}"
    return [*shapes, _text(words, left + wide, top + tall - 8, "end", "soft")]


def _speed(figures: EnergyFigures) -> Bars:
    table = next(iter(figures.table1.values()))
    medians = {part: table[cell, PRERENDERED].medians for part, cell in PARTS.items()}
    groups: dict[str, Mapping[str, float | None]] = {
        "Theobalt et al. 2003 (GeForce3)": {
            part: PAPER_RATES[cell][1] for part, cell in PARTS.items()
        }
    }
    for name in medians["whole"]:
        groups[figures.titles[name]] = {part: medians[part].get(name) for part in PARTS}
    return Bars(PLOTS["speed"], "evaluations/s, all eight cameras", groups)


def _fitting(figures: EnergyFigures) -> Bars:
    titles = {"xor": "XOR", "prerendered": "pre-rendered", "shared_out": "limbs shared out"}
    groups: dict[str, dict[str, float | None]] = {}
    for way, title in titles.items():
        groups[f"{title}, 2003"] = {f"sequence {n}": s for n, s in PAPER_SECONDS[way].items()}
        groups[f"{title}, here"] = {
            f"sequence {n}": float(ways[way].seconds.mean()) for n, ways in figures.table2.items()
        }
    return Bars(PLOTS["fitting"], "s/frame", groups, digits=2)


def _bar(top: float, wide: float, colour: int, value: str) -> list[Html]:
    fill = _COLOURS[colour % len(_COLOURS)]
    shape = element(
        "rect", x=_LEFT, y=f"{top:.1f}", width=f"{max(wide, 1):.1f}", height=_BAR - 2, fill=fill
    )
    return [shape, _text(value, _LEFT + wide + 5, top + _BAR - 3, "start", "soft")]


def _power_line(power: int, axis: Axis, across: float, height: float) -> Html:
    x = _LEFT + across * float(axis.shares(np.array(float(power))))
    label = f"{10.0**power:,.{max(0, -power)}f}"
    line = _line(x, _TOP + 14, x, height - _BOTTOM)
    return element("g", line, _text(label, x, height - _BOTTOM + 16, "middle", "soft"))


def _legend(series: Sequence[str]) -> list[Html]:
    shapes = []
    for k, name in enumerate(series):
        x = _LEFT + 130 * k
        fill = _COLOURS[k % len(_COLOURS)]
        shapes.append(element("rect", x=x, y=_TOP - 9, width=12, height=12, fill=fill))
        shapes.append(_text(name, x + 18, _TOP + 1, "start"))
    return shapes


def _unit(unit: str, height: float) -> Html:
    return _text(unit, _WIDTH - 12, height - 8, "end", "soft")


def _line(x1: float, y1: float, x2: float, y2: float) -> Html:
    ends = {"x1": x1, "y1": y1, "x2": x2, "y2": y2}
    return element("line", **{k: f"{v:.1f}" for k, v in ends.items()}, class_="grid")


def _text(words: str, x: float, y: float, anchor: str, class_: str | None = None) -> Html:
    return element("text", words, x=f"{x:.1f}", y=f"{y:.1f}", text_anchor=anchor, class_=class_)


def _picture(title: str, height: float, shapes: Sequence[Html]) -> str:
    paper = element("rect", width="100%", height="100%", class_="paper")
    head = element("text", title, x=12, y=22, class_="title")
    whole = element(
        "svg", element("style", Html(_STYLE)), paper, head, *shapes,
        xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {_WIDTH} {height:.0f}",
        role="img", aria_label=title,
    )  # fmt: skip
    return whole + "\n"
