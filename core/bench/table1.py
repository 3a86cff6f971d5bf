"""Table 1 of Theobalt et al. 2003: energies per second in windows of four sizes.

The whole body is drawn at full and half resolution, an arm in a window of 128 x 128 px and a hand
in one of 64 x 64 px. XOR draws the whole body for every candidate; with pre-rendering (XORPR) the
parts that stand still are drawn once and masked out. In the first two cells everything moves, so
that both are one and the same work. Both ways of a cell take turns with each other.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..errors import MocapError
from ..rendering.native import NativeEvaluator
from .rows import LevelChoice, Row, full_level, variant
from .sequences import sequence
from .stage import PART_SPREAD, WHOLE_SPREAD, Stage, candidates_about, filmed, part_named, studio
from .turns import Rates, Turns, Variant, measured

PAPER_RATES = {
    "full": (95.9, 95.5),
    "half": (131.1, 131.2),
    "limb": (133.7, 433.1),
    "hand": (144.9, 855.4),
}
"""XOR and XORPR on a GeForce3 and a 1.8 GHz Xeon; the paper's smallest window holds the head."""


@dataclass(frozen=True, eq=False)
class Teller:
    """What the benchmark says meanwhile.

    Attributes:
        note: a sentence on what is left out.
        advance: one step is done.
    """

    note: Callable[[str], None]
    advance: Callable[[], None]


@dataclass(frozen=True)
class Cell:
    """A window of the table.

    Attributes:
        name: in files.
        title: in tables, at 320 x 240.
        part: of the body that moves; None for all of it.
        side: px of the window at 240 lines; None for the whole picture.
        scale: of the pictures.
    """

    name: str
    title: str
    part: str | None = None
    side: int | None = None
    scale: float = 1.0


_POSE_FRAME, _SEEN_FRAME = 40, 38
CELLS = (
    Cell("full", "full"),
    Cell("half", "half", scale=0.5),
    Cell("limb", "128² (arm)", "left_arm", 128),
    Cell("hand", "64² (hand)", "left_hand", 64),
)
WAYS = ("xor", "prerendered")
PRERENDERED = WAYS[1]
PARTS = {"whole": "full", "limb": "limb", "hand": "hand"}
"""Part of the body to the cell that shows it."""
Measured = dict[tuple[str, str], Rates]
"""Cell and way to what was measured there."""


@dataclass(frozen=True, eq=False)
class Scene:
    """What Table 1 is measured with, at any resolution.

    Attributes:
        body: the model.
        pose: (D,) that candidates lie about.
        seen: (D,) the pose that was observed.
    """

    body: Body
    pose: np.ndarray
    seen: np.ndarray

    def stage(self, cameras: tuple[Camera, ...]) -> Stage:
        """The scene before these cameras."""
        full = NativeEvaluator(self.body, cameras, full_level(self.body))
        return Stage(full, self.pose, filmed(full, self.seen))


def scene_of(body: Body) -> Scene:
    """The scene that is measured: two frames of sequence A, one seen and one searched from."""
    motion = sequence(body, "A", _POSE_FRAME + 1)
    return Scene(body, motion[_POSE_FRAME], motion[_SEEN_FRAME])


def table1(
    scene: Scene,
    size: tuple[int, int],
    rows: Sequence[Row],
    turns: Turns,
    tell: Teller,
) -> Measured:
    """All cells at one resolution (width, height); rows that fail there are left out."""
    found: Measured = {}
    for scale in dict.fromkeys(cell.scale for cell in CELLS):
        stage = scene.stage(studio((int(size[0] * scale), int(size[1] * scale))))
        evaluators = _evaluators(stage, rows, tell)
        for cell in CELLS:
            if cell.scale != scale:
                continue
            rates = _rates(stage, cell, evaluators, turns)
            for way in WAYS:
                found[cell.name, way] = rates.of(way)
                tell.advance()
    return {(cell.name, way): found[cell.name, way] for cell in CELLS for way in WAYS}


def _evaluators(stage: Stage, rows: Sequence[Row], tell: Teller) -> dict[Row, Any]:
    """What each row draws with; rows that are made alike share it."""
    made: dict[Any, Any] = {}
    for row in rows:
        if row.make in made:
            continue
        try:
            made[row.make] = row.make(stage.body, stage.cameras)
            variant(row, made[row.make], stage, stage.everything, None).energies(stage.pose[None])
        except MocapError as error:
            made[row.make] = None
            tell.note(f"{row.title} is left out at {stage.cameras[0].size}: {error}")
    return {row: made[row.make] for row in rows if made[row.make] is not None}


def _rates(stage: Stage, cell: Cell, evaluators: dict[Row, Any], turns: Turns) -> Rates:
    """Of all rows and both ways, in turns."""
    variants = [
        variant_of(row, made, stage, cell, way) for way in WAYS for row, made in evaluators.items()
    ]
    return measured(variants, candidates_of(stage, cell, turns.poses), turns)


def variant_of(row: Row, evaluator: Any, stage: Stage, cell: Cell, way: str) -> Variant:
    """How ``row`` computes energies in a cell, in one of `WAYS`, of which they are a group."""
    part = None if cell.part is None else part_named(stage.body, cell.part)
    windows = None
    if part is not None and cell.side is not None:
        windows = stage.windows(part, cell.side)
    alone = part is not None and way == PRERENDERED
    drawn = part.segments if part is not None and alone else stage.everything
    return replace(variant(row, evaluator, stage, drawn, windows), group=way)


def candidates_of(stage: Stage, cell: Cell, count: int) -> Callable[[int], np.ndarray]:
    """Poses that differ in what moves in a cell; see `stage.candidates_about`."""
    part = None if cell.part is None else part_named(stage.body, cell.part)
    if part is None:
        return candidates_about(stage.pose, range(len(stage.body.dofs)), WHOLE_SPREAD, count)
    return candidates_about(stage.pose, part.dofs, PART_SPREAD, count)


def triangles(body: Body, size: tuple[int, int], level: LevelChoice = full_level) -> int:
    """How many the surface has that ``level`` chooses at a resolution (width, height)."""
    return len(body.surfaces[level(body, studio(size))].triangles)
