"""Damaged files through a real command: is every one refused in one line, quickly and cheaply?

    cd tests && python -m benchmarks.fuzz [--cases 10000] [--seed 0] [--json FILE]

Each case damages one file of a small take (its take.toml, its calibration in each format, a mask
of each format) and runs ``masks``, which reads all of the take. It must answer with 0, or with 2
and one line, without a word from libraries, within a second and 500 MB. The cases run in child
processes under a limit of memory and time; a child that dies is a failure of the case it was at.
"""

import argparse
import faulthandler
import json
import random
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.fuzz_run import answer, limit_memory
from benchmarks.fuzz_takes import KINDS, Target, write_takes

MOST_SECONDS, MOST_MB = 1.0, 500.0
MOST_LETTERS = 2000
LONGEST_SECONDS = 20
_NOT_WHOLE = 3
LIMIT_MB = 4000
PROCESSES = 2


@dataclass(frozen=True)
class Case:
    """One damaged file and what came of it.

    Attributes:
        index: its number, which with the seed gives it again.
        kind: what was damaged.
        mutation: how.
        code: the exit code; None where the process died.
        seconds: that the command took.
        peak_mb: the most memory that the process held meanwhile.
        line: what was written to standard error.
    """

    index: int
    kind: str
    mutation: str
    code: int | None
    seconds: float
    peak_mb: float
    line: str

    @property
    def fault(self) -> str | None:
        """What is wrong with the answer; None where nothing is."""
        if self.code is None:
            return "died"
        if self.code not in (0, 2):
            return f"exit code {self.code}"
        lines = self.line.splitlines()
        if len(lines) != (self.code == 2) or not all(line.startswith("silh") for line in lines):
            return "other lines"
        if len(self.line) > MOST_LETTERS:
            return "long line"
        if self.seconds > MOST_SECONDS:
            return "slow"
        return "large" if self.peak_mb > MOST_MB else None


def case_of(seed: int, index: int, folder: Path) -> tuple[Target, str, bytes]:
    """What case ``index`` damages, how, and the damaged bytes."""
    rng = random.Random(seed * 1_000_003 + index)
    kind = tuple(KINDS)[index % len(KINDS)]
    target = rng.choice(KINDS[kind].targets)
    mutation = rng.choice(KINDS[kind].mutations)
    data = (folder / kind / target).read_bytes()
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        data = mutation(rng, data)
    return (
        Target(kind, folder / kind / "take.toml", folder / kind / target),
        mutation.__name__,
        data,
    )


def work(seed: int, first: int, last: int, step: int) -> None:
    """Runs the cases from ``first`` up to ``last`` and writes each to standard output as JSON."""
    limit_memory(LIMIT_MB)
    with tempfile.TemporaryDirectory(prefix="fuzz_") as scratch:
        folder = write_takes(Path(scratch))
        for kind in KINDS:
            # what is loaded once is no case's
            whole = answer(folder / kind / "take.toml", folder / "masks")
            if whole.code != 0:
                print(whole.line, file=sys.stderr)
                sys.exit(_NOT_WHOLE)
        for index in range(first, last, step):
            target, mutation, data = case_of(seed, index, folder)
            whole = target.file.read_bytes()
            target.file.write_bytes(data)
            faulthandler.dump_traceback_later(LONGEST_SECONDS, exit=True, file=sys.__stderr__)
            found = answer(target.take, folder / "masks")
            if found.seconds > MOST_SECONDS:
                # the machine may have been busy; what is slow is slow twice
                again = answer(target.take, folder / "masks")
                found = min(found, again, key=lambda answer: answer.seconds)
            faulthandler.cancel_dump_traceback_later()
            target.file.write_bytes(whole)
            print(json.dumps(asdict(Case(index, target.kind, mutation, *found))), flush=True)


def run(seed: int, count: int) -> list[Case]:
    """All cases, shared out to child processes."""
    children = [_Child(seed, first, count) for first in range(PROCESSES)]
    found = []
    for child in children:
        found.extend(child.cases())
    return sorted(found, key=lambda case: case.index)


class _Child:
    """A process that runs every ``PROCESSES``-th case, started again when it dies."""

    def __init__(self, seed: int, first: int, count: int):
        self.seed, self.next, self.count = seed, first, count
        self.output = tempfile.TemporaryFile("w+")  # noqa: SIM115
        self.start()

    def start(self) -> None:
        words = ["--seed", self.seed, "--cases", self.count, "--from", self.next]
        command = [sys.executable, "-m", "benchmarks.fuzz", *map(str, words)]
        self.process = subprocess.Popen(
            command, stdout=self.output, stderr=subprocess.PIPE, text=True
        )

    def cases(self) -> Iterator[Case]:
        """What it found, once it is through."""
        while True:
            _, error = self.process.communicate()
            self.output.seek(0)
            for line in self.output.read().splitlines():
                case = Case(**json.loads(line))
                self.next = case.index + PROCESSES
                yield case
            if self.process.returncode == 0:
                return
            if self.process.returncode == _NOT_WHOLE or self.next >= self.count:
                sys.exit(f"the takes are refused before they are damaged: {error}")
            kind = tuple(KINDS)[self.next % len(KINDS)]
            yield Case(self.next, kind, "?", None, 0.0, 0.0, error[-300:])
            self.next += PROCESSES
            self.output.seek(0)
            self.output.truncate()
            self.start()


def table(cases: Sequence[Case]) -> str:
    """One row per kind of file."""
    by_kind = defaultdict(list)
    for case in cases:
        by_kind[case.kind].append(case)
    by_kind["all"] = list(cases)
    rows = [
        f"{'file':<10}{'cases':>8}{'accepted':>10}{'refused':>9}{'failed':>8}{'slowest':>10}{'largest':>10}"
    ]
    for kind, found in by_kind.items():
        counts = [sum(case.code == code for case in found) for code in (0, 2)]
        failed = sum(case.fault is not None for case in found)
        slowest, largest = (max(getattr(c, key) for c in found) for key in ("seconds", "peak_mb"))
        rows.append(
            f"{kind:<10}{len(found):>8}{counts[0]:>10}{counts[1]:>9}{failed:>8}"
            f"{slowest:>8.2f} s{largest:>7.0f} MB"
        )
    return "\n".join(rows)


def main() -> int:
    """Runs the cases and prints the table; 1 where any failed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--from", type=int, dest="first", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.first is not None:
        work(arguments.seed, arguments.first, arguments.cases, PROCESSES)
        return 0
    begin = time.perf_counter()
    cases = run(arguments.seed, arguments.cases)
    failures = [case for case in cases if case.fault is not None]
    for case in failures[:50]:
        print(f"{case.fault}: case {case.index}, {case.kind} {case.mutation}, "
              f"{case.seconds:.2f} s, {case.peak_mb:.0f} MB: {case.line[:400]!r}")  # fmt: skip
    print(table(cases))
    print(f"seed {arguments.seed}, {time.perf_counter() - begin:.0f} s; {len(failures)} failures")
    if arguments.json:
        arguments.json.write_text(json.dumps([asdict(case) for case in cases]), "utf-8")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
