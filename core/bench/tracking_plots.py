"""The figures of tracking as SVG pictures."""

from collections.abc import Mapping, Sequence

import numpy as np

from .panels import Panel, Points, panels_picture
from .tracking_confidence import Reliability
from .tracking_runs import DEFAULT
from .tracking_trials import CAMERAS, LADDER, RATES, TAKES

PLOTS = {
    "tracking_noise": "Error in mm against the level of noise, 0 for none",
    "tracking_sweeps": "Error in mm against number of cameras and frame rate",
    "tracking_confidence": "Share of points off by less than 50 mm against their confidence",
}
"""Name of the file and what it shows."""
_CEILING_MM = 200.0
"""Larger errors are drawn there: the tracker is lost, however far."""


def tracking_pictures(
    rows: Mapping[str, Sequence[dict]], confidence: Mapping[str, Reliability]
) -> dict[str, str]:
    """SVG by the names of `PLOTS`, as far as there are figures for them."""
    noise = [_noise_panel(kind, rows) for kind in _names(rows[LADDER])]
    sweeps = [
        Panel(title, _lines(rows[section]), high=_ceiling(rows[section]))
        for section, title in ((CAMERAS, "cameras"), (RATES, "frames per second"))
        if rows[section]
    ]
    panels = {
        "tracking_noise": (noise, "level of noise; errors of 200 mm and more on the top line"),
        "tracking_sweeps": (sweeps, "errors of 200 mm and more on the top line"),
        "tracking_confidence": (
            [_confidence_panel(name, found) for name, found in confidence.items()], "confidence",
        ),
    }  # fmt: skip
    return {
        name: panels_picture(PLOTS[name], unit, found)
        for name, (found, unit) in panels.items()
        if found
    }


def _noise_panel(kind: str, rows: Mapping[str, Sequence[dict]]) -> Panel:
    """One kind of noise, take by take; level 0 is the take without."""
    clean = [row for row in rows[TAKES] if row["name"] == DEFAULT.name]
    noisy = [row for row in rows[LADDER] if row["name"] == kind]
    found = [*clean, *noisy]
    levels = sorted({row["level"] for row in found})
    return Panel(kind, _lines(found), {level: f"{level:.0f}" for level in levels}, _ceiling(found))


def _lines(rows: Sequence[dict]) -> dict[str, Points]:
    """Errors by take, in the order of the levels; what failed is on the ceiling."""
    return {
        take: sorted(
            (row["level"], min(row.get("absolute_mm", np.inf), _CEILING_MM))
            for row in rows
            if row["take"] == take
        )
        for take in sorted({row["take"] for row in rows})
    }


def _ceiling(rows: Sequence[dict]) -> float | None:
    """The end of the axis where an error reaches it."""
    reached = any(row.get("absolute_mm", np.inf) >= _CEILING_MM for row in rows)
    return _CEILING_MM if reached else None


def _names(rows: Sequence[dict]) -> list[str]:
    return sorted({row["name"] for row in rows})


def _confidence_panel(name: str, found: Reliability) -> Panel:
    known = np.flatnonzero(found.counts)
    measured = list(zip(found.confidence[known].tolist(), found.good[known].tolist(), strict=True))
    ideal = [(0.0, 0.0), (1.0, 1.0)]
    marks = {0.0: "0", 0.5: "0.5", 1.0: "1"}
    return Panel(name, {"as it should be": ideal, "measured": measured}, marks, 1.0)
