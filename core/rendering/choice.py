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
from .fallback import Failures, FallbackEvaluator
from .native import NativeEvaluator
from .reference import ReferenceEvaluator


class MakeEvaluator(Protocol):
    """What makes an evaluator of one of the body's surfaces in cameras."""

    def __call__(self, body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
        """The evaluator."""
        ...


def native(body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
    """The native kernel on all processors but one, which reads ahead and keeps what is found."""
    return NativeEvaluator(body, cameras, level, threads=max(1, (os.cpu_count() or 1) - 1))


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


class Choice:
    """Makes evaluators of the kind that was asked for; where OpenGL fails, native ones go on.

    Args:
        name: one of `EVALUATORS`, or None for what is best.
        tell: told, once, that the native evaluator goes on, and why.

    Attributes:
        name: the kind in use.
        notes: what was told.

    Raises:
        MocapError: the native kernel is wanted, and is missing or stale.
    """

    def __init__(self, name: str | None, tell: Callable[[str], None]):
        self.name, self.notes = name or BEST, ()
        self._tell, self._failures = tell, Failures(self._give_up)
        if self.name == "native":
            load()

    def check(self, cameras: Sequence[Camera], note: Callable[[str], None]) -> None:
        """Tries OpenGL, where it was asked for, and notes what draws pictures of ``cameras``."""
        if self.name != "opengl":
            return
        from .opengl.gpu import check_usable

        try:
            note(f"OpenGL draws on {check_usable(cameras)}")
        except MocapError as fault:
            self._failures.add(fault)

    def __call__(self, body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
        """An evaluator of one of the body's surfaces in cameras."""
        if self.name == "opengl":
            try:
                first = opengl(body, cameras, level)
                return FallbackEvaluator(
                    first, lambda: native(body, cameras, level), self._failures
                )
            except MocapError as fault:
                self._failures.add(fault)
        return EVALUATORS[self.name](body, cameras, level)

    def _give_up(self, fault: MocapError) -> None:
        self.name = BEST
        self.notes = (f"{fault.problem}; the native evaluator goes on",)
        self._tell(self.notes[0])
