"""What evaluators are given, checked in one place: no mistake of a caller passes in silence."""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from operator import index
from typing import Any

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import WeightMaps

Sizes = tuple[tuple[int, int], ...]
"""(width, height) px of V pictures."""
_INT16 = np.iinfo(np.int16)


def picture_sizes(cameras: Sequence[Camera]) -> Sizes:
    """The sizes of the cameras' pictures; the same object where they are the same."""
    return _one(tuple(camera.size for camera in cameras))


@lru_cache(maxsize=64)
def _one(sizes: Sizes) -> Sizes:
    return sizes


def checked_level(body: Body, level: int) -> int:
    """``level``, refused with a ValueError where the body has no such surface."""
    if not 0 <= level < len(body.surfaces):
        raise ValueError(f"expected a level below {len(body.surfaces)}, got {level}")
    return level


def chosen_segments(body: Body, segments: Iterable[int]) -> tuple[int, ...]:
    """``segments``, refused with a ValueError where one is none of the body's."""
    count, given = len(body.segment_names), tuple(segments)
    try:
        chosen = tuple(map(index, given))
    except TypeError as error:
        raise ValueError(f"expected whole numbers of segments, got {given}") from error
    if any(not 0 <= segment < count for segment in chosen):
        raise ValueError(f"expected segments below {count}, got {chosen}")
    return chosen


def fixed_segments(body: Body, moving: Iterable[int]) -> list[int]:
    """All segments but the ``moving`` ones, in order."""
    return sorted(set(range(len(body.segment_names))) - set(chosen_segments(body, moving)))


def checked_maps(maps: WeightMaps, sizes: Sizes) -> WeightMaps:
    """``maps`` as contiguous int16, constants as a copy in int64.

    Raises:
        ValueError: other shapes than the pictures', or weights that int16 does not hold.
    """
    shapes = [size[::-1] for size in sizes]
    given = [np.asarray(weight_map) for weight_map in maps.maps]
    if [weight_map.shape for weight_map in given] != shapes:
        raise ValueError(f"expected weight maps of shapes {shapes}")
    constants = np.asarray(maps.constants)
    if constants.shape != (len(sizes),) or constants.dtype.kind not in "iu":
        raise ValueError("expected one constant per view, all of them integers")
    for weight_map in given:
        if weight_map.dtype.kind not in "iu":
            raise ValueError(f"expected weights that are integers, got {weight_map.dtype}")
        if weight_map.dtype == np.int16:
            continue
        low, high = weight_map.min(), weight_map.max()
        if low < _INT16.min or high > _INT16.max:
            raise ValueError(f"expected weights of 16 bits, got {low} to {high}")
    narrow = tuple(np.ascontiguousarray(weight_map, np.int16) for weight_map in given)
    return WeightMaps(narrow, constants.astype(np.int64))


def check_weights(weights: Any, kind: type, sizes: Sizes) -> None:
    """Refuses with a ValueError what another kind of evaluator or one of other sizes prepared."""
    if type(weights) is not kind or (weights.sizes is not sizes and weights.sizes != sizes):
        raise ValueError("expected weights prepared for pictures of these sizes by this evaluator")
