"""The figures of tracking as SVG pictures."""

from collections.abc import Mapping, Sequence

import numpy as np

from .panels import Panel, Points, panels_picture
from .tracking_confidence import Reliability
from .tracking_trials import CAMERAS, LADDER, RATES, TAKES, TORMENTS
from .tracking_variants import DEFAULT

PLOTS = {
    "tracking_torments": "Error in mm, frame by frame, about disturbances of some frames",
    "tracking_noise": "Error in mm against the level of noise, 0 for none",
    "tracking_sweeps": "Error in mm against number of cameras and frame rate",
    "tracking_confidence": "Share of points off by less than 50 mm against their confidence",
}
"""Name of the file and what it shows."""
_CEILING_MM = 200.0
"""Larger errors are drawn there: the tracker is lost, however far."""
_ON_TOP = "errors of 200 mm and more on the top line"
Rows = Mapping[str, Sequence[dict]]


def tracking_pictures(rows: Rows, confidence: Mapping[str, Reliability]) -> dict[str, str]:
    """SVG by the names of `PLOTS`, as far as there are figures for them."""
    panels = {
        "tracking_torments": (
            [_torment_panel(name, rows[TORMENTS]) for name in _names(rows[TORMENTS])],
            f"frames from the last disturbed one; each take's worst place; {_ON_TOP}",
        ),
        "tracking_noise": (
            [_noise_panel(kind, rows) for kind in _names(rows[LADDER])],
            f"level of noise; {_ON_TOP}",
        ),
        "tracking_sweeps": (
            [
                _panel(title, _lines(rows[section]))
                for section, title in ((CAMERAS, "cameras"), (RATES, "frames per second"))
                if rows[section]
            ],
            _ON_TOP,
        ),
        "tracking_confidence": (
            [_confidence_panel(name, found) for name, found in confidence.items()],
            "confidence",
        ),
    }
    return {
        name: panels_picture(PLOTS[name], unit, found)
        for name, (found, unit) in panels.items()
        if found
    }


def _panel(title: str, lines: Mapping[str, Points]) -> Panel:
    """Errors up to the ceiling, with a mark for every place."""
    lines = {
        name: sorted((x, min(y, _CEILING_MM)) for x, y in points) for name, points in lines.items()
    }
    places = sorted({x for points in lines.values() for x, _ in points})
    reached = any(y == _CEILING_MM for points in lines.values() for _, y in points)
    marks = {x: f"{x:.3g}" for x in places} if len(places) < 9 else {}
    return Panel(title, lines, marks, _CEILING_MM if reached else None)


def _noise_panel(kind: str, rows: Rows) -> Panel:
    """One kind of noise, take by take; level 0 is the take without."""
    clean = [row for row in rows[TAKES] if row["name"] == DEFAULT.name]
    return _panel(kind, _lines([*clean, *(row for row in rows[LADDER] if row["name"] == kind)]))


def _torment_panel(name: str, rows: Sequence[dict]) -> Panel:
    """One torment, take by take, at each take's worst place, which comes first."""
    lines: dict[str, Points] = {}
    for row in rows:
        if row["name"] == name and "course" in row:
            lines.setdefault(row["take"], row["course"])
    return _panel(name, lines)


def _lines(rows: Sequence[dict]) -> Mapping[str, Points]:
    """Errors by take; what failed is above the ceiling."""
    lines: dict[str, list[tuple[float, float]]] = {}
    for row in sorted(rows, key=lambda row: row["take"]):
        lines.setdefault(row["take"], []).append((row["level"], row.get("absolute_mm", np.inf)))
    return lines


def _names(rows: Sequence[dict]) -> list[str]:
    return sorted({row["name"] for row in rows})


def _confidence_panel(name: str, found: Reliability) -> Panel:
    known = np.flatnonzero(found.counts)
    measured = list(zip(found.confidence[known].tolist(), found.good[known].tolist(), strict=True))
    ideal = [(0.0, 0.0), (1.0, 1.0)]
    marks = {0.0: "0", 0.5: "0.5", 1.0: "1"}
    return Panel(name, {"as it should be": ideal, "measured": measured}, marks, 1.0)
