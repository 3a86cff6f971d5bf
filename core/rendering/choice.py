"""Which evaluator does the work: by name, or by itself.

By itself it is the native kernel: on a processor nothing else comes near to it. OpenGL is for
machines with a graphics processor, and only where it was asked for.
"""

import os
from collections.abc import Callable, Sequence
from typing import Protocol

from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from ..errors import MocapError
from ..native.library import load
from .native import NativeEvaluator
from .reference import ReferenceEvaluator


class MakeEvaluator(Protocol):
    """What makes an evaluator of one of the body's surfaces in cameras."""

    def __call__(self, body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
        """The evaluator."""
        ...


def native(body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
    """The native kernel on all processors."""
    return NativeEvaluator(body, cameras, level, threads=os.cpu_count() or 1)


def opengl(body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
    """OpenGL with many candidates at once; PyOpenGL is imported by the first call."""
    from .opengl.gpu import OpenGLEvaluator

    return OpenGLEvaluator(body, cameras, level)


EVALUATORS: dict[str, MakeEvaluator] = {
    "native": native,
    "opengl": opengl,
    "reference": ReferenceEvaluator,
}
BEST = "native"
"""What is taken where none was asked for, or where that one cannot be used."""


def usable(name: str | None, cameras: Sequence[Camera], note: Callable[[str], None]) -> str:
    """The evaluator to take for ``name``, one of `EVALUATORS`, or None for what is best.

    Where OpenGL was asked for and cannot be used, ``note`` is told why, and it is the native one.

    Raises:
        MocapError: the native kernel is wanted, and is missing or stale.
    """
    if name != "opengl":
        if name != "reference":
            load()
        return name or BEST
    from .opengl.gpu import check_usable

    try:
        renderer = check_usable(cameras)
    except MocapError as error:
        note(f"{error.problem}; the native evaluator goes on")
        return BEST
    note(f"OpenGL draws on {renderer}")
    return name
