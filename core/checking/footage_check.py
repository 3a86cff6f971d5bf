"""Footage looked at before a fit: every file's presence, and as many pictures as time allows.

The first pictures become silhouettes just as in a fit, so that faults show and the time is known;
the others are decoded only. Files of a sequence are taken from coarse to fine, first and last one
first; a video only runs forwards.
"""

import time
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from ..errors import MocapError
from ..footage.video import Video
from ..silhouettes.masks import ReadyMasks
from ..silhouettes.silhouette import Silhouette
from ..take.views import View, Views

_EXTRACTING_SHARE = 0.6


@dataclass(frozen=True, eq=False)
class FootageFacts:
    """The footage of one camera.

    Attributes:
        camera: the camera's name.
        place: path or pattern.
        is_video: one file for all frames.
        is_masks: it shows silhouettes, not the scene.
        there: first and last frame that exist, inclusive; a video's end as its head states it.
        count: how many exist.
        size: (width, height) in px.
        fps: frames per second, where the file says so.
        lossy: whether it was compressed with loss.
        wanted: frames of the take.
        looked_at: of those, pictures that were decoded.
        extracted: of those, pictures that were made silhouettes.
        empty: of those, silhouettes without a pixel.
        coverage: mean share of the picture that is silhouette; NaN where none was read.
        picture: (H, W, 3) uint8 BGR, the first at the working size; None where it cannot be read.
        silhouette: that picture's.
    """

    camera: str
    place: str
    is_video: bool
    is_masks: bool
    there: tuple[int, int]
    count: int
    size: tuple[int, int]
    fps: float | None
    lossy: bool
    wanted: int
    looked_at: int
    extracted: int
    empty: int
    coverage: float
    picture: np.ndarray | None
    silhouette: Silhouette | None


@dataclass(frozen=True, eq=False)
class FootageCheck:
    """The footage of all cameras.

    Attributes:
        cameras: in the order of the views.
        faults: of each camera the first missing frame, and the first picture that is at fault.
        seconds: to read one frame of all cameras, as far as known; else NaN.
    """

    cameras: tuple[FootageFacts, ...]
    faults: tuple[MocapError, ...]
    seconds: float


@dataclass
class _Look:
    """What is found of one camera so far."""

    view: View
    decoded: int = 0
    covers: list[float] = field(default_factory=list)
    faults: list[MocapError] = field(default_factory=list)
    first: tuple[np.ndarray, Silhouette] | None = None

    def extract(self, frame: int) -> None:
        silhouette = self.view.silhouette(frame)
        if self.first is None:
            self.first = (self.view.picture(frame), silhouette)
        self.covers.append(float(silhouette.foreground.mean()))

    def decode(self, frame: int) -> None:
        self.view.source.footage.picture(frame)


def checked_footage(views: Views, seconds: float) -> FootageCheck:
    """What the footage of ``views`` holds, found within about ``seconds``.

    At least one picture of each camera is read.
    """
    looks = [_Look(view) for view in views.views]
    orders = [_order(look, views.frames) for look in looks]
    begun = time.monotonic()
    extracting = begun + seconds * _EXTRACTING_SHARE

    def extract(look: _Look, order: Generator[int, None, None]) -> None:
        _go_on(look, order, look.extract, extracting)

    def decode(look: _Look, order: Generator[int, None, None]) -> None:
        _go_on(look, order, look.decode, begun + seconds)

    with ThreadPoolExecutor(len(looks)) as pool:
        list(pool.map(extract, looks, orders))
        spent = time.monotonic() - begun
        list(pool.map(decode, looks, orders))
    extracted = sum(len(look.covers) for look in looks)
    cameras = tuple(_facts(look, views.frames) for look in looks)
    return FootageCheck(
        cameras=cameras,
        faults=tuple(fault for look in looks for fault in look.faults),
        seconds=len(looks) * spent / extracted if extracted else float("nan"),
    )


def _go_on(
    look: _Look, order: Generator[int, None, None], step: Callable[[int], None], deadline: float
) -> None:
    """Takes one step per frame of ``order``, at least one, until a fault or the deadline."""
    for frame in order:
        try:
            step(frame)
        except MocapError as error:
            look.faults.append(error)
            # more often than not, what is left has the same fault
            order.close()
            return
        look.decoded += 1
        if time.monotonic() > deadline:
            return


def _order(look: _Look, frames: tuple[int, int]) -> Generator[int, None, None]:
    """The frames that exist, as they are to be looked at; the first missing one is a fault."""
    footage, wanted = look.view.source.footage, range(frames[0], frames[1] + 1)
    if isinstance(footage, Video):
        yield from wanted
        return
    missing = set(wanted) - set(footage.frames)
    if missing:
        look.faults.extend(_fault_of(look.view, min(missing)))
    for place in coarse_to_fine(len(wanted)):
        if wanted[place] not in missing:
            yield wanted[place]


def _fault_of(view: View, frame: int) -> Iterator[MocapError]:
    try:
        view.source.footage.picture(frame)
    except MocapError as error:
        yield error


def coarse_to_fine(count: int) -> Iterator[int]:
    """Each of 0 to ``count`` - 1 once: first, last, then ever finer between them.

    The order is van der Corput's: the bits of a counter, reversed.
    """
    last = count - 1
    yield from range(min(count, 1))
    if last > 0:
        yield last
    bits = max(last, 0).bit_length()
    for number in range(1, 1 << bits):
        spread = int(f"{number:0{bits}b}"[::-1], 2)
        if spread < last:
            yield spread


def _facts(look: _Look, frames: tuple[int, int]) -> FootageFacts:
    view, footage, covers = look.view, look.view.source.footage, look.covers
    picture, silhouette = look.first or (None, None)
    if isinstance(footage, Video):
        # counting would mean decoding all of it
        count = footage.stated_frames
        there = (0, count - 1)
    else:
        count = len(footage.frames)
        there = (footage.frames[0], footage.frames[-1])
    return FootageFacts(
        camera=footage.camera,
        place=view.place,
        is_video=isinstance(footage, Video),
        is_masks=isinstance(view.source.extractor, ReadyMasks),
        there=there,
        count=count,
        size=footage.size,
        fps=footage.fps,
        lossy=footage.lossy,
        wanted=frames[1] - frames[0] + 1,
        looked_at=look.decoded,
        extracted=len(covers),
        empty=sum(cover == 0 for cover in covers),
        coverage=float(np.mean(covers)) if covers else float("nan"),
        picture=picture,
        silhouette=silhouette,
    )
