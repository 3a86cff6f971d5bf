"""The passes over a take's frames, wherever their fits are kept.

From the initial pose on, then what comes before it; then a second look, from the other end, at
what these leave in doubt, and at what leads to a locked pose. Every fit is handed out as soon as it
is found, and found again among those that are kept: nothing here grows with the take.
"""

from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

import numpy as np

from ..ahead import made_ahead
from ..silhouettes.silhouette import Silhouette
from .second_look import Course, Read, looked_again
from .tracker import Tracker
from .tracking import Fits, FrameFit, History, track


@dataclass(frozen=True, eq=False)
class Passes:
    """The passes of one tracker.

    Attributes:
        tracker: fits each frame.
        pose: (D,) the initial one.
        directions: numbers of the frames as they are tracked from it, see `directions_from`.
        fits: those that are kept; what the passes find is to be put there before more is asked for.
        fps: frames per second.
    """

    tracker: Tracker
    pose: np.ndarray
    directions: tuple[Sequence[int], ...]
    fits: Fits
    fps: float

    def first(
        self, read: Read, locks: Mapping[int, np.ndarray] = MappingProxyType({})
    ) -> Iterator[Iterator[FrameFit]]:
        """The fits of the frames that are not kept yet, direction by direction.

        Args:
            read: yields the number and silhouettes of frames, in another thread.
            locks: poses (D,) that are given, by frame.
        """
        begin = locks.get(self.directions[0][0], self.pose)
        for frames in self.directions:
            history = History(self.tracker.evaluator.body, begin)
            for kept in (self.fits[frame] for frame in frames if frame in self.fits):
                history.add(kept.pose, kept.scores.lumps, kept.locked)
            left = [frame for frame in frames if frame not in self.fits]
            yield track(self.tracker, history, made_ahead(read(left)), locks)

    @cached_property
    def courses(self) -> tuple[Course, ...]:
        """What there is for the second look, once all frames are kept."""
        body = self.tracker.evaluator.body
        return tuple(Course(self.fits, frames, self.fps, body) for frames in self.directions)

    def second(self, read: Read) -> Iterator[list[FrameFit]]:
        """The fits that the second look changes, stretch by stretch of the `courses`."""
        for course in self.courses:
            yield from looked_again(self.tracker, course, read)


def with_contours(look: Callable[[int], tuple[Silhouette, ...]]) -> Read:
    """Reads frames by ``look``, and finds their contours, too."""

    def read(frames: Iterable[int]) -> Iterator[tuple[int, tuple[Silhouette, ...]]]:
        for frame in frames:
            silhouettes = look(frame)
            for silhouette in silhouettes:
                _ = silhouette.contour
            yield frame, silhouettes

    return read


def directions_from(origin: int, frames: Sequence[int]) -> tuple[Sequence[int], ...]:
    """Rising ``frames`` from ``origin`` on, and those before it backwards, where there are any."""
    begin = bisect_left(frames, origin)
    return tuple(part for part in (frames[begin:], frames[:begin][::-1]) if len(part))
