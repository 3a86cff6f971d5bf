"""When feet touch the floor, told from how high and how fast their soles are.

A point of a sole touches the floor while it is neither high nor fast, if at one moment at least it
is low and slow: with two thresholds each, noise does not break a contact into many. They are
heights and speeds, so that the frame rate changes nothing, and wide enough for a body that fits
the performer to a few centimetres.
"""

from dataclasses import dataclass

import numpy as np

LOW_M, HIGH_M = 0.05, 0.08
SLOW, FAST = 0.10, 0.15
"""m/s"""
SPEED_S, SHORTEST_S = 0.03, 0.1
FEET = ("left", "right")


@dataclass(frozen=True)
class Contact:
    """One stretch during which a foot touches the floor.

    Attributes:
        foot: of `FEET`.
        first: its first frame's number.
        last: its last frame's number.
    """

    foot: str
    first: int
    last: int


def touching(places: np.ndarray, floor: float, rate: float) -> np.ndarray:
    """(T, P) bool, which points at places (T, P, 3) touch the floor at the height ``floor``."""
    if len(places) < 2:
        return np.zeros(places.shape[:2], bool)
    height = np.abs(places[..., 2] - floor)
    speed = _speeds(places, rate)
    near = (height < HIGH_M) & (speed < FAST)
    sure = near & (height < LOW_M) & (speed < SLOW)
    fewest = max(2, round(SHORTEST_S * rate))
    found = np.zeros_like(near)
    for point in range(near.shape[1]):
        for run in stretches(near[:, point]):
            if run.stop - run.start >= fewest and sure[run, point].any():
                found[run, point] = True
    return found


def _speeds(places: np.ndarray, rate: float) -> np.ndarray:
    """(T, P) m/s of points at places (T, P, 3), from `SPEED_S` before to as much after."""
    reach = max(1, round(SPEED_S * rate))
    frames = np.arange(len(places))
    before, after = np.maximum(frames - reach, 0), np.minimum(frames + reach, len(places) - 1)
    moved = np.linalg.norm(places[after] - places[before], axis=2)
    return moved * rate / (after - before)[:, None]


def stretches(marked: np.ndarray) -> list[slice]:
    """The runs of ``marked`` (T,) frames."""
    return np.ma.clump_masked(np.ma.masked_array(marked, marked))


def contacts(touched: np.ndarray, feet: np.ndarray, frames: np.ndarray) -> list[Contact]:
    """The contacts of whole feet, by their beginning.

    Args:
        touched: (T, P) which points of soles touch the floor.
        feet: (P,) the foot of each point, an index of `FEET`.
        frames: (T,) frame numbers.
    """
    found = [
        Contact(name, int(frames[run.start]), int(frames[run.stop - 1]))
        for foot, name in enumerate(FEET)
        for run in stretches(touched[:, feet == foot].any(axis=1))
    ]
    return sorted(found, key=lambda contact: (contact.first, contact.foot))


def slides(places: np.ndarray, touched: np.ndarray) -> np.ndarray:
    """(n,) metres that points at places (T, P, 3) slide over the floor while they touch it.

    For each stretch of ``touched`` (T, P), how far from its mean place the point comes.
    """
    found = []
    for point in range(touched.shape[1]):
        for run in stretches(touched[:, point]):
            spots = places[run, point, :2]
            found.append(np.linalg.norm(spots - spots.mean(axis=0), axis=1).max())
    return np.array(found)
