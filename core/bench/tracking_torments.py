"""How a tracker comes through a disturbance of some frames: before, during and after it."""

from dataclasses import dataclass

import numpy as np

from ..body.body import POINT_NAMES
from .tracking_runs import Track

LIMBS = {
    f"{side} {limb}": (f"{side}_{middle}", f"{side}_{end}")
    for limb, middle, end in (("arm", "elbow", "wrist"), ("leg", "knee", "ankle"))
    for side in ("left", "right")
}
"""Each limb's two points."""
BACK_MM = 50.0
"""A limb is back where neither of its points is off by so much more than without the torment."""
AFTER, AROUND = 3, 8
_STAYS = 2


@dataclass(frozen=True, eq=False)
class Recovery:
    """What a torment did; errors are means over the 14 points, mm.

    Attributes:
        before: mean over the frames before; NaN without any.
        during: mean over the tormented frames.
        undisturbed: the same frames' mean without the torment.
        after: in the first, second and third frame after; NaN beyond the end.
        worst_limb: whichever is furthest off in these three.
        worst_mm: the larger of its two points' errors.
        course: (n, 2) frames, counted from the last tormented one, and their mean errors: all from
            `AROUND` frames before the torment to `AROUND` frames after it.
        back: number of the frame after the torment from which on every limb is back, for three
            frames at least or to the end; None where that never happens.
    """

    before: float
    during: float
    undisturbed: float
    after: tuple[float, ...]
    worst_limb: str
    worst_mm: float
    course: np.ndarray
    back: int | None


def recovery(track: Track, undisturbed: Track, frames: tuple[int, int]) -> Recovery:
    """How ``track`` came through a torment of ``frames`` (first, last)."""
    numbers = track.motion.frames
    known = undisturbed.errors[np.searchsorted(undisturbed.motion.frames, numbers)]
    during = (numbers >= frames[0]) & (numbers <= frames[1])
    after = np.flatnonzero(numbers > frames[1])
    limbs = limb_errors(track.errors)
    first = limbs[after[:AFTER]]
    worst = np.unravel_index(int(np.argmax(first)), first.shape) if first.size else None
    return Recovery(
        before=_mean(track.errors[numbers < frames[0]]),
        during=_mean(track.errors[during]),
        undisturbed=_mean(known[during]),
        after=tuple(_mean(track.errors[after[k : k + 1]]) for k in range(AFTER)),
        worst_limb="" if worst is None else tuple(LIMBS)[worst[1]],
        worst_mm=float("nan") if worst is None else float(first[worst]),
        course=_course(track, frames),
        back=_back(limbs[after], limb_errors(known)[after] + BACK_MM),
    )


def limb_errors(errors: np.ndarray) -> np.ndarray:
    """(T, 4) of errors (T, 14): the larger one of each limb's two points."""
    columns = [[POINT_NAMES.index(name) for name in names] for names in LIMBS.values()]
    return errors[:, columns].max(axis=2)


def _course(track: Track, frames: tuple[int, int]) -> np.ndarray:
    numbers = track.motion.frames
    near = (numbers >= frames[0] - AROUND) & (numbers <= frames[1] + AROUND)
    means = [_mean(errors) for errors in track.errors[near]]
    return np.column_stack([numbers[near] - frames[1], means])


def _back(errors: np.ndarray, most: np.ndarray) -> int | None:
    """Which row (from 1) of (n, 4) is the first of three without any error too large."""
    whole = np.all(errors <= most, axis=1).tolist()
    for row in range(len(whole)):
        if all(whole[row : row + 1 + _STAYS]):
            return row + 1
    return None


def _mean(errors: np.ndarray) -> float:
    return float(np.nanmean(errors)) if np.isfinite(errors).any() else float("nan")
