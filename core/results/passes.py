"""The passes of a fit over its frames, each frame kept in the journal as soon as it is found."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..ahead import Behind
from ..fitting.camera_health import CameraFinding, camera_findings
from ..fitting.passes import Passes, directions_from
from ..fitting.search import Search
from ..fitting.tracking import FrameFit
from ..motion.locks import read_locks
from ..motion.overlay import Tile, overlay_picture
from ..progress import FrameFigures, Progress
from ..rendering.detail import with_level_for
from ..silhouettes.silhouette import Silhouette
from .writing import Outcome

Silhouettes = tuple[Silhouette, ...]
"""One frame's, camera by camera."""


class _Seen(NamedTuple):
    """One frame's stamps (V, 2), silhouettes and pictures."""

    stamps: np.ndarray
    silhouettes: Silhouettes
    pictures: tuple[np.ndarray, ...]


def tracked(outcome: Outcome, search: Search, progress: Progress) -> tuple[CameraFinding, ...]:
    """Puts into the journal of ``outcome`` what is not in it yet.

    Returns:
        What is wrong with the cameras.

    Raises:
        MocapError: footage or locked poses at fault.
    """
    passes = _Passes(outcome, search, progress)
    passes.first()
    passes.second()
    return passes.cameras()


class _Passes:
    """The passes of one fit."""

    def __init__(self, outcome: Outcome, search: Search, progress: Progress):
        self.views, self.journal, self.choice = outcome.views, outcome.journal, outcome.choice
        self.progress = progress
        start, (first, last) = self.journal.start, self.views.frames
        make_evaluator = with_level_for(start.pose, self.choice)
        self.tracker = search.made(start.body, self.views.cameras, make_evaluator)
        self.locks = read_locks(outcome.take.locks, start.body, self.views.frames)
        directions = directions_from(int(start.frames[0]), range(first, last + 1))
        fps = float(outcome.take.fps)
        self.passes = Passes(self.tracker, start.pose, directions, self.journal, fps)
        self.seen: dict[int, _Seen] = {}

    def first(self) -> None:
        """From the initial pose on and back, after the frames that are in the journal."""
        total = sum(map(len, self.passes.directions))
        self.journal.keep_first(total)
        self.progress.begin("fit", total - len(self.journal))
        for fits in self.passes.first(self._read_and_hold, self.locks):
            self._keep(fits)

    def second(self) -> None:
        """What the first passes leave in doubt, once more from the other end."""
        stretches = sum(len(course.stretches()) for course in self.passes.courses)
        self.progress.begin("second look", stretches)
        for changed in self.passes.second(self._read):
            self._keep(changed, tell=False)
            self.progress.advance(None)

    def cameras(self) -> tuple[CameraFinding, ...]:
        """What is wrong with the cameras, by all fits."""
        self.progress.begin("cameras", 1)
        found = camera_findings(self.tracker.evaluator, self.journal, self.views.silhouettes)
        self.progress.advance(None)
        return found

    def _read(self, frames: Iterable[int]) -> Iterator[tuple[int, Silhouettes]]:
        """Numbers and silhouettes of ``frames``."""
        for frame in frames:
            yield frame, self.views.silhouettes(frame)

    def _read_and_hold(self, frames: Iterable[int]) -> Iterator[tuple[int, Silhouettes]]:
        """The same, contours found, held until the frame is kept: a video has but one reader."""
        for frame in frames:
            seen = self.seen[frame] = self._look(frame)
            for silhouette in seen.silhouettes:
                _ = silhouette.contour
            yield frame, seen.silhouettes

    def _look(self, frame: int) -> _Seen:
        stamps, silhouettes = self.views.stamps(frame), self.views.silhouettes(frame)
        return _Seen(stamps, silhouettes, self.views.pictures(frame))

    def _keep(self, fits: Iterable[FrameFit], tell: bool = True) -> None:
        """Puts ``fits`` into the journal while the next is found, and tells of those kept."""
        kept = None
        with Behind() as behind:
            for fit in fits:
                rendered = self.tracker.evaluator.silhouettes(fit.pose)
                behind.call(self._add, fit, rendered, self.choice.name)
                if kept is not None and tell:
                    self.progress.advance(kept.frame, self._figures(kept))
                kept = fit
        if kept is not None and tell:
            self.progress.advance(kept.frame, self._figures(kept))
        self.seen.clear()

    def _add(self, fit: FrameFit, rendered: Sequence[np.ndarray], evaluator: str) -> None:
        seen = self.seen.pop(fit.frame, None) or self._look(fit.frame)
        labels = [
            f"{camera.name}  IoU {iou:.2f}"
            for camera, iou in zip(self.views.cameras, fit.scores.iou, strict=True)
        ]
        tiles = map(Tile, labels, seen.pictures, seen.silhouettes, rendered)
        picture = overlay_picture(tuple(tiles), f"frame {fit.frame}")
        self.journal.add(fit, seen.stamps, picture, evaluator)

    def _figures(self, fit: FrameFit) -> FrameFigures:
        names, scores = [camera.name for camera in self.views.cameras], fit.scores
        return FrameFigures(
            seconds=fit.seconds,
            evaluations=fit.tally.evaluated,
            iou=dict(zip(names, scores.iou.tolist(), strict=True)),
            xor_px=dict(zip(names, scores.xor_px.tolist(), strict=True)),
            lost=scores.lost,
        )
