"""Checked, read-only arrays for frozen dataclasses."""

import numpy as np
from numpy.typing import DTypeLike


def frozen_array(
    values, shape: tuple[int | None, ...], name: str, dtype: DTypeLike = float
) -> np.ndarray:
    """A read-only, contiguous, finite copy of ``values``.

    Args:
        values: anything that numpy makes an array of.
        shape: the expected shape; None stands for any length.
        name: how error messages call it.
        dtype: the wanted element type.

    Raises:
        ValueError: another shape, or a number that is not finite.
    """
    array = np.array(values, dtype=dtype, order="C")
    fits = array.ndim == len(shape) and all(
        want in (None, got) for want, got in zip(shape, array.shape, strict=True)
    )
    if not fits:
        wanted = " x ".join("any" if n is None else str(n) for n in shape)
        raise ValueError(f"expected {name} of shape {wanted}, got {array.shape}")
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        raise ValueError(f"expected finite numbers in {name}, got NaN or infinity")
    array.setflags(write=False)
    return array


def check_indices(values, count: int, name: str) -> None:
    """Checks that all integers in ``values`` index into ``count`` things.

    Raises:
        ValueError: one is negative or too large.
    """
    values = np.asarray(values, dtype=np.int64)
    if values.size and (values.min() < 0 or values.max() >= count):
        raise ValueError(
            f"expected {name} from 0 to {count - 1}, got {values.min()} to {values.max()}"
        )
