"""Evaluations per second of several variants that take turns.

A machine's speed drifts by half while others use it, so that figures measured one after another
say little about each other. Here every variant runs for a moment in each turn, with the same
candidates; rates are medians over the turns, and ratios are medians of the turns' own ratios.

No candidate comes twice within a turn, and every turn draws new ones: a processor that meets a
candidate again has learnt its branches and flatters the variant by a third.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

_CALL_SECONDS = 0.02
"""A call at least this long makes the cost of calling invisible."""


@dataclass(frozen=True, eq=False)
class Variant:
    """One way to compute energies.

    Attributes:
        name: unique in its group.
        energies: a batch of candidates, as ``converted`` made them, to its (n,) energies in px.
        converted: poses (n, D) in the form that ``energies`` takes; not timed.
        ready: called before each turn; not timed.
        comparable: whether its energies mean the same as those of its group's first variant.
        group: what it is compared within.
    """

    name: str
    energies: Callable[[np.ndarray], np.ndarray]
    converted: Callable[[np.ndarray], np.ndarray] = np.ascontiguousarray
    ready: Callable[[], object] = tuple
    comparable: bool = True
    group: str = ""


@dataclass(frozen=True)
class Turns:
    """How thoroughly to measure.

    Attributes:
        count: of turns.
        seconds: that a variant runs in each.
        poses: candidates of a turn; a variant that is through with them stops early.
        largest_batch: candidates in one call at most.
    """

    count: int = 5
    seconds: float = 0.12
    poses: int = 16384
    largest_batch: int = 1024


@dataclass(frozen=True, eq=False)
class Rates:
    """What was measured.

    Attributes:
        names: N variants.
        per_turn: (turns, N) evaluations per second.
        batches: N candidates in one call.
        differences: N largest differences in px from the energies of the group's first variant;
            None for those that are not comparable.
        groups: N groups.
    """

    names: tuple[str, ...]
    per_turn: np.ndarray
    batches: tuple[int, ...]
    differences: tuple[int | None, ...]
    groups: tuple[str, ...] = ()

    def of(self, group: str) -> "Rates":
        """Those of one group."""
        kept = [k for k, own in enumerate(self.groups) if own == group]
        return Rates(
            names=tuple(self.names[k] for k in kept),
            per_turn=self.per_turn[:, kept],
            batches=tuple(self.batches[k] for k in kept),
            differences=tuple(self.differences[k] for k in kept),
            groups=tuple(group for _ in kept),
        )

    @property
    def medians(self) -> dict[str, float]:
        """Evaluations per second by name."""
        return dict(zip(self.names, np.median(self.per_turn, axis=0).tolist(), strict=True))

    @property
    def fastest(self) -> dict[str, float]:
        """Evaluations per second of each variant's best turn, the one least disturbed, by name."""
        return dict(zip(self.names, self.per_turn.max(axis=0).tolist(), strict=True))

    def ratio(self, name: str, base: str) -> float | None:
        """How many times as fast ``name`` is as ``base``; None where one was not measured."""
        if name not in self.names or base not in self.names:
            return None
        ours, theirs = (self.per_turn[:, self.names.index(n)] for n in (name, base))
        return float(np.median(ours / theirs))

    def best(self, names: Sequence[str]) -> str | None:
        """The fastest of ``names``; None where none was measured."""
        medians = self.medians
        return max((n for n in names if n in medians), key=medians.__getitem__, default=None)


def measured(
    variants: Sequence[Variant], candidates: Callable[[int], np.ndarray], turns: Turns
) -> Rates:
    """The rates of ``variants``, all taking turns.

    Args:
        variants: names are unique within a group.
        candidates: the number of a turn to its poses (n, D), all distinct; turn 0 comes before
            the first, to warm up and to find batches that are long enough.
        turns: how thoroughly.
    """
    trial = candidates(0)
    batches, energies = [], []
    for variant in variants:
        poses = variant.converted(trial)
        variant.ready()
        batches.append(batch_of(variant, poses, turns))
        energies.append(np.asarray(variant.energies(poses[:8])))
    rates = np.zeros((turns.count, len(variants)))
    for turn in range(turns.count):
        poses = candidates(turn + 1)
        for k in order(turn, len(variants)):
            rates[turn, k] = rate_of(variants[k], poses, batches[k], turns.seconds)
    groups = tuple(v.group for v in variants)
    differences = tuple(
        int(np.abs(e - energies[groups.index(v.group)]).max()) if v.comparable else None
        for e, v in zip(energies, variants, strict=True)
    )
    return Rates(tuple(v.name for v in variants), rates, tuple(batches), differences, groups)


def order(turn: int, count: int) -> list[int]:
    """Which of ``count`` variants run when: each turn begins with another."""
    return [(turn + k) % count for k in range(count)]


def batch_of(variant: Variant, poses: np.ndarray, turns: Turns) -> int:
    """Candidates in one call: doubled until calls are long enough."""
    count = 1
    while True:
        begin = time.perf_counter()
        variant.energies(poses[:count])
        if time.perf_counter() - begin > _CALL_SECONDS:
            return count
        if 2 * count > min(turns.largest_batch, len(poses)):
            return count
        count *= 2


def rate_of(variant: Variant, poses: np.ndarray, batch: int, seconds: float) -> float:
    """Evaluations per second of one turn."""
    poses = variant.converted(poses)
    variant.ready()
    begin = time.perf_counter()
    for done in range(batch, len(poses) + 1, batch):
        variant.energies(poses[done - batch : done])
        elapsed = time.perf_counter() - begin
        if elapsed > seconds:
            return done / elapsed
    return len(poses) // batch * batch / (time.perf_counter() - begin)
