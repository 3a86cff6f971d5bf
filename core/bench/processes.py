"""How much two separate processes do at once: the ceiling of what two threads can do.

Two cores need not be twice one: they may share hardware or slow each other down. Here the same work
runs in one process alone and, in turn, in two processes at once that share nothing but the machine.
The workers are this very module, told what to do by lines of JSON.
"""

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import asdict
from typing import Any, TextIO

import numpy as np

from ..body.templates import template
from ..errors import MocapError
from .rows import LEVELS, native_rows
from .stage import studio
from .table1 import CELLS, PARTS, PRERENDERED, candidates_of, scene_of, variant_of
from .turns import Turns, Variant, batch_of, rate_of

_HEAD_START = 0.05
"""Seconds in which both get ready, so that they begin at the same moment."""
Work = tuple[Variant, Callable[[int], np.ndarray]]
"""What is measured, and a turn's number to its candidates."""


def two_process_ratios(size: tuple[int, int], turns: Turns) -> dict[str, dict[str, float]]:
    """By level and part, the speed of two processes at once as a multiple of one's alone.

    Medians over the turns, in which the one and the two follow each other.
    """
    with ExitStack() as stack:
        workers = [stack.enter_context(_worker(size, turns)) for _ in range(2)]
        for worker in workers:
            worker.wait()
        return {
            level: {part: _ratio(workers, level, part, turns.count) for part in PARTS}
            for level in LEVELS
        }


def _ratio(workers: Sequence["_Worker"], level: str, part: str, turns: int) -> float:
    found = []
    for turn in range(turns):
        alone = _rates(workers[turn % 2 :][:1], level, part, turn)
        both = _rates(workers, level, part, turn)
        found.append(sum(both) / alone[0])
    return float(np.median(found))


def _rates(workers: Sequence["_Worker"], level: str, part: str, turn: int) -> list[float]:
    begin = time.time() + _HEAD_START
    for worker in workers:
        worker.ask({"level": level, "part": part, "turn": turn, "begin": begin})
    return [worker.wait() for worker in workers]


class _Worker:
    """A process that measures when asked."""

    def __init__(self, process: subprocess.Popen):
        self._process = process

    def ask(self, task: dict[str, Any]) -> None:
        """Tells it what to do."""
        try:
            _write(self._process.stdin, task)
        except OSError as error:
            raise MocapError("a second process ended by itself") from error

    def wait(self) -> float:
        """What it answers.

        Raises:
            MocapError: it ended instead.
        """
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        if not line:
            raise MocapError("a second process ended by itself")
        return float(json.loads(line))


@contextmanager
def _worker(size: tuple[int, int], turns: Turns) -> Iterator[_Worker]:
    words = [sys.executable, "-m", __name__]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as run:
        try:
            worker = _Worker(run)
            worker.ask({"size": size, "turns": asdict(turns)})
            yield worker
        finally:
            run.kill()


def _write(stream: Any, value: Any) -> None:
    stream.write(json.dumps(value) + "\n")
    stream.flush()


def serve(lines: TextIO, answers: TextIO) -> None:
    """Measures what the lines ask for until they end; the first says at which size, how long."""
    asked = json.loads(lines.readline())
    turns = Turns(**asked["turns"])
    works = _works(tuple(asked["size"]), turns.poses)
    batches = {key: batch_of(found, at(0), turns) for key, (found, at) in works.items()}
    _write(answers, 0)
    for line in lines:
        task = json.loads(line)
        key = task["level"], task["part"]
        found, candidates = works[key]
        poses = candidates(task["turn"] + 1)
        time.sleep(max(0.0, task["begin"] - time.time()))
        _write(answers, rate_of(found, poses, batches[key], turns.seconds))


def _works(size: tuple[int, int], count: int) -> dict[tuple[str, str], Work]:
    """By level and part, what Table 1 measures with one thread, parts that stand still masked."""
    scene, cells = scene_of(template("sixteen_segment")), {cell.name: cell for cell in CELLS}
    stage = scene.stage(studio(size))
    rows, works = {row.name: row for row in native_rows()}, {}
    for level, name in LEVELS.items():
        evaluator = rows[name].make(stage.body, stage.cameras)
        for part, cell in PARTS.items():
            found = variant_of(rows[name], evaluator, stage, cells[cell], PRERENDERED)
            works[level, part] = found, candidates_of(stage, cells[cell], count)
    return works


if __name__ == "__main__":
    serve(sys.stdin, sys.stdout)
