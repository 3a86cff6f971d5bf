"""Numbers as people read them."""

import math
from collections.abc import Sequence

UNKNOWN = "–"


def decimal(value: float | None, digits: int = 2) -> str:
    """A number with a fixed count of decimals; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return UNKNOWN
    return f"{value:,.{digits}f}".replace(",", "\u202f").replace("-", "−")


def whole(value: float | None) -> str:
    """A rounded number, thousands apart."""
    return decimal(value, 0)


def counted(count: int, noun: str) -> str:
    """``1 frame``, ``2 frames``."""
    return f"{whole(count)} {noun}" + "s" * (count != 1)


def duration(seconds: float | None) -> str:
    """``0.4 s``, ``12 s``, ``3 min 20 s``, ``25 min``, ``2 h 5 min``."""
    if seconds is None or not math.isfinite(seconds):
        return UNKNOWN
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    if seconds < 59.5:
        return f"{seconds:.0f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 10:
        return f"{minutes} min {rest} s"
    hours, minutes = divmod(round(seconds / 60), 60)
    if not hours:
        return f"{minutes} min"
    return f"{hours} h {minutes} min"


def data_size(count: float | None) -> str:
    """``640 KB``, ``1.2 MB``: bytes in powers of 1000."""
    if count is None or not math.isfinite(count):
        return UNKNOWN
    units = ("bytes", "KB", "MB", "GB")
    power = 0
    while count >= 999.5 and power < len(units) - 1:
        count /= 1000
        power += 1
    digits = 1 if power > 1 and count < 99.5 else 0
    return f"{count:.{digits}f} {units[power]}"


def listed(names: Sequence[str]) -> str:
    """``a, b and c``."""
    if len(names) < 2:
        return "".join(names)
    return f"{', '.join(names[:-1])} and {names[-1]}"


def spans(numbers: Sequence[int]) -> list[str]:
    """``3 to 5`` and ``9`` of rising numbers 3, 4, 5, 9."""
    found: list[list[int]] = []
    for number in numbers:
        if found and number == found[-1][-1] + 1:
            found[-1] = [found[-1][0], number]
        else:
            found.append([number])
    return [" to ".join(map(str, span)) for span in found]
