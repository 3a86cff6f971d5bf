"""Where the processors' time goes, told by stages that are entered and left.

It is that of all of the process's threads, so that other processes change nothing.
"""

import time
from collections import defaultdict
from collections.abc import Callable, Mapping
from typing import Any


class Stopwatch:
    """Processor seconds spent in each stage, without those of stages entered from it.

    Attributes:
        seconds: by stage.
    """

    def __init__(self):
        self.seconds: defaultdict[str, float] = defaultdict(float)
        self._inner: list[float] = []

    def timed(self, stage: str, function: Callable) -> Callable:
        """``function``, which counts as ``stage`` from now on."""

        def call(*arguments, **keywords):
            begin = time.process_time()
            self._inner.append(0.0)
            try:
                return function(*arguments, **keywords)
            finally:
                took = time.process_time() - begin
                self.seconds[stage] += took - self._inner.pop()
                if self._inner:
                    self._inner[-1] += took

        return call

    def watched(self, thing: Any, stages: Mapping[str, str]) -> Any:
        """``thing``, of which some methods count as stages, by the methods' names."""
        return _Watched(
            thing, {name: self.timed(s, getattr(thing, name)) for name, s in stages.items()}
        )


class _Watched:
    """Something with other methods in place of its own."""

    def __init__(self, inner: Any, methods: Mapping[str, Callable]):
        self.__dict__.update(methods, _inner=inner)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)
