"""Values as JSON knows them."""

import math


def plain(value):
    """``value`` in dicts, lists, texts and numbers; None for numbers that are not finite.

    Numbers of numpy's become Python's, fractions are rounded to six digits.
    """
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else None
    return value
