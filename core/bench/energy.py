"""The benchmark of the energy: Tables 1 and 2 of Theobalt et al. 2003 on this machine.

Whatever flushes subnormal numbers once it is loaded, the prototypes, comes last.
"""

import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from ..body.templates import template
from ..errors import MocapError
from ..optimisers.evolution import Evolution
from ..progress import Progress
from . import against_prototypes as prototype
from .cameras import CameraCosts, camera_costs
from .levels import FIT, LevelCheck, level_check
from .machine import machine
from .processes import two_process_ratios
from .prototypes import FILES, Prototypes, are_in
from .rows import (
    EXACT,
    LEVELS,
    LOD,
    PAPER_GL,
    coarse_level,
    full_level,
    hull_rows,
    native_rows,
    opengl_renderer,
    opengl_rows,
)
from .sequences import SEQUENCES
from .stage import PAPER_SIZE, studio
from .table1 import CELLS, PARTS, WAYS, Measured, Teller, scene_of, table1, triangles
from .table2 import SequenceFits, table2
from .turns import Rates, Turns


@dataclass(frozen=True)
class EnergySettings:
    """How much to measure.

    Attributes:
        turns: how thoroughly rates are measured.
        sizes: (width, height) of the pictures; the paper's first.
        camera_counts: for the cost per camera.
        frames: fitted of each sequence.
        fits: for the change of the pose by the coarse mesh.
        fit: how hard those search.
        prototypes: folder of the frozen prototypes; None without.
    """

    turns: Turns = field(default_factory=Turns)
    sizes: tuple[tuple[int, int], ...] = (PAPER_SIZE, (640, 480), (1920, 1080))
    camera_counts: tuple[int, ...] = (2, 4, 6, 8, 10, 12, 14, 16)
    frames: int = 40
    fits: int = 50
    fit: Evolution = FIT
    prototypes: Path | None = None

    @property
    def steps(self) -> int:
        """How many steps are told to the progress."""
        cells = len(CELLS) * len(WAYS) * len(self.sizes)
        return (
            cells
            + len(self.sizes)
            + 1
            + self.fits
            + len(SEQUENCES) * self.frames
            + len(self.comparisons)
        )

    @property
    def comparisons(self) -> list[tuple[tuple[int, int], str]]:
        """Size and part of every comparison with the prototypes."""
        if self.prototypes is None:
            return []
        return [(size, part) for size in self.sizes for part in prototype.PARTS]


QUICK = EnergySettings(
    Turns(3, 0.03, 2048, 128), (PAPER_SIZE,), camera_counts=(2, 5, 8), frames=3, fits=2
)


@dataclass(frozen=True, eq=False)
class EnergyFigures:
    """Everything that was measured.

    Attributes:
        machine: what on.
        titles: of the rows, by their names.
        table1: by size (``320x240``).
        processes: by size, level and part, two processes at once as a multiple of one's speed.
        cameras: cost against the number of cameras, by row.
        levels: what the coarse mesh changes.
        table2: by sequence and row.
        prototypes: by size and part; empty without prototypes.
        triangles: of the full and of the coarse mesh, by size.
        notes: what was left out, and why.
    """

    machine: dict
    titles: dict[str, str]
    table1: dict[str, Measured]
    processes: dict[str, dict[str, dict[str, float | None]]]
    cameras: dict[str, CameraCosts]
    levels: LevelCheck
    table2: dict[str, dict[str, SequenceFits]]
    prototypes: dict[str, dict[str, Rates]]
    triangles: dict[str, tuple[int, int]]
    notes: tuple[str, ...]


def energy_figures(settings: EnergySettings, progress: Progress) -> EnergyFigures:
    """Measures all of it.

    Raises:
        MocapError: the native kernel is missing.
    """
    notes: list[str] = []

    def note(text: str) -> None:
        if text not in notes:
            notes.append(text)
            progress.note(text)

    tell = Teller(note, lambda: progress.advance(None))
    facts = machine(opengl_renderer())
    body = template("sixteen_segment")
    scene = scene_of(body)
    rows = [*opengl_rows(note), *hull_rows(), *native_rows()]
    plain = [row for row in rows if row.name in (PAPER_GL, EXACT, LOD)]
    progress.begin("bench", settings.steps)
    tables = {}
    for size in settings.sizes:
        tables[named(size)] = table1(scene, size, rows, settings.turns, tell)
    processes = {
        named(size): _process_ratios(size, settings.turns, tell) for size in settings.sizes
    }
    costs = camera_costs(scene, settings.camera_counts, plain, settings.turns)
    tell.advance()
    cameras = studio()
    levels = level_check(body, cameras, settings.fits, tell.advance, settings.fit)
    fits = {name: table2(body, cameras, name, settings.frames, tell.advance) for name in SEQUENCES}
    return EnergyFigures(
        machine=facts,
        titles={row.name: row.title for row in rows},
        table1=tables,
        processes=processes,
        cameras=costs,
        levels=levels,
        table2=fits,
        prototypes=_prototype_figures(settings, tell),
        triangles={
            named(size): (triangles(body, size, full_level), triangles(body, size, coarse_level))
            for size in settings.sizes
        },
        notes=tuple(notes),
    )


def _process_ratios(size: tuple[int, int], turns: Turns, tell: Teller) -> dict:
    """Of two processes; None each where none can be started."""
    try:
        found = two_process_ratios(size, turns)
    except (MocapError, OSError) as error:
        tell.note(f"no figures for two processes: {error}")
        found = {level: dict.fromkeys(PARTS) for level in LEVELS}
    tell.advance()
    return found


def named(size: tuple[int, int]) -> str:
    """A resolution's name in tables."""
    return f"{size[0]}x{size[1]}"


def _prototype_figures(settings: EnergySettings, tell: Teller) -> dict[str, dict[str, Rates]]:
    if not are_in(settings.prototypes):
        where = "" if settings.prototypes is None else f" in {settings.prototypes}"
        tell.note(f"no rows for the prototypes: {', '.join(FILES)} are not at hand{where}")
        return {}
    assert settings.prototypes is not None
    found: dict[str, dict[str, Rates]] = {}
    with tempfile.TemporaryDirectory(prefix="bench_") as scratch:
        try:
            prototypes = Prototypes(settings.prototypes, Path(scratch))
        except MocapError as error:
            tell.note(f"no rows for the prototypes: {error}")
            return {}
        for size, part in settings.comparisons:
            rates = prototype.prototype_rates(prototypes, size, part, settings.turns, tell.note)
            found.setdefault(named(size), {})[part] = rates
            tell.advance()
    return found
