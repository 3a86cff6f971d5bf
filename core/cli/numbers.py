"""Numbers as the commands print them."""

import math


def shown(value: float | None, digits: int = 1) -> str:
    """The number, or a dash where there are too few frames to have it."""
    return "-" if value is None or not math.isfinite(value) else f"{value:.{digits}f}"
