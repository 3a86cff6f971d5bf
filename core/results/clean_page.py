"""clean.html: what a cleaning did to a motion, for people, in one file that opens offline."""

from pathlib import Path

import numpy as np

from ..motion.cleaning.cleaned import Cleaned
from ..motion.cleaning.contacts import FEET
from ..motion.cleaning.feet import Feet
from ..motion.motion import Motion
from ..pages.chart import Chart, Scale, Series, chart_figure
from ..pages.document import Page, Section, paragraphs, tiles, write_page
from ..pages.markup import Html, joined
from ..pages.table import facts, table
from ..pages.wording import counted, decimal, spans, whole

_HIPS = tuple(f"{side}_hip" for side in FEET)


def write_clean_page(path: Path, found: Cleaned, report: dict) -> None:
    """Writes the page, whole or not at all; ``report`` is what report.json holds.

    Raises:
        MocapError: it cannot be written.
    """
    sections = (
        Section("plots", "Raw against clean", _plots(found)),
        Section("contacts", "Contacts with the floor", _contacts(found.feet)),
        Section("settings", "Settings", facts(_settings(found))),
    )
    title = str(report.get("take", path.parent.name))
    write_page(path, Page("cleaning", title, _summary(found), sections))


def _summary(found: Cleaned) -> Html:
    figures = found.as_dict()
    moved, acceleration = figures["moved_mm"], figures["acceleration"]
    shown = [
        (f"{decimal(moved['mean'], 1)} mm", "points moved, mean"),
        (f"{decimal(moved['max'], 0)} mm", "points moved, most"),
        (
            f"{decimal(acceleration['raw'], 1)} → {decimal(acceleration['clean'], 1)}",
            "acceleration of points, m/s²",
        ),
        (whole(len(figures["filled_frames"])), "lost frames filled"),
    ]
    if found.feet is not None:
        slide = figures["feet"]["slide_mm"]
        shown.append(
            (
                f"{decimal(slide['before']['mean'], 1)} → {decimal(slide['after']['mean'], 1)}",
                "mm that feet slide while they stand",
            )
        )
    if found.keys is not None:
        keys = figures["keys"]
        shown.append((f"{100 * keys['kept'] / keys['of']:.0f} %", "of all keys are left"))
        shown.append((f"{decimal(keys['error_mm']['max'], 1)} mm", "cost of the keys, at most"))
        shown.append((f"{decimal(keys['error_deg']['max'], 1)}°", "cost of the keys, at most"))
    return tiles(shown)


def _plots(found: Cleaned) -> Html:
    raw, clean, filled = found.raw, found.motion, found.filled
    moved = 1000 * np.linalg.norm(clean.points - raw.points, axis=2)
    hips = [
        Series(name, _height(motion), style)
        for name, motion, style in (("raw", raw, 1), ("clean", clean, None))
    ]
    change = [Series("most", moved.max(axis=1), 1), Series("mean", moved.mean(axis=1))]
    charts = [
        Chart(
            f"Height of the {'hips' if _has_hips(raw) else 'root'}",
            "m; shaded: filled",
            raw.frames,
            hips,
            filled,
            Scale(digits=3),
        ),
        Chart("Change", "mm; shaded: filled", raw.frames, change, filled, Scale(0.0, None, 1)),
    ]
    if found.feet is not None:
        charts += [_foot_chart(raw.frames, found.feet, foot) for foot in FEET]
    return joined(map(chart_figure, charts))


def _has_hips(motion: Motion) -> bool:
    return set(_HIPS) <= set(motion.point_names)


def _height(motion: Motion) -> np.ndarray:
    """(T,) of the middle of the hips; of the root where there are none."""
    if not _has_hips(motion):
        return motion.joints[:, 0, 2]
    return motion.points[:, [motion.point_names.index(name) for name in _HIPS], 2].mean(axis=1)


def _foot_chart(frames: np.ndarray, feet: Feet, foot: str) -> Chart:
    lines = [
        Series("smoothed", feet.heights(foot, held=False), 1),
        Series("held", feet.heights(foot, held=True)),
    ]
    title, unit = f"Height of the {foot} sole", "m, its lowest point; shaded: it touches the floor"
    return Chart(title, unit, frames, lines, feet.standing(foot), Scale(digits=3))


def _contacts(feet: Feet | None) -> Html:
    if feet is None:
        return Html()
    rows = [
        (foot, ", ".join(_stretches(feet, foot)) or "none", whole(int(feet.standing(foot).sum())))
        for foot in FEET
    ]
    figures = feet.as_dict()
    slide, height = figures["slide_mm"], figures["above_floor_mm"]
    before, after = (
        f"{decimal(slide[when]['mean'], 1)} mm on average and {decimal(slide[when]['max'], 1)} mm "
        "at most"
        for when in ("before", "after")
    )
    told = (
        f"While they touch the floor, points of the soles slid by {before}; now by {after}. "
        f"They stand {decimal(height, 0)} mm above the floor."
    )
    return joined((table(("foot", "touches in frames", "frames"), rows, 2), paragraphs(told)))


def _stretches(feet: Feet, foot: str) -> list[str]:
    own = (contact for contact in feet.contacts if contact.foot == foot)
    return [f"{contact.first} to {contact.last}" for contact in own]


def _settings(found: Cleaned) -> list[tuple[str, str]]:
    asked = found.settings
    filled = spans(found.motion.frames[found.filled].tolist())
    return [
        ("filter", f"{asked.filter}, {asked.smooth_hz:g} Hz"),
        ("feet", "left alone" if found.feet is None else f"held, floor at {found.feet.floor:g} m"),
        ("keys", "every frame" if asked.keys_mm is None else f"within {asked.keys_mm:g} mm"),
        ("frames", counted(len(found.motion.frames), "frame")),
        ("filled", ", ".join(filled) or "none"),
    ]
