"""The figures as SVG pictures that stand alone, on light and on dark pages."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..pages.axis import Axis, value_axis
from ..pages.markup import Html, element
from .cameras import CameraCosts
from .drawing import BOTTOM, COLOURS, TOP, WIDTH, axis_unit, legend, line, picture, text
from .energy import EnergyFigures
from .table1 import PAPER_RATES, PARTS, PRERENDERED
from .table2 import PAPER_SECONDS

PLOTS = {
    "speed": "Evaluations per second at 320x240, parts that stand still pre-rendered",
    "cameras": "Microseconds for one candidate against the number of cameras, best turns",
    "fitting": "Seconds per frame with the paper's settings",
}
"""Name of the file and what it shows."""
_LEFT, _RIGHT = 290, 70
_BAR, _GAP = 13, 16


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
    across = WIDTH - _LEFT - _RIGHT
    step = len(series) * _BAR + _GAP
    height = TOP + 20 + step * len(bars.groups) + BOTTOM
    marks = [_power_line(power, axis, across, height) for power in range(low, int(axis.high) + 1)]
    shapes: list[Html] = []
    for row, (name, group) in enumerate(bars.groups.items()):
        top = TOP + 20 + row * step
        middle = top + len(series) * _BAR / 2 + 4
        shapes.append(text(name, _LEFT - 8, middle, "end"))
        for k, key in enumerate(series):
            value = group.get(key)
            if value:
                share = float(axis.shares(np.array(math.log10(value))))
                shapes += _bar(top + k * _BAR, across * share, k, f"{value:,.{bars.digits}f}")
    return picture(
        bars.title, height, [*marks, *legend(series, _LEFT), *shapes, axis_unit(bars.unit, height)]
    )


def cameras_picture(costs: Mapping[str, CameraCosts], titles: Mapping[str, str]) -> str:
    """Measured costs as dots and the fitted lines, each row with an axis of its own."""
    panel, height = 250, TOP + 20 + 190 + BOTTOM
    shapes: list[Html] = []
    for k, (name, cost) in enumerate(costs.items()):
        left = 60 + k * (panel + 30)
        shapes += _panel(cost, titles[name], left, panel - 20, COLOURS[k % len(COLOURS)])
    return picture(PLOTS["cameras"], height, [*shapes, axis_unit("cameras", height)])


def _panel(cost: CameraCosts, title: str, left: float, wide: float, colour: str) -> list[Html]:
    top, tall = TOP + 24, 180.0
    micro = 1e6 * cost.seconds
    y, x = value_axis(micro, low=0.0), Axis(0.0, float(cost.counts.max()))

    def place(counts, seconds) -> list[tuple[float, float]]:
        rows = top + tall * (1 - y.shares(np.asarray(seconds, float)))
        columns = left + wide * x.shares(np.asarray(counts, float))
        return list(zip(columns.tolist(), rows.tolist(), strict=True))

    shapes = [text(title, left, top - 8, "start")]
    for mark in y.marks:
        (_, row), *_ = place([0], [mark])
        shapes.append(line(left, row, left + wide, row))
        shapes.append(text(f"{mark:,.0f}", left - 6, row + 4, "end", "soft"))
    for count in cost.counts.tolist():
        (column, row), *_ = place([count], [0])
        shapes.append(text(str(count), column, row + 16, "middle", "soft"))
    ends = cost.counts[[0, -1]]
    points = place(ends, 1e6 * (cost.fixed + cost.per_camera * ends))
    path = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
    shapes.append(element("polyline", points=path, fill="none", stroke=colour, stroke_width=1.5))
    for column, row in place(cost.counts, micro):
        shapes.append(element("circle", cx=f"{column:.1f}", cy=f"{row:.1f}", r=3.5, fill=colour))
    words = f"largest distance {cost.largest_residual:.1%}"
    return [*shapes, text(words, left + wide, top + tall - 8, "end", "soft")]


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
    fill = COLOURS[colour % len(COLOURS)]
    shape = element(
        "rect", x=_LEFT, y=f"{top:.1f}", width=f"{max(wide, 1):.1f}", height=_BAR - 2, fill=fill
    )
    return [shape, text(value, _LEFT + wide + 5, top + _BAR - 3, "start", "soft")]


def _power_line(power: int, axis: Axis, across: float, height: float) -> Html:
    x = _LEFT + across * float(axis.shares(np.array(float(power))))
    label = f"{10.0**power:,.{max(0, -power)}f}"
    grid = line(x, TOP + 14, x, height - BOTTOM)
    return element("g", grid, text(label, x, height - BOTTOM + 16, "middle", "soft"))
