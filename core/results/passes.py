"""The passes of a fit over its frames, each frame kept as soon as it is found.

From the initial pose on, then what comes before it; then a second look, from the other end, at what
these leave in doubt, and at what leads to a locked pose.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..ahead import Behind, made_ahead
from ..fitting.camera_health import CameraFinding, camera_findings
from ..fitting.search import Search
from ..fitting.second_look import Course, looked_again
from ..fitting.tracking import FrameFit, History, track
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
        self.progress, self.fps = progress, float(outcome.take.fps)
        start, (first, last) = self.journal.start, self.views.frames
        make_evaluator = with_level_for(start.pose, self.choice)
        self.tracker = search.made(start.body, self.views.cameras, make_evaluator)
        self.locks = read_locks(outcome.take.locks, start.body, self.views.frames)
        origin = int(start.frames[0])
        self.directions = range(origin, last + 1), range(origin - 1, first - 1, -1)
        self.seen: dict[int, _Seen] = {}

    def first(self) -> None:
        """From the initial pose on and back, after the frames that are in the journal."""
        total = sum(map(len, self.directions))
        self.journal.keep_first(total)
        finished = {fit.frame: fit for fit in self.journal.fits()}
        self.progress.begin("fit", total - len(finished))
        for frames in self.directions:
            history = History(self.journal.start.body, self.journal.start.pose)
            for fit in (finished[frame] for frame in frames if frame in finished):
                history.add(fit.pose, fit.scores.lumps, fit.locked)
            left = [frame for frame in frames if frame not in finished]
            self._keep(
                track(self.tracker, history, made_ahead(self._read_and_hold(left)), self.locks)
            )

    def second(self) -> None:
        """What the first passes leave in doubt, once more from the other end."""
        found = {fit.frame: fit for fit in self.journal.fits()}
        courses = [
            Course([found[frame] for frame in frames], self.fps)
            for frames in self.directions
            if len(frames)
        ]
        self.progress.begin("second look", sum(len(course.stretches()) for course in courses))
        for course in courses:
            for changed in looked_again(self.tracker, course, self._read):
                self._keep(changed, tell=False)
                self.progress.advance(None)

    def cameras(self) -> tuple[CameraFinding, ...]:
        """What is wrong with the cameras, by all fits."""
        self.progress.begin("cameras", 1)
        evaluator, fits = self.tracker.evaluator, self.journal.fits()
        found = camera_findings(evaluator, fits, self.views.silhouettes)
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
