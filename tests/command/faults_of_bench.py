"""Faults of what the benchmarks are given."""

from pathlib import Path

import numpy as np
from faults import Chapter

BENCH = Chapter("Benchmarks")


@BENCH.add("a take without known motion", "truth.npz", "is missing", "known motion", early=False)
def _(folder: Path):
    (folder / "truth.npz").unlink()
    return ("bench", "tracking", folder / "take.toml", "--progress", "none")


@BENCH.add("a truth of other frames", "truth.npz", "no frame from 0 to 3", early=False)
def _(folder: Path):
    truth = dict(np.load(folder / "truth.npz"))
    np.savez(folder / "truth.npz", **truth | {"frames": truth["frames"] + 100})
    return ("bench", "tracking", folder / "take.toml", "--progress", "none")


@BENCH.add("a take for the benchmark of energy", "needs no take", "leave it out", early=False)
def _(folder: Path):
    return ("bench", "energy", folder / "take.toml")


@BENCH.add("prototypes for the benchmark of tracking", "belongs to bench energy", early=False)
def _(folder: Path):
    return ("bench", "tracking", "--prototypes", folder)


@BENCH.add("a folder without prototypes", "does not hold the prototypes", early=False)
def _(folder: Path):
    return ("bench", "energy", "--prototypes", folder)
