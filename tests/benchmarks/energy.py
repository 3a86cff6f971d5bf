"""Evaluations per second of the native kernel beside the frozen prototypes, in one run.

    python tests/benchmarks/energy.py [--prototypes FOLDER] [--json FILE]

One evaluation is one candidate pose in all eight cameras. Whole body: all segments; limb and hand:
an arm's three segments or the hand alone, the rest pre-rendered into the weights. Every call of a
variant gets a batch of distinct poses; all variants take turns, and medians of the turns are shown.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from prototypes import Prototypes
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.cameras.presets import studio_t
from silhouette_mocap.core.energy.weight_maps import xor_weight_maps
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.silhouettes.silhouette import Silhouette

ROOT = Path(__file__).resolve().parents[2]
TURNS, SECONDS = 7, 0.15
SIZES = ((320, 240), (640, 480))
BATCH = 256
PARTS = {"whole": None, "limb": [4, 5, 6], "hand": [6]}
PAPER_WINDOWS = {"whole": None, "limb": 128, "hand": 64}


@dataclass(frozen=True)
class Variant:
    """One row: a name, what runs, and how many evaluations a run makes."""

    name: str
    run: Callable[[], object]
    evaluations: int


def evaluations_per_second(variant: Variant) -> float:
    begin, count = time.perf_counter(), 0
    while True:
        variant.run()
        count += variant.evaluations
        seconds = time.perf_counter() - begin
        if seconds > SECONDS:
            return count / seconds


def measured(variants: list[Variant]) -> dict[str, float]:
    """Median evaluations per second of each variant, all taking turns."""
    turns = [[evaluations_per_second(variant) for variant in variants] for _ in range(TURNS)]
    return dict(zip((v.name for v in variants), np.median(turns, axis=0).tolist(), strict=True))


def candidates(prototypes: Prototypes, segments) -> np.ndarray:
    """(BATCH, 35) distinct poses in the prototypes' order; only the part moves."""
    rng, scene = np.random.default_rng(0), prototypes.scene
    poses = scene.pose(12) + rng.normal(0, 0.03, (BATCH, scene.NDOF))
    if segments is not None:
        begin, end = scene.dstart[segments[0]], scene.dstart[segments[-1] + 1]
        poses = np.repeat(poses[:1], BATCH, axis=0)
        poses[:, begin:end] += rng.normal(0, 0.05, (BATCH, end - begin))
    return poses


def native_variant(name, evaluator, maps, poses, segments) -> tuple[Variant, np.ndarray]:
    weights = evaluator.prepared(maps)
    if segments is not None:
        weights = evaluator.masked(weights, poses[0], segments)
    variant = Variant(name, lambda: evaluator.energies(weights, poses, segments), len(poses))
    return variant, evaluator.energies(weights, poses[:4], segments).sum(axis=1)


def prototype_variants(prototypes, size, observed, poses, part):
    """kern.c (winding) at both levels and gl_eval.py, each with its first four energies."""
    segments = PARTS[part]
    chosen = np.arange(16, dtype=np.int32) if segments is None else np.array(segments, np.int32)
    rest = [s for s in range(16) if s not in chosen]
    fixed = prototypes.silhouettes(size, poses[0], rest) if rest else None
    narrow = np.ascontiguousarray(poses, np.float32)
    for level in ("full", "coarse"):
        evaluator = prototypes.evaluator(level, size, observed, fixed)

        def run(evaluator=evaluator, count=BATCH):
            return evaluator.batch(narrow[:count], chosen, 2, 0)

        yield Variant(f"prototype kern.c, {level} mesh", run, BATCH), run(count=4)
    window = PAPER_WINDOWS[part] and PAPER_WINDOWS[part] * size[1] // 240
    try:
        paper = prototypes.gl_evaluator(size, observed, fixed, window, poses[0], chosen)
    except Exception as error:  # whatever EGL lacks here, the other rows still count
        sys.stdout.write(f"!! NO OPENGL ROW: {type(error).__name__}: {error}\n")
        return
    calls = iter(range(1 << 60))
    run_gl = lambda: paper.eval(poses[next(calls) % BATCH], chosen)  # noqa: E731
    yield (
        Variant("prototype gl_eval.py, paper", run_gl, 1),
        np.array([paper.eval(pose, chosen) for pose in poses[:4]]),
    )


def bench_part(prototypes, size, part) -> dict[str, float]:
    """Medians of all variants for one part at one size; prints the table."""
    observed = prototypes.silhouettes(size, prototypes.scene.pose(10))
    seen = np.ones(observed.shape[1:], bool)
    maps = xor_weight_maps([Silhouette(picture > 0, seen) for picture in observed])
    body, cameras = prototypes.body(), prototypes.cameras(size)
    poses = candidates(prototypes, PARTS[part])
    rows = [
        native_variant(
            f"native, {level} mesh",
            NativeEvaluator(body, cameras, number),
            maps,
            prototypes.our_poses(poses),
            PARTS[part],
        )
        for number, level in ((1, "full"), (0, "coarse"))
    ]
    rows += prototype_variants(prototypes, size, observed, poses, part)
    medians = measured([variant for variant, _ in rows])
    exact, base = rows[0][1], medians["prototype kern.c, full mesh"]
    print_rows(
        f"{size[0]}x{size[1]} {part}", medians, base, [abs(e - exact).max() for _, e in rows]
    )
    return medians


def print_rows(title: str, medians: dict[str, float], base: float, differences) -> None:
    for (name, rate), difference in zip(medians.items(), differences, strict=True):
        sys.stdout.write(
            f"{title:16} {name:32} {rate:12,.0f} /s  x{rate / base:6.2f}  differs {difference} px\n"
        )
    sys.stdout.flush()


def processor_name() -> str:
    names = Path("/proc/cpuinfo")
    lines = names.read_text().splitlines() if names.exists() else []
    models = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
    return f"{models[0] if models else platform.processor()}, {os.cpu_count()} cores"


def bench_own() -> dict[str, dict[str, float]]:
    """Our rows alone, on our own body of sixteen segments in the studio's eight cameras."""
    body, studio = template("sixteen_segment"), studio_t()
    rng = np.random.default_rng(0)
    start = rng.normal(0, 0.1, len(body.dofs))
    results = {}
    for name, part in (("whole", None), ("limb", "left_arm"), ("hand", "left_hand")):
        chosen = next((p for p in body.parts if p.name == part), None)
        segments = None if chosen is None else list(chosen.segments)
        moved = np.arange(len(body.dofs)) if chosen is None else np.array(chosen.dofs)
        poses = np.repeat(start[None], BATCH, axis=0)
        poses[:, moved] += rng.normal(0, 0.05, (BATCH, len(moved)))
        rows = []
        for number, level in ((-1, "full"), (0, "coarse")):
            evaluator = NativeEvaluator(body, studio.cameras, number)
            pictures = evaluator.silhouettes(start)
            maps = xor_weight_maps([Silhouette(p, np.ones_like(p)) for p in pictures])
            rows.append(native_variant(f"native, {level} mesh", evaluator, maps, poses, segments))
        medians = measured([variant for variant, _ in rows])
        exact = rows[0][1]
        differences = [abs(energies - exact).max() for _, energies in rows]
        print_rows(name, medians, medians["native, full mesh"], differences)
        results[name] = medians
    return results


def bench_all(folder: Path) -> dict[str, dict[str, float]]:
    """All rows on the prototypes' body and cameras."""
    with tempfile.TemporaryDirectory() as scratch:
        prototypes = Prototypes(folder, Path(scratch))
        return {
            f"{size[0]}x{size[1]} {part}": bench_part(prototypes, size, part)
            for size in SIZES
            for part in PARTS
        }


def main() -> None:
    """Prints the table, and writes it where ``--json`` says."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--prototypes", type=Path, help="folder of the frozen prototypes")
    parser.add_argument("--json", type=Path, help="file to write the medians to")
    arguments = parser.parse_args()
    np.finfo(np.float32), np.finfo(float)  # asked before -ffast-math of kern.c flushes subnormals
    machine = processor_name()
    sys.stdout.write(
        f"{machine}; one thread; medians of {TURNS} turns; x: to the row marked 1.00\n"
    )
    folder = arguments.prototypes or ROOT.parent / "shared" / "prototypes"
    if (folder / "kern.c").is_file():
        try:
            results = bench_all(folder.resolve())
        except (ImportError, FileNotFoundError, subprocess.CalledProcessError) as error:
            sys.stdout.write(f"!! NO PROTOTYPES: {error} (they need gcc and numba)\n")
            results = bench_own()
    else:
        sys.stdout.write(f"!! NO PROTOTYPES in {folder}: our rows alone, on our own body\n")
        results = bench_own()
    if arguments.json:
        arguments.json.write_text(json.dumps({"machine": machine, **results}, indent=1))


if __name__ == "__main__":
    main()
