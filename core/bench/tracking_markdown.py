"""The figures of tracking as Markdown: all of them for a file, the most telling for the README."""

import math
from collections.abc import Mapping, Sequence

from .machine import machine_words
from .markdown import lined
from .tracking_confidence import BAD_MM, BINS, DOUBT, GOOD_MM, Reliability
from .tracking_plots import PLOTS
from .tracking_speed import SpeedFigures
from .tracking_torments import BACK_MM
from .tracking_trials import ABLATION, CAMERAS, LADDER, RATES, TAKES, TORMENTS

_FIGURES = {
    "frames": ("frames", 0),
    "absolute": ("absolute_mm", 1),
    "offset removed": ("offset_removed_mm", 1),
    "p95": ("p95_mm", 1),
    "lost frames": ("lost_frames", 0),
    "limb losses": ("limb_losses", 0),
    "jitter": ("jitter_mm", 1),
    "mm/px": ("mm_per_px", 1),
    "s/frame": ("seconds_per_frame", 3),
}
_HEADS = {
    TAKES: ("take", "tracker"),
    ABLATION: ("take", "without"),
    LADDER: ("take", "noise", "amount"),
    CAMERAS: ("take", "cameras"),
    RATES: ("take", "frames/s"),
}
_README_PLOTS = ("tracking_torments", "tracking_noise")
_UNKNOWN = "–"


def tracking_report(
    machine: dict,
    rows: Mapping[str, Sequence[dict]],
    confidence: Mapping[str, Reliability],
    speed: SpeedFigures,
) -> str:
    """Everything, with the plots beside it; the worst rows come first."""
    parts = [
        "# Tracking",
        f"Measured on {machine_words(machine)}. Errors in mm from the truth, worst first; a frame "
        "is lost where its mean error is above 150 mm, a limb where its wrist or ankle is off by "
        "more than that for two frames or longer; jitter in mm/frame².",
    ]
    for section, found in rows.items():
        table = torments_table(found) if section == TORMENTS else figures_table(section, found)
        parts += [f"## {section[0].upper()}{section[1:]}", table]
    parts += ["## Confidence", confidence_table(confidence)]
    parts += ["## Speed", speed_table(speed)]
    parts += [f"![{title}]({name}.svg)" for name, title in PLOTS.items()]
    return "\n\n".join(parts) + "\n"


def readme_section(
    machine: dict,
    rows: Mapping[str, Sequence[dict]],
    confidence: Mapping[str, Reliability],
    speed: SpeedFigures,
    folder: str,
) -> str:
    """The README's part, with two of the plots, which lie in ``folder``, relative to it."""
    parts = [
        f"Measured on {machine_words(machine)}. Errors in mm, the worst first.",
        figures_table(TAKES, rows[TAKES]),
        torments_table(rows[TORMENTS]),
        speed_table(speed),
        confidence_table(confidence),
        *(f"![{PLOTS[name]}]({folder}/{name}.svg)" for name in _README_PLOTS),
    ]
    return "\n\n".join(parts) + "\n"


def figures_table(section: str, rows: Sequence[dict]) -> str:
    """One row for each trial."""
    heads = _HEADS[section]
    keys = ("take", "name", "amount")[: len(heads)]
    lines = [
        [
            *(row[key] for key in keys),
            *(_number(row.get(key), digits) for key, digits in _FIGURES.values()),
        ]
        for row in rows
    ]
    return lined([*heads, *_FIGURES], lines)


def torments_table(rows: Sequence[dict]) -> str:
    """Error before, during and after each torment."""
    heads = [
        "take", "torment", "of", "frames", "before", "during", "without it", "1 after", "2", "3",
        "worst limb", "it is off by", "all limbs back in frame", "mm/px",
    ]  # fmt: skip
    told = (
        f"A limb is back where neither of its points is off by {BACK_MM:.0f} mm more than without "
        "the torment; frames are counted from the torment's end, and three in a row count.\n\n"
    )
    return told + lined(heads, [_torment(row) for row in rows])


def _torment(row: dict) -> list[str]:
    first, last = row.get("tormented_frames", (None, None))
    figures = [
        row.get("before_mm"), row.get("during_mm"), row.get("undisturbed_during_mm"),
        *row.get("after_mm", [None] * 3),
    ]  # fmt: skip
    back = row.get("back_in_frame")
    return [
        row["take"], row["name"], row["amount"], f"{first} to {last}",
        *(_number(value, 1) for value in figures),
        row.get("worst_limb", _UNKNOWN), _number(row.get("worst_limb_mm"), 0),
        "never" if back is None else str(back), _number(row["mm_per_px"], 1),
    ]  # fmt: skip


def confidence_table(confidence: Mapping[str, Reliability]) -> str:
    """How far confidence can be trusted."""
    heads = [
        "takes", "points", f"doubted, of those off by more than {BAD_MM:.0f} mm",
        f"doubted, of those off by less than {GOOD_MM:.0f} mm",
    ]  # fmt: skip
    rows = [
        [
            name, f"{found.counts.sum():,}", _share(found.doubted_of_bad),
            _share(found.doubted_of_good),
        ]
        for name, found in confidence.items()
    ]  # fmt: skip
    bins = [
        [f"{k / BINS:.1f} to {(k + 1) / BINS:.1f}", *_bin(found, k)]
        for found in list(confidence.values())[-1:]
        for k in range(BINS)
    ]
    return "\n\n".join(
        [
            f"Doubted is what has a confidence below {DOUBT}: at least 90 % of the former and less "
            "than 5 % of the latter should be.",
            lined(heads, rows),
            "All of these together:",
            lined(["confidence", "points", "mean", f"off by less than {GOOD_MM:.0f} mm"], bins),
        ]
    )


def _bin(found: Reliability, k: int) -> list[str]:
    return [f"{found.counts[k]:,}", _number(found.confidence[k], 2), _share(found.good[k])]


def speed_table(speed: SpeedFigures) -> str:
    """Shares of the stages, and how many times as fast this is as before."""
    heads = [
        f"{speed.take}, {speed.cameras}, {speed.frames} frames",
        "ms/frame, all processors",
        "share",
    ]
    rows = [
        [stage, _number(1000 * seconds, 1), _share(seconds / speed.busy)]
        for stage, seconds in speed.stages.items()
    ]
    rows.append(["together", _number(1000 * speed.busy, 1), _share(1.0)])
    rows.append(["all told, on the clock", _number(1000 * speed.all_told, 1), ""])
    tracking = speed.threads[max(speed.threads)]
    others = [
        [f"{count} thread{'s' * (count > 1)}", _number(seconds, 3), _times(seconds, tracking)]
        for count, seconds in speed.threads.items()
    ]
    others.append(
        [
            "tracker hierarchical",
            _number(speed.hierarchical, 3),
            _times(speed.hierarchical, tracking),
        ]
    )
    baseline = "Powell and limb grids, OpenGL as in the paper"
    others.append([baseline, _number(speed.baseline, 3), _times(speed.baseline, tracking)])
    bits = "the same bits" if speed.same_bits else "OTHER BITS"
    return "\n\n".join(
        [
            lined(heads, rows),
            f"Tracking alone, without footage, overlay and files; one and two threads find {bits}:",
            lined(["", "s/frame", "times as long"], others),
            *(f"- {note}" for note in speed.notes),
        ]
    )


def _times(seconds: float | None, base: float) -> str:
    return _UNKNOWN if seconds is None else f"{seconds / base:,.1f}x"


def _share(value: float) -> str:
    return f"{value:.1%}" if math.isfinite(value) else _UNKNOWN


def _number(value: float | None, digits: int) -> str:
    if value is None or not math.isfinite(value):
        return _UNKNOWN
    return f"{value:,.{digits}f}"
