"""The figures as Markdown: all of them for a file, the most telling ones for the README."""

import math
from collections.abc import Iterable, Sequence

from ..pages.wording import UNKNOWN
from . import against_prototypes as prototype
from .energy import EnergyFigures
from .energy_report import (
    Ratios,
    ratios_in,
    ratios_to_kern_c,
    two_thread_ratios,
    v3_ending,
    weighted_ratios,
)
from .machine import machine_words
from .plots import PLOTS
from .rows import PAPER_GL
from .table1 import CELLS, PAPER_RATES, WAYS, Measured
from .table2 import PAPER_EVALUATIONS, PAPER_SECONDS

WAY_TITLES = {"xor": "XOR", "prerendered": "pre-rendered"}
TABLE2_TITLES = {
    "xor": "XOR",
    "prerendered": "XOR, pre-rendered",
    "shared_out": "XOR, pre-rendered, limbs shared out",
}
LEVEL_TITLES = {"exact": "full mesh, exact", "lod": "coarse mesh"}
_PAPER = "Theobalt et al. 2003 (GeForce3)"


def whole_report(figures: EnergyFigures) -> str:
    """Everything, with the plots beside it."""
    parts = ["# Speed of the energy", _about(figures)]
    for size, table in figures.table1.items():
        parts += [
            f"## Table 1 at {size}",
            "Evaluations per second, all cameras; the coarse mesh chosen for their pixels has "
            f"{figures.triangles[size][1]:,} triangles:",
            rates(table, figures),
        ]
    for size, of_parts in figures.prototypes.items():
        parts += [f"## Beside the prototypes at {size}", prototype_rates(of_parts, figures)]
    parts += [
        "## Ratios",
        ratio_table(figures, with_prototypes=True),
        "## Number of cameras",
        _cameras(figures),
    ]
    parts += ["## Coarse mesh", _levels(figures), "## Table 2", fits(figures)]
    parts += [f"![{title}]({name}.svg)" for name, title in PLOTS.items()]
    parts += [f"- {note}" for note in figures.notes]
    return "\n\n".join(parts) + "\n"


def readme_section(figures: EnergyFigures, folder: str) -> str:
    """The README's part; the plots lie in ``folder``, relative to it.

    Prototypes are left out: nobody who reads it has them.
    """
    first = next(iter(figures.table1.values()))
    pictures = [f"![{title}]({folder}/{name}.svg)" for name, title in PLOTS.items()]
    parts = [_about(figures), rates(first, figures), ratio_table(figures, with_prototypes=False)]
    parts += [fits(figures), *pictures]
    return "\n\n".join(parts) + "\n"


def rates(table: Measured, figures: EnergyFigures) -> str:
    """Table 1 at one resolution, with the paper's own figures in its last row."""
    heads = [f"{cell.title}, {WAY_TITLES[way]}" for cell in CELLS for way in WAYS]
    names = table[CELLS[0].name, WAYS[0]].names
    medians = {key: measured.medians for key, measured in table.items()}
    rows = [
        [
            figures.titles[name],
            *(_count(medians[cell.name, way].get(name)) for cell in CELLS for way in WAYS),
        ]
        for name in names
    ]
    if table is next(iter(figures.table1.values())):
        rows.append([_PAPER, *(_count(rate) for cell in CELLS for rate in PAPER_RATES[cell.name])])
    return lined(["", *heads], rows)


def prototype_rates(parts: dict, figures: EnergyFigures) -> str:
    """Evaluations per second of all rows on the prototypes' body."""
    names = next(iter(parts.values())).names
    rows = []
    for name in names:
        title = figures.titles.get(name) or prototype.title(name)
        rows.append([title, *(_count(measured.medians.get(name)) for measured in parts.values())])
    return lined(["", *parts], rows)


def ratio_table(figures: EnergyFigures, with_prototypes: bool) -> str:
    """How many times as fast our rows are."""
    kinds = {
        "to OpenGL as in the paper": lambda table: ratios_in(table, PAPER_GL),
        "two threads to one": two_thread_ratios,
        "any weights to ±1": weighted_ratios,
    }
    rows = []
    for what, ratios in kinds.items():
        for size, table in figures.table1.items():
            rows += _ratio_rows(f"{what}, {size}", ratios(table))
    for size, processes in figures.processes.items():
        rows += _ratio_rows(f"two processes to one, what two threads can reach, {size}", processes)
    for size, parts in figures.prototypes.items() if with_prototypes else ():
        rows += _ratio_rows(f"to prototype kern.c, {size}", ratios_to_kern_c(parts))
        on_v3 = ratios_to_kern_c(parts, v3_ending(figures.machine))
        rows += _ratio_rows(f"to prototype kern.c, on the x86-64-v3 path, {size}", on_v3)
    return lined(["", "", "whole", "limb", "hand"], rows)


def fits(figures: EnergyFigures) -> str:
    """Table 2."""
    heads = [""]
    for name in figures.table2:
        heads += [f"{name}: s/frame", "2003", "evaluations/frame", "2003, at most", "error, mm"]
    rows = []
    for way, title in TABLE2_TITLES.items():
        cells = [title]
        for name, ways in figures.table2.items():
            found = ways[way].as_dict()
            cells += [
                f"{found['seconds_per_frame']:.3f}", f"{PAPER_SECONDS[way][name]:.2f}",
                _count(found["evaluations_per_frame"]), _count(PAPER_EVALUATIONS[name]),
                f"{found['error_mm']:.1f}",
            ]  # fmt: skip
        rows.append(cells)
    return lined(heads, rows)


def lined(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table; columns after the first hold numbers."""
    marks = ["---", *["---:"] * (len(heads) - 1)]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (heads, marks, *rows))


def _about(figures: EnergyFigures) -> str:
    full, coarse = next(iter(figures.triangles.values()))
    return (
        f"Measured on {machine_words(figures.machine)}. Eight cameras; a body of {full:,} "
        f"triangles, {coarse:,} in its coarse mesh; one thread unless said. All rows of a column "
        "take turns, no candidate comes twice; medians, but for the cost per camera, which is that "
        "of the best turn."
    )


def _ratio_rows(what: str, ratios: Ratios) -> list[list[str]]:
    return [
        [what, LEVEL_TITLES[level], *(_times(value) for value in parts.values())]
        for level, parts in ratios.items()
    ]


def _cameras(figures: EnergyFigures) -> str:
    rows = [
        [
            figures.titles[name], f"{1e6 * costs.fixed:.1f}", f"{1e6 * costs.per_camera:.1f}",
            f"{costs.largest_residual:.1%}",
        ]
        for name, costs in figures.cameras.items()
    ]  # fmt: skip
    told = "Of each row's best turn, not the median: what else runs only ever adds to a cost.\n\n"
    return told + lined(["", "fixed, µs", "per camera, µs", "largest distance from the line"], rows)


def _levels(figures: EnergyFigures) -> str:
    found = figures.levels.as_dict()
    rows = [
        ["masks that differ, of the area", *_shares(found["mask_xor"])],
        ["energies that differ, of the area", *_shares(found["energy_difference"])],
        [
            f"points of {found['fits']} fits with either mesh from one start, mm",
            *_lengths(found["pose_change_mm"]),
        ],
        [
            "the same, both with the full mesh and other candidates, mm",
            *_lengths(found["full_mesh_again_mm"]),
        ],
        [
            "points of the coarse mesh's fits from the full mesh's best pose, mm",
            *_lengths(found["best_pose_shift_mm"]),
        ],
    ]
    keys = (
        "In the JSON file `lod_mask_xor` and `lod_energy_difference` are the largest, "
        "`lod_pose_change_mm` is the mean and `lod_pose_change_max_mm` the largest.\n\n"
    )
    return keys + lined(["coarse against full mesh", "mean", "largest"], rows)


def _lengths(spread: dict[str, float]) -> list[str]:
    return [f"{value:.2f}" for value in spread.values()]


def _shares(spread: dict[str, float]) -> list[str]:
    return [f"{value:.2%}" for value in spread.values()]


def _count(value: float | None) -> str:
    """Three digits that count."""
    if value is None or not math.isfinite(value):
        return UNKNOWN
    return f"{value:,.1f}" if value < 100 else f"{value:,.0f}"


def _times(value: float | None) -> str:
    if value is None:
        return UNKNOWN
    return f"{value:.2f}x" if value < 10 else f"{value:.0f}x"
