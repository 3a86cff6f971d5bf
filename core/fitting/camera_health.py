"""Which cameras of a tracked take lie, how, when, and what to do about it.

Dead, frozen and badly segmented cameras show in stretches of frames; cameras that are out of step,
calibrated wrongly or moved show in how outlines and contours lie beside each other over the take.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from .camera_stretches import Read, Stretch, Stretches
from .offset_search import Offset
from .scores import metres_at
from .tracking import Fits
from .view_comparison import ViewComparison

_MOST_MOMENTS, _FEWEST_MOMENTS, _EVERY = 24, 8, 4
"""Most and fewest frames that are compared, and of how many one is."""
_SURE = 4.0
"""Standard deviations."""
_LEAST_DELAY, _LEAST_PX, _LEAST_TURN_DEG = 0.3, 0.8, 0.6
_LEAST_SWELLING_PX, _LEAST_SWELLING_M = 1.0, 0.015
_KINDS = {"dead": "dead", "frozen": "frozen", "bad": "bad silhouettes"}
_WHOLE = 0.2
"""Of a frame, by which a delay may be off a whole number of frames."""
_ONE_SIDED = 2.0
"""Times as much too much as too little, or the other way round."""


@dataclass(frozen=True)
class CameraFinding:
    """One way in which a camera lies.

    Attributes:
        camera: its name.
        kind: "dead", "frozen", "bad silhouettes", "delay", "place" or "swelling".
        frames: first and last, inclusive.
        figures: how much, by name: trust and shares, or the `OFFSETS` in px, degrees and frames.
        text: a sentence for the user, with a remedy.
        perhaps: names of cameras one of which may be meant instead.
    """

    camera: str
    kind: str
    frames: tuple[int, int]
    text: str
    figures: dict[str, float] = field(default_factory=dict)
    perhaps: tuple[str, ...] = ()


def camera_findings(evaluator: Evaluator, fits: Fits, read: Read) -> tuple[CameraFinding, ...]:
    """What is wrong with the cameras of ``fits``; nothing where it is not certain.

    Args:
        evaluator: draws the body in the V cameras.
        fits: the tracked frames.
        read: gives the V silhouettes of a frame.
    """
    frames = sorted(fits)
    telling = _Telling(evaluator.cameras, frames)
    stretches = Stretches(evaluator, fits, read)
    found = [telling.silent(stretch) for stretch in stretches.silent_ones()]
    chosen, offsets = _moments(len(frames)), []
    if chosen:
        metres = metres_at(evaluator, fits[frames[len(frames) // 2]].pose)
        comparison = ViewComparison(evaluator, fits, read, chosen, stretches.silent)
        offsets = comparison.offsets(lambda offset: _is_worth_telling(offset, metres))
        found += [telling.offset(offset, chosen) for offset in offsets]
    explained = {view for offset in offsets for view in (offset.view, *offset.rivals)}
    others = [view for view in range(len(evaluator.cameras)) if view not in explained]
    return (*found, *(telling.bad(stretch) for stretch in stretches.bad_ones(others)))


def _moments(frames: int) -> list[int]:
    """Indices of the frames that are compared; none of too few."""
    if frames <= 2 * _FEWEST_MOMENTS:
        return []
    count = min(max(frames // _EVERY, _FEWEST_MOMENTS), _MOST_MOMENTS)
    return np.linspace(1, frames - 2, count).round().astype(int).tolist()


def _is_worth_telling(offset: Offset, metres: np.ndarray) -> bool:
    if offset.deviations < _SURE:
        return False
    if offset.kind == "delay":
        return abs(offset.amounts[0]) >= _LEAST_DELAY
    if offset.kind == "swelling":
        px = abs(offset.amounts[0])
        return px >= _LEAST_SWELLING_PX and px * metres[offset.view] >= _LEAST_SWELLING_M
    right, down, turn = offset.amounts
    return math.hypot(right, down) >= _LEAST_PX or abs(math.degrees(turn)) >= _LEAST_TURN_DEG


class _Telling:
    """Puts into words what is wrong with ``cameras`` in ``frames``."""

    def __init__(self, cameras: Sequence[Camera], frames: Sequence[int]):
        self._cameras, self._frames = cameras, frames

    def silent(self, stretch: Stretch) -> CameraFinding:
        what = {
            "dead": "it shows nobody where the others do; look at its footage and its silhouettes",
            "frozen": "its pictures do not change while the performer moves; "
            "repair its footage, or leave it out",
        }[stretch.kind]
        return self._of_stretch(stretch, f"is {stretch.kind}", what, {})

    def bad(self, stretch: Stretch) -> CameraFinding:
        what = "its silhouettes are not where those of the others are"
        if stretch.surplus > _ONE_SIDED * stretch.missing:
            what = f"it shows {stretch.surplus:.0%} more than the performer, a shadow perhaps"
        elif stretch.missing > _ONE_SIDED * stretch.surplus:
            what = f"it lacks {stretch.missing:.0%} of the performer"
        what += f", and counts for only {stretch.trust:.0%}; look at its silhouettes there"
        figures = {"missing": stretch.missing, "surplus": stretch.surplus}
        return self._of_stretch(stretch, "is segmented badly", what, figures)

    def _of_stretch(
        self, stretch: Stretch, how: str, what: str, figures: dict[str, float]
    ) -> CameraFinding:
        name, frames = self._cameras[stretch.view].name, self._frames
        first, last = frames[stretch.first], frames[stretch.last]
        when = f"in frame {first}" if first == last else f"in frames {first} to {last}"
        text = f"camera {name} {how} {when}: {what}"
        figures = {"trust": stretch.trust, **figures}
        return CameraFinding(name, _KINDS[stretch.kind], (first, last), text, figures)

    def offset(self, offset: Offset, chosen: Sequence[int]) -> CameraFinding:
        camera = self._cameras[offset.view]
        first, last = self._frames[chosen[offset.begin] if offset.begin else 0], self._frames[-1]
        since = f" from about frame {first} on" if offset.begin else ""
        words = {"delay": _out_of_step, "swelling": _swollen, "place": _displaced}
        what, remedy, figures = words[offset.kind](camera, offset.amounts.tolist(), bool(since))
        perhaps = tuple(self._cameras[view].name for view in offset.rivals)
        if perhaps:
            either = " or ".join((camera.name, *perhaps))
            text = f"camera {either} lies{since}; if it is {camera.name}, it {what}: {remedy}"
        else:
            text = f"camera {camera.name} {what}{since}: {remedy}"
        return CameraFinding(camera.name, offset.kind, (first, last), text, figures, perhaps)


Words = tuple[str, str, dict[str, float]]
"""What a camera does, what to do about it, and by how much."""


def _out_of_step(camera: Camera, amounts: list[float], later: bool) -> Words:
    early = amounts[0]
    count = abs(early)
    near = round(count)
    is_whole = near > 0 and abs(count - near) <= _WHOLE
    frames = f"{near if is_whole else round(count, 1)} frame{'s' * (near != 1 or not is_whole)}"
    what = f"runs about {frames} {'early' if early > 0 else 'late'}"
    if later:
        remedy = "frames were dropped or doubled there; repair its footage"
    elif not is_whole:
        remedy = "synchronise the cameras, by a part of a frame"
    elif early > 0:
        remedy = f"cut {frames} from the start of all other footage"
    else:
        remedy = f"cut {frames} from the start of its footage"
    return what, remedy, {"late_frames": -early}


def _swollen(camera: Camera, amounts: list[float], later: bool) -> Words:
    px = amounts[0]
    size = "larger" if px > 0 else "smaller"
    what = f"has silhouettes about {abs(px):.1f} px {size} all round than the others'"
    return what, "look at its silhouettes", {"larger_px": px}


def _displaced(camera: Camera, amounts: list[float], later: bool) -> Words:
    right, down, turn = amounts
    sides = [
        f"{abs(px):.1f} px too far {way}"
        for px, way in (
            (right, "right" if right > 0 else "left"),
            (down, "down" if down > 0 else "up"),
        )
        if abs(px) >= _LEAST_PX / 2
    ]
    rolled = math.degrees(turn)
    turned = math.degrees(math.atan(math.hypot(right, down) / camera.matrix[0, 0]))
    parts = []
    if sides:
        parts.append(f"sees everything {' and '.join(sides)}, as if turned by {turned:.1f}°")
    if abs(rolled) >= _LEAST_TURN_DEG:
        way = "clockwise" if rolled > 0 else "anticlockwise"
        parts.append(f"sees everything rolled {abs(rolled):.1f}° {way}")
    figures = {"right_px": right, "down_px": down, "turned_deg": turned, "rolled_deg": rolled}
    remedy = "it was moved then; calibrate it anew" if later else "calibrate it anew"
    return " and ".join(parts), remedy, figures
