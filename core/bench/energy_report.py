"""What is written of `EnergyFigures`: the numbers as JSON."""

from collections.abc import Sequence

import numpy as np

from . import against_prototypes as prototype
from .energy import EnergyFigures
from .rows import EXACT, LEVELS, LOD, PAPER_GL, TWO_THREADS, WEIGHTED
from .table1 import PAPER_RATES, PARTS, PRERENDERED, WAYS, Measured
from .table2 import PAPER_EVALUATIONS, PAPER_SECONDS
from .turns import Rates

Ratios = dict[str, dict[str, float | None]]


def as_dict(figures: EnergyFigures) -> dict:
    """All figures for JSON; ratios are medians over the turns, None where a side is missing."""
    by_size = {
        size: dict(zip(LEVELS, counts, strict=True)) for size, counts in figures.triangles.items()
    }
    return {
        "machine": figures.machine,
        "notes": figures.notes,
        "triangles": next(iter(by_size.values())),
        "triangles_by_size": by_size,
        **_ratios(figures),
        **_level_figures(figures),
        "table1": {size: _table1(table) for size, table in figures.table1.items()},
        "table1_2003": {
            cell: dict(zip(WAYS, rates, strict=True)) for cell, rates in PAPER_RATES.items()
        },
        "cameras": {row: costs.as_dict() for row, costs in figures.cameras.items()},
        "table2": {
            name: {way: fits.as_dict() for way, fits in ways.items()}
            for name, ways in figures.table2.items()
        },
        "table2_2003": {
            "seconds_per_frame": PAPER_SECONDS,
            "most_evaluations_per_frame": PAPER_EVALUATIONS,
        },
        "same_poses_without_prerendering": {
            name: bool(np.array_equal(ways["xor"].poses, ways["prerendered"].poses))
            for name, ways in figures.table2.items()
        },
        "prototypes": {
            size: {part: _rates(rates) for part, rates in parts.items()}
            for size, parts in figures.prototypes.items()
        },
    }


def _ratios(figures: EnergyFigures) -> dict:
    """At the paper's resolution, and by size where there are several."""
    tables, comparisons = figures.table1.items(), figures.prototypes.items()
    paper_gl = {size: ratios_in(table, PAPER_GL) for size, table in tables}
    threads = {size: two_thread_ratios(table) for size, table in tables}
    weighted = {size: weighted_ratios(table) for size, table in tables}
    kern_c = {size: ratios_to_kern_c(parts) for size, parts in comparisons}
    ending = v3_ending(figures.machine)
    on_v3 = {size: ratios_to_kern_c(parts, ending) for size, parts in comparisons}
    gl_eval = {size: ratios_to_gl_eval(parts) for size, parts in comparisons}
    return {
        "ratio_to_paper_gl": next(iter(paper_gl.values())),
        "ratio_to_kern_c": next(iter(kern_c.values()), _nothing()),
        "ratio_to_kern_c_v3": next(iter(on_v3.values()), _nothing()),
        "ratio_to_gl_eval": next(iter(gl_eval.values()), _nothing()),
        "two_threads": next(iter(threads.values())),
        "two_processes": next(iter(figures.processes.values())),
        "weighted_ratio": {size: ratios["lod"]["whole"] for size, ratios in weighted.items()},
        "ratio_to_paper_gl_by_size": paper_gl,
        "ratio_to_kern_c_by_size": kern_c,
        "ratio_to_kern_c_v3_by_size": on_v3,
        "ratio_to_gl_eval_by_size": gl_eval,
        "two_threads_by_size": threads,
        "two_processes_by_size": figures.processes,
        "weighted_ratio_by_part": weighted,
    }


def _level_figures(figures: EnergyFigures) -> dict:
    levels = figures.levels.as_dict()
    return {
        "lod_mask_xor": levels["mask_xor"]["max"],
        "lod_energy_difference": levels["energy_difference"]["max"],
        "lod_pose_change_mm": levels["pose_change_mm"]["mean"],
        "lod_pose_change_max_mm": levels["pose_change_mm"]["max"],
        "lod_pose_change_control_mm": levels["full_mesh_again_mm"]["mean"],
        "lod_best_pose_shift_mm": levels["best_pose_shift_mm"]["mean"],
        "lod_best_pose_shift_max_mm": levels["best_pose_shift_mm"]["max"],
        "lod": levels,
    }


def ratios_in(table: Measured, base: str) -> Ratios:
    """How many times as fast our rows are as the row ``base``, pre-rendered."""
    return {
        level: {part: table[cell, PRERENDERED].ratio(name, base) for part, cell in PARTS.items()}
        for level, name in LEVELS.items()
    }


def weighted_ratios(table: Measured) -> Ratios:
    """Speed with any weights as a share of that with ±1."""
    return _own_ratios(table, WEIGHTED)


def two_thread_ratios(table: Measured) -> Ratios:
    """Speed of two threads as a multiple of one's."""
    return _own_ratios(table, TWO_THREADS)


def ratios_to_kern_c(parts: dict[str, Rates], ending: str | None = "") -> Ratios:
    """Exact against the winding kernel on the full mesh, coarse against the best on the coarse.

    Args:
        parts: rates by part.
        ending: of our rows' names; None where they were not measured.
    """
    if ending is None:
        return _nothing()
    exact, coarse = EXACT + ending, LOD + ending
    return {
        "exact": {part: rates.ratio(exact, prototype.KERN_EXACT) for part, rates in parts.items()},
        "lod": {
            part: _to_best(rates, coarse, prototype.KERN_COARSE) for part, rates in parts.items()
        },
    }


def v3_ending(machine: dict) -> str | None:
    """How rows on the x86-64-v3 code path end; None where the processor does not have it."""
    return {"x86-64-v4": prototype.ON_V3, "x86-64-v3": ""}.get(machine["code_path"])


def ratios_to_gl_eval(parts: dict[str, Rates]) -> Ratios:
    """Both levels against the prototype's OpenGL as in the paper."""
    return {
        level: {part: rates.ratio(name, prototype.GL_EVAL) for part, rates in parts.items()}
        for level, name in LEVELS.items()
    }


def _to_best(rates: Rates, name: str, names: Sequence[str]) -> float | None:
    best = rates.best(names)
    return None if best is None else rates.ratio(name, best)


def _own_ratios(table: Measured, suffix: str) -> Ratios:
    return {
        level: {
            part: table[cell, PRERENDERED].ratio(name + suffix, name)
            for part, cell in PARTS.items()
        }
        for level, name in LEVELS.items()
    }


def _nothing() -> Ratios:
    return {level: dict.fromkeys(PARTS) for level in LEVELS}


def _table1(table: Measured) -> dict:
    found: dict = {}
    for (cell, way), rates in table.items():
        found.setdefault(cell, {})[way] = _rates(rates)
    return found


def _rates(rates: Rates) -> dict:
    fastest = rates.fastest
    values = zip(rates.medians.items(), rates.batches, rates.differences, strict=True)
    return {
        name: {
            "per_second": rate,
            "best_per_second": fastest[name],
            "batch": batch,
            "differs_px": difference,
        }
        for (name, rate), batch, difference in values
    }
