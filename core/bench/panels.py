"""Small charts side by side: lines with a dot for every figure, each chart with its own axes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..pages.axis import Axis, value_axis
from ..pages.markup import Html, element
from .drawing import BOTTOM, COLOURS, TOP, WIDTH, axis_unit, legend, line, picture, text

_LEFT, _GAP, _ABOVE, _BELOW, _TALL = 48, 46, 44, 22, 130
_ACROSS = 4
Points = Sequence[tuple[float, float]]


@dataclass(frozen=True)
class Panel:
    """One chart.

    Attributes:
        title: above it.
        lines: by series, places (x, y) in the order in which they are joined.
        marks: of the horizontal axis, their words by their places; empty for round numbers.
        high: end of the vertical axis, which begins at 0; None for one above all values.
    """

    title: str
    lines: Mapping[str, Points]
    marks: Mapping[float, str] = field(default_factory=dict)
    high: float | None = None


def panels_picture(title: str, unit: str, panels: Sequence[Panel]) -> str:
    """All panels in rows; ``unit`` tells both axes. Series keep their colour in all of them."""
    series = list(dict.fromkeys(name for panel in panels for name in panel.lines))
    colours = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(series)}
    across = min(_ACROSS, max(len(panels), 2))
    wide = (WIDTH - _LEFT) / across - _GAP
    rows = -(-len(panels) // across)
    shapes: list[Html] = []
    for k, panel in enumerate(panels):
        left = _LEFT + (k % across) * (wide + _GAP)
        top = TOP + _ABOVE + (k // across) * (_TALL + _ABOVE + _BELOW)
        shapes += _Frame(panel, left, top, wide).shapes(colours)
    height = TOP + rows * (_TALL + _ABOVE + _BELOW) + BOTTOM
    return picture(title, height, [*legend(series, 12, 210), *shapes, axis_unit(unit, height)])


class _Frame:
    """A panel's place in the picture."""

    def __init__(self, panel: Panel, left: float, top: float, wide: float):
        self._panel, self._left, self._top, self._wide = panel, left, top, wide
        places = np.array([place for line in panel.lines.values() for place in line] or [(0, 0)])
        self._y = value_axis(places[:, 1], low=0.0, high=panel.high)
        ends = np.array(sorted(panel.marks)) if panel.marks else places[:, 0]
        self._x = Axis(float(ends.min()), float(max(ends.max(), ends.min() + 1e-9)))

    def shapes(self, colours: Mapping[str, str]) -> list[Html]:
        found = [text(self._panel.title, self._left, self._top - 10, "start"), *self._grid()]
        for name, points in self._panel.lines.items():
            places = [self._place(x, min(y, self._y.high)) for x, y in points]
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
            stroke = {"stroke": colours[name], "stroke_width": 1.5}
            found.append(element("polyline", points=path, fill="none", **stroke))
            for x, y in places:
                dot = {"cx": f"{x:.1f}", "cy": f"{y:.1f}", "r": 3}
                found.append(element("circle", **dot, fill=colours[name]))
        return found

    def _grid(self) -> list[Html]:
        found = []
        for mark in self._y.marks:
            _, row = self._place(self._x.low, mark)
            found.append(line(self._left, row, self._left + self._wide, row))
            found.append(text(self._y.label(mark), self._left - 6, row + 4, "end", "soft"))
        marks = self._panel.marks or {mark: self._x.label(mark) for mark in self._x.marks}
        for mark, words in marks.items():
            column, row = self._place(mark, 0.0)
            found.append(text(words, column, row + 15, "middle", "soft"))
        return found

    def _place(self, x: float, y: float) -> tuple[float, float]:
        across, up = (float(axis.shares(np.array(v))) for axis, v in ((self._x, x), (self._y, y)))
        return self._left + self._wide * across, self._top + _TALL * (1 - up)
