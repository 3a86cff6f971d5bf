"""From a take to a motion and its files: the whole story on one screen."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass, field, replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from .errors import MocapError
from .files import made_folder
from .fitting.search import Search
from .initialisation.first_pose import FirstFit, initialised
from .initialisation.plausibility import check_first_fit
from .initialisation.sightings import Footage
from .initialisation.unaided import found_unaided
from .progress import Progress
from .rendering.choice import BEST, Choice
from .rendering.detail import OUTLINE_PX
from .results.fingerprint import Inputs, fit_inputs
from .results.journal import SET_ASIDE, UNFINISHED, Journal, Start, set_aside
from .results.passes import tracked
from .results.writing import (
    MOTION,
    OVERLAY,
    PAGE,
    FitResult,
    Outcome,
    check_spared,
    finished_result,
    resumed,
    with_overlay,
    write_results,
)
from .silhouettes.silhouette import Silhouette
from .take.first_look import check_first_look
from .take.performer import performer_body, pose_request
from .take.take import Take
from .take.views import Views, open_views

_MOST_INITIAL_FRAMES = 8
Silhouettes = tuple[Silhouette, ...]
"""One frame's, camera by camera."""


@dataclass(frozen=True)
class FitRequest:
    """What to fit, and where to write it.

    Attributes:
        out: the folder of the result; made where it is missing.
        search: how to track.
        evaluator: one of `rendering.choice.EVALUATORS`; None for what is best.
        frames: first and last frame, inclusive, that narrow the take's; None leaves an end.
        without: names of cameras to leave out.
        resume: whether to go on with an unfinished fit in ``out``.
        shield: entered while the finished frames are written, so that nothing interrupts it.
    """

    out: Path
    search: Search = field(default_factory=Search)
    evaluator: str | None = None
    frames: tuple[int | None, int | None] = (None, None)
    without: tuple[str, ...] = ()
    resume: bool = False
    shield: Callable[[], AbstractContextManager] = nullcontext

    @property
    def settings(self) -> dict[str, object]:
        """What decides the result, beside the take.

        The evaluator is the one asked for, so that a fit can be resumed whether or not OpenGL
        still works; which of them drew each frame is told by the report.
        """
        drawn = {"evaluator": self.evaluator or BEST, "outline_px": OUTLINE_PX}
        return {**asdict(self.search), **drawn, "without": list(self.without)}


def fit(take: Take, request: FitRequest, progress: Progress) -> FitResult:
    """Tracks ``take`` and writes motion.npz, body.npz, report.json, report.html and overlay.mp4.

    Every finished frame is kept on disk at once: whatever ends the fit, ``request.resume`` goes on
    after the last of them and comes to the same result, bit by bit. When it is interrupted or
    fails, the frames finished so far are written as results, too. Where OpenGL was asked for and
    fails, at first or on the way, the native evaluator goes on with the same frame.

    Raises:
        MocapError: the take, its calibration or its footage is at fault, or the unfinished fit was
            begun with other inputs.
    """
    check_spared(take, request.out)
    views = open_views(take, request.without, request.frames, progress)
    choice = Choice(request.evaluator, progress.warn)
    choice.check(views.cameras, progress.note)
    made_folder(request.out)
    inputs = fit_inputs(take, views, request.settings)
    journal = resumed(request.out, inputs, views) if request.resume else None
    if journal is None and request.resume:
        finished = finished_result(request.out, inputs, views)
        if finished is not None:
            progress.note(f"all frames in {request.out / MOTION} were finished before")
            gone = [name for name in (PAGE, OVERLAY) if not (request.out / name).exists()]
            if gone:
                progress.note(f"{' and '.join(gone)} went since; leave out --resume for new ones")
            return finished
    if journal is None:
        start = _started(take, views, inputs, choice, progress)
        journal = _begun(request.out, start, progress)
    else:
        progress.note(f"{len(journal)} frames were finished before")
    views = views.reduced_by(journal.start.factors)
    outcome = Outcome(take, views, journal, request.settings, choice)

    def save() -> FitResult:
        with request.shield():
            return write_results(outcome, request.out, progress)

    try:
        findings = tracked(outcome, request.search, progress)
        outcome = replace(outcome, complete=True, findings=findings)
        result = save()
    except BaseException:
        if len(outcome.journal):
            save()
        raise
    result = with_overlay(outcome, result, progress)
    journal.remove()
    return result


def _started(take: Take, views: Views, inputs: Inputs, choice: Choice, progress: Progress) -> Start:
    """The first pose, and what it was found from."""
    begin = initial_frames(take, views.frames)
    frames = begin if take.initial_pose.kind else searched_frames(begin)
    # before they are read, as the fit may take longer than a change of theirs
    stamps = {frame: views.stamps(frame) for frame in frames}
    views, seen = views.reduced_and_seen(begin)
    for note in views.notes:
        progress.note(note)
    looks = check_first_look(take, views, seen)
    for note in looks:
        progress.note(note)
    progress.begin("first pose", 1)
    chosen, first = _first_fit(take, views, (frames, seen), choice)
    frames = [chosen, *(frame for frame in frames if frame != chosen)]
    for note in first.notes:
        progress.note(note)
    return Start(
        inputs=inputs,
        factors=tuple(view.reduction.factor for view in views.views),
        frames=np.array(frames, np.int64),
        stamps=np.stack([stamps[frame] for frame in frames]),
        body=first.body,
        pose=first.pose,
        notes=(*choice.notes, *views.notes, *looks, *first.notes),
    )


def _begun(out: Path, start: Start, progress: Progress) -> Journal:
    """A journal in ``out`` without frames; what lies in its place is set aside."""
    if set_aside(out):
        progress.note(
            f"an unfinished fit is set aside in {out / SET_ASIDE}; "
            "--resume would have gone on with it"
        )
    return Journal.begun(out / UNFINISHED, start)


def initial_frames(take: Take, frames: tuple[int, int]) -> tuple[int, ...]:
    """Up to eight of the take's ``frames`` (first, last) that show the initial pose, in order.

    Where the take names none, they lie all over it.

    Raises:
        MocapError: none of them does.
    """
    whole = frames if take.initial_pose.kind is None else (frames[0], frames[0])
    first, last = take.initial_pose.frames or whole
    begin, end = max(first, frames[0]), min(last, frames[1])
    if begin > end:
        raise MocapError(
            f"the initial pose is in frames {first} to {last}, outside {frames[0]} to {frames[1]}",
            "fit frames that hold it", file=take.path,
        )  # fmt: skip
    count = min(end - begin + 1, _MOST_INITIAL_FRAMES)
    return tuple(int(f) for f in np.linspace(begin, end, count).round())


def searched_frames(frames: Sequence[int]) -> Sequence[int]:
    """Rising ``frames`` and those halfway between them, to choose an initial pose from."""
    halfway = ((before + after) // 2 for before, after in pairwise(frames))
    return sorted({*frames, *halfway})


def _first_fit(
    take: Take,
    views: Views,
    looked: tuple[Sequence[int], Mapping[int, Silhouettes]],
    choice: Choice,
) -> tuple[int, FirstFit]:
    """The frame that the first pose is of, and that pose.

    ``looked`` at are some frames, and some of what they show is seen already.
    """
    frames, seen = looked
    body = performer_body(take.performer)
    footage = Footage(
        views.cameras, lambda f: seen.get(f) or views.silhouettes(f), views.frames, float(take.fps)
    )
    try:
        wanted = replace(pose_request(take, body), way=lambda: footage.way(frames[-1]))
        if wanted.kind is None:
            chosen, first = found_unaided(body, footage, frames, wanted, choice)
        else:
            shown = tuple(seen.values())
            chosen, first = frames[0], initialised(body, views.cameras, shown, wanted, choice)
        notes = check_first_fit(first, views.cameras)
    except MocapError as error:
        raise error.about(take.path) from error
    return chosen, replace(first, notes=(*first.notes, *notes))
