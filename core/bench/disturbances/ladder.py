"""The noise ladder: every kind of disturbance at three levels, and the torments of a moment.

The levels are ours; of the kinds, calibration and time have levels that are given in advance
(0.1, 0.3 and 1 degree, 2, 5 and 20 mm, half a frame, one and two).
"""

from collections.abc import Sequence
from dataclasses import dataclass

from .edges import BoundaryJitter, Holes, Speckle, Swelling
from .failing_cameras import CalibrationError, DeadCamera, FrozenCamera, Occluder
from .less_footage import EveryKth
from .limbs import SHADOWS, BlobOnHand, FloorShadow, LimbBitten, LimbDropout
from .recording import Disturbance, Only, Recording
from .timing import OutOfStep

LEVELS = 3
Rungs = dict[str, Sequence[tuple[str, tuple[Disturbance, ...]]]]
"""By kind of noise: amount in words and disturbances, level by level."""
_BITE_FRAMES = 5
_SPARED_FRAMES = 4
"""At the end of the take, to see what comes after a torment."""


@dataclass(frozen=True, eq=False)
class Rung:
    """One kind of noise at one level.

    Attributes:
        kind: of noise.
        level: 1 to `LEVELS`.
        amount: in words.
        disturbances: one after the other.
    """

    kind: str
    level: int
    amount: str
    disturbances: tuple[Disturbance, ...]


@dataclass(frozen=True, eq=False)
class Torment:
    """A disturbance of some frames.

    Attributes:
        name: what happens.
        whom: the side or the camera that is hit.
        frames: first and last, inclusive.
        disturbance: limited to these frames.
    """

    name: str
    whom: str
    frames: tuple[int, int]
    disturbance: Disturbance


def noise_ladder(recording: Recording, initial: int) -> list[Rung]:
    """All rungs for ``recording``, whose initial pose is seen until frame ``initial``."""
    count, last = len(recording.cameras), recording.frames[-1]
    third = (last - initial) // 3
    later, middle = (initial + 1, last), (initial + third, initial + 2 * third)
    kinds = {**_pictures(), **_failing_cameras(count, later, middle), **_time_and_place(count)}
    return [
        Rung(kind, level, *rung)
        for kind, rungs in kinds.items()
        for level, rung in enumerate(rungs, start=1)
    ]


def _pictures() -> Rungs:
    """What is wrong with the silhouettes of all cameras."""
    widths, shares = (0.5, 1.0, 2.0), (0.1, 0.2, 0.4)
    return {
        "boundary jitter": [(f"{px} px", (BoundaryJitter(px),)) for px in widths],
        "erosion": [(f"{px} px", (Swelling(-px),)) for px in widths],
        "dilation": [(f"{px} px", (Swelling(px),)) for px in widths],
        "holes": [(f"{n} of 12 cm", (Holes(n),)) for n in (1, 3, 6)],
        "limb dropout": [(f"{c:.0%} of views", (LimbDropout(c),)) for c in shares],
        "floor shadow": [(f"of the {of}", (FloorShadow(of),)) for of in SHADOWS],
        "speckle": [(f"{n} specks", (Speckle(n),)) for n in (3, 10, 30)],
    }


def _failing_cameras(count: int, later: tuple[int, int], middle: tuple[int, int]) -> Rungs:
    """What is wrong with the pictures of some of ``count`` cameras, in the frames given."""
    frozen, one, widths = FrozenCamera(middle[0]), some(count, 1), (0.15, 0.3, 0.6)

    def poles(told: bool) -> Sequence[tuple[str, tuple[Disturbance, ...]]]:
        return [(f"{w} m wide", (Only(Occluder(w, told), None, one),)) for w in widths]

    def failing(what: Disturbance, frames: tuple[int, int]):
        counts = sorted({min(n, count - 1) for n in (1, 2, 3)})
        return [(f"{n} of {count}", (Only(what, frames, some(count, n)),)) for n in counts]

    return {
        "dead cameras": failing(DeadCamera(), later),
        "frozen cameras": failing(frozen, middle),
        "occluder": poles(told=False),
        "occluder in the ignore mask": poles(told=True),
    }


def _time_and_place(count: int) -> Rungs:
    """What is wrong with where the cameras are and when they look."""
    one = some(count, 1)

    def shifted(way: int) -> Sequence[tuple[str, tuple[Disturbance, ...]]]:
        # there is no picture between two, so that half a frame is one of every other frame
        half = (Only(OutOfStep(way), None, one), EveryKth(2))
        whole = [
            (f"{n} frame{'s' * (n > 1)}", (Only(OutOfStep(way * n), None, one),)) for n in (1, 2)
        ]
        return [("½ frame, at half the rate", half), *whole]

    return {
        "calibration, angle": [(f"{a}°", (CalibrationError(a),)) for a in (0.1, 0.3, 1.0)],
        "calibration, place": [(f"{s} mm", (CalibrationError(0.0, s),)) for s in (2.0, 5.0, 20.0)],
        "one camera late": shifted(-1),
        "one camera early": shifted(1),
    }


def torments(recording: Recording, place: float, number: int) -> list[Torment]:
    """All torments at ``place``, a share of the take.

    Args:
        recording: what is tormented.
        place: 0 to 1.
        number: chooses the side and the camera, so that not the same are hit at every place.
    """
    frames, count = recording.frames, len(recording.cameras)
    begin = frames[round(place * (len(frames) - 1))]
    side = ("left", "right")[number % 2]
    camera = ((1 + 3 * number) % count,)
    half = tuple(range(number % 2, count, 2))

    def within(length: int) -> tuple[int, int]:
        return begin, max(begin, min(begin + length - 1, frames[-1] - _SPARED_FRAMES))

    bite, second = within(_BITE_FRAMES), within(round(recording.fps))
    arm, blob = LimbBitten(side), BlobOnHand(side)
    before = FrozenCamera(max(begin - 1, frames[0]))
    who = recording.cameras[camera[0]].name
    return [
        Torment("arm bitten off, all views", side, bite, Only(arm, bite)),
        Torment("arm bitten off, half the views", side, bite, Only(arm, bite, half)),
        Torment("blob on the hand", side, bite, Only(blob, bite)),
        Torment("camera dead for 1 s", who, second, Only(DeadCamera(), second, camera)),
        Torment("camera frozen for 1 s", who, second, Only(before, second, camera)),
        Torment("camera a frame late for 1 s", who, second, Only(OutOfStep(-1), second, camera)),
        Torment("occluder, 0.3 m, for 1 s", who, second, Only(Occluder(0.3), second, camera)),
        Torment("every third frame for 1 s", "all", second, EveryKth(3, second)),
    ]  # fmt: skip


def some(count: int, chosen: int) -> tuple[int, ...]:
    """Indices of ``chosen`` of ``count`` cameras, evenly apart; one is left at least."""
    chosen = min(chosen, count - 1)
    return tuple(k * count // chosen for k in range(chosen))
