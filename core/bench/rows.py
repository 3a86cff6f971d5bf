"""The rows of Table 1: every evaluator at hand, and in which way it is used."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..errors import MocapError
from ..rendering.detail import level_for
from ..rendering.native import NativeEvaluator
from ..rendering.opengl.context import shared_thread
from ..rendering.opengl.gpu import OpenGLEvaluator
from ..rendering.opengl.paper import PaperEvaluator
from .hulls import HullEvaluator
from .stage import Stage
from .turns import Variant

PAPER_GL, EXACT, LOD = "opengl_paper", "native_exact", "native_lod"
LEVELS = {"exact": EXACT, "lod": LOD}
WEIGHTED, TWO_THREADS = "_weighted", "_two_threads"


@dataclass(frozen=True)
class Row:
    """One evaluator.

    Attributes:
        name: in files.
        title: in tables.
        make: of a body in cameras; any `Evaluator`, or what has its ``prepared``, ``masked`` and
            ``energies``.
        weighted: whether its weight maps hold any integers, not ±1 alone.
    """

    name: str
    title: str
    make: Callable[[Body, Sequence[Camera]], Any]
    weighted: bool = False


LevelChoice = Callable[[Body, Sequence[Camera]], int]
"""Which of a body's surfaces to draw in cameras."""


def full_level(body: Body, cameras: Sequence[Camera] = ()) -> int:
    """The finest of the body's surfaces."""
    return len(body.surfaces) - 1


def coarse_level(body: Body, cameras: Sequence[Camera]) -> int:
    """The surface that fits with these cameras are drawn with."""
    return level_for(body, cameras, body.rest_pose)


def native_rows() -> list[Row]:
    """The native kernel: exact and coarse, plain, weighted and with two threads."""
    rows = []
    for name, title, level in (
        (EXACT, "full mesh", full_level),
        (LOD, "coarse mesh", coarse_level),
    ):
        plain, two = _native(level), _native(level, threads=2)
        rows += [
            Row(name, f"native, {title}", plain),
            Row(name + WEIGHTED, f"native, {title}, any weights", plain, weighted=True),
            Row(name + TWO_THREADS, f"native, {title}, two threads", two),
        ]
    return rows


def hull_rows() -> list[Row]:
    """OpenCV's convex hulls."""

    def make(body: Body, cameras: Sequence[Camera]) -> HullEvaluator:
        return HullEvaluator(body, cameras, coarse_level(body, cameras))

    return [Row("cv2_hulls", "cv2 convex hulls, coarse mesh", make)]


def opengl_rows(note: Callable[[str], None]) -> list[Row]:
    """OpenGL as in the paper and as on today's cards; none where there is no OpenGL."""
    try:
        shared_thread()
    except MocapError as error:
        note(f"no rows for OpenGL: {error}")
        return []
    return [
        Row(PAPER_GL, "OpenGL as in the paper, full mesh", _at(PaperEvaluator, full_level)),
        Row("opengl_gpu", "OpenGL, batched, full mesh", _at(OpenGLEvaluator, full_level)),
        Row("opengl_gpu_lod", "OpenGL, batched, coarse mesh", _at(OpenGLEvaluator, coarse_level)),
    ]


def opengl_renderer() -> str | None:
    """OpenGL's name for what draws; None where there is no OpenGL."""
    try:
        return shared_thread().renderer
    except MocapError:
        return None


def variant(
    row: Row,
    evaluator: Any,
    stage: Stage,
    drawn: Sequence[int],
    windows: np.ndarray | None,
) -> Variant:
    """How ``row`` computes energies of the ``drawn`` segments within windows (V, 4)."""
    weights = evaluator.prepared(stage.maps(row.weighted))
    everything = len(drawn) == len(stage.everything)
    if windows is not None or not everything:
        weights = evaluator.masked(weights, stage.pose, drawn, windows)
    segments = None if everything else tuple(drawn)

    def energies(poses: np.ndarray) -> np.ndarray:
        return evaluator.energies(weights, poses, segments).sum(axis=1)

    return Variant(row.name, energies, comparable=not row.weighted)


def _native(level: LevelChoice, threads: int = 1) -> Callable:
    def make(body: Body, cameras: Sequence[Camera]) -> NativeEvaluator:
        return NativeEvaluator(body, cameras, level(body, cameras), threads)

    return make


def _at(kind: Callable, level: LevelChoice) -> Callable:
    def make(body: Body, cameras: Sequence[Camera]) -> Any:
        return kind(body, tuple(cameras), level(body, cameras))

    return make
