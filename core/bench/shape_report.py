"""What is written of `ShapeFigures`: tables, the worst first, and numbers for JSON."""

from dataclasses import asdict
from pathlib import Path

from .energy_files import write_texts
from .machine import machine_words
from .markdown import lined
from .shape import LENGTHS, ShapeFigures, ShapeRow

_HEADS = (
    "take", "body", "height m", "initial pose", "whole take", "offset removed", "p95",
    "lost frames", "limb losses", "limbs off by",
)  # fmt: skip


def as_dict(figures: ShapeFigures) -> dict:
    """All figures for JSON."""
    return {"machine": figures.machine, "rows": [asdict(row) for row in figures.rows]}


def shape_report(figures: ShapeFigures) -> str:
    """Both tables as Markdown."""
    rows = sorted(figures.rows, key=lambda row: -row.score.absolute.mean)
    lengths = sorted(
        ((abs(off), name, row) for row in figures.rows for name, off in row.off.items()),
        key=lambda item: -item[0],
    )
    parts = [
        "# Shape",
        f"Measured on {machine_words(figures.machine)}. Errors in mm from the truth, absolute "
        "unless said; the worst first.",
        lined(_HEADS, [_cells(row) for row in rows]),
        "Limbs against their true lengths, means of left and right:",
        lined(
            ("limb", "take", "body", "off by"),
            [(name, row.take, row.body, f"{row.off[name]:+.1%}") for _, name, row in lengths],
        ),
    ]
    return "\n\n".join(parts) + "\n"


def write_shape_files(figures: ShapeFigures, folder: Path) -> list[Path]:
    """Writes shape.md.

    Raises:
        MocapError: it cannot be written.
    """
    return write_texts({"shape.md": shape_report(figures)}, folder)


def _cells(row: ShapeRow) -> tuple[str, ...]:
    score = row.score
    return (
        row.take,
        row.body,
        f"{row.height_m:.3f}",
        f"{row.initial_mm:.1f}",
        f"{score.absolute.mean:.1f}",
        f"{score.offset_removed.mean:.1f}",
        f"{score.absolute.p95:.1f}",
        str(score.lost_frames),
        str(score.limb_losses),
        f"{sum(map(abs, row.off.values())) / len(LENGTHS):.1%}",
    )
