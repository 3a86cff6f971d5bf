"""Tables of a TOML file, read key by key so that every fault names its file, key and remedy."""

import difflib
import math
from collections.abc import Collection
from dataclasses import fields
from pathlib import Path
from typing import Any, NoReturn, TypeVar, overload

from ..errors import MocapError

_LONGEST_SHOWN = 200
Settings = TypeVar("Settings")
_LAST_FRAME = 10**9
_TYPES = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}


class Table:
    """One table of a TOML file.

    Args:
        values: the table as tomllib gives it.
        file: the file it comes from, for messages.
        path: where in the file it stands, such as ``footage``; empty at the top.
    """

    def __init__(self, values: dict[str, Any], file: Path, path: str = ""):
        self.values = values
        self.file = file
        self.path = path

    def key(self, name: str) -> str:
        """The dotted name of a key of this table."""
        return f"{self.path}.{name}" if self.path else name

    def fault(self, problem: str, remedy: str | None = None) -> NoReturn:
        """Raises MocapError about this file."""
        raise MocapError(problem, remedy, file=self.file)

    def allow(self, *known: str) -> None:
        """Refuses keys other than ``known``, naming the nearest one."""
        for name in self.values:
            if name not in known:
                near = difflib.get_close_matches(name.lower(), known, n=1, cutoff=0.0)[0]
                place = f" in [{self.path}]" if self.path else ""
                self.fault(f'unknown key "{name}"{place}', f'did you mean "{near}"?')

    def refuse(self, name: str, instead: str) -> None:
        """Refuses a documented key whose function is not there yet."""
        if name in self.values:
            self.fault(f'"{self.key(name)}" is not supported yet', instead)

    def _wrong(self, name: str, expected: str) -> NoReturn:
        self.fault(f'expected {expected} for "{self.key(name)}", got {_shown(self.values[name])}')

    def required(self, name: str) -> None:
        """Refuses the table where ``name`` is missing."""
        if name not in self.values:
            self.fault(f'"{self.key(name)}" is missing', "add it to the take")

    def table(self, name: str) -> "Table":
        """The sub-table, empty where there is none."""
        value = self.values.get(name, {})
        if not isinstance(value, dict):
            self._wrong(name, "a table")
        return Table(value, self.file, self.key(name))

    def text(self, name: str) -> str | None:
        """A text that is not empty, or None."""
        value = self.values.get(name)
        if value is None:
            return None
        if not isinstance(value, str) or not value.strip():
            self._wrong(name, "a text")
        return value

    @overload
    def choice(self, name: str, known: Collection[str], default: str) -> str: ...
    @overload
    def choice(self, name: str, known: Collection[str]) -> str | None: ...
    def choice(self, name: str, known: Collection[str], default: str | None = None) -> str | None:
        """One of the ``known`` words."""
        value = self.text(name)
        if value is None:
            return default
        if value not in known:
            self._wrong(name, "one of " + ", ".join(known))
        return value

    def number(
        self, name: str, lowest: float = -math.inf, highest: float = math.inf
    ) -> float | None:
        """A finite number from ``lowest`` to ``highest``, inclusive, or None."""
        value = self.values.get(name)
        if value is None:
            return None
        bounds = f" from {lowest:g} to {highest:g}" if math.isfinite(lowest) else ""
        if not _is_number(value) or not lowest <= value <= highest:
            self._wrong(name, f"a number{bounds}")
        return float(value)

    def numbers(self, name: str, count: int, kind: type = float) -> tuple | None:
        """``count`` numbers of ``kind`` (int or float), or None."""
        value = self.values.get(name)
        if value is None:
            return None
        right = isinstance(value, list) and len(value) == count
        if not right or not all(type(v) is int if kind is int else _is_number(v) for v in value):
            self._wrong(name, f"a list of {count} {'whole ' if kind is int else ''}numbers")
        return tuple(kind(v) for v in value)

    def frames(self, name: str) -> tuple[int, int] | None:
        """First and last frame, inclusive, or None."""
        value = self.numbers(name, 2, int)
        if value is not None and not 0 <= value[0] <= value[1] <= _LAST_FRAME:
            self._wrong(name, f"[first, last] with 0 <= first <= last <= {_LAST_FRAME}")
        return value

    def flag(self, name: str) -> bool:
        """True or false; false where it is not given."""
        value = self.values.get(name, False)
        if type(value) is not bool:
            self._wrong(name, "true or false")
        return value

    def words(self, name: str, known: Collection[str]) -> tuple[str, ...]:
        """A list of ``known`` words, each once, in the order given."""
        value = self.values.get(name, [])
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            self._wrong(name, "a list of texts")
        for word in value:
            if word not in known:
                self.fault(
                    f'"{word}" in "{self.key(name)}" is not supported',
                    "choose from " + ", ".join(known),
                )
        return tuple(dict.fromkeys(value))

    def settings(self, kind: type[Settings]) -> Settings:
        """A frozen dataclass of numbers and flags, filled by this table.

        Its own checks, which raise ValueError, are reported as faults of this table.
        """
        defaults = {field.name: field.default for field in fields(kind)}  # type: ignore[arg-type]
        self.allow(*defaults)
        for name, value in self.values.items():
            wanted = type(defaults[name])
            if not (type(value) is bool if wanted is bool else _is_number(value)):
                self._wrong(name, _TYPES[wanted])
        try:
            return kind(**self.values)
        except ValueError as error:
            self.fault(f"[{self.path}]: {error}")


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value)


def _shown(value: object) -> str:
    if isinstance(value, dict):
        return "a table"
    kind = _TYPES.get(type(value), "a list" if isinstance(value, list) else type(value).__name__)
    text = repr(value)
    return f"{kind} ({text if len(text) <= _LONGEST_SHOWN else text[:_LONGEST_SHOWN] + '…'})"
