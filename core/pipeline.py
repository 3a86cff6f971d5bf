"""From a take to a motion and its files: the whole story on one screen."""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

from .beginning import Beginning, take_begun
from .body.rig_file import RigReader
from .files import made_folder
from .fitting.search import Search
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
from .take.performer import performer_body
from .take.take import Take
from .take.views import open_views


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
        read_rig: reads armatures; None where there is no Blender.
    """

    out: Path
    search: Search = field(default_factory=Search)
    evaluator: str | None = None
    frames: tuple[int | None, int | None] = (None, None)
    without: tuple[str, ...] = ()
    resume: bool = False
    shield: Callable[[], AbstractContextManager] = nullcontext
    read_rig: RigReader | None = None

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
        body = performer_body(take.performer, request.read_rig)
        begin = take_begun(take, body, views, choice, progress)
        journal = _begun(request.out, _start(begin, inputs), progress)
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


def _start(begin: Beginning, inputs: Inputs) -> Start:
    return Start(
        inputs=inputs,
        factors=tuple(view.reduction.factor for view in begin.views.views),
        frames=np.array(begin.frames, np.int64),
        stamps=begin.stamps,
        body=begin.first.body,
        pose=begin.first.pose,
        notes=begin.notes,
    )


def _begun(out: Path, start: Start, progress: Progress) -> Journal:
    """A journal in ``out`` without frames; what lies in its place is set aside."""
    if set_aside(out):
        progress.note(
            f"an unfinished fit is set aside in {out / SET_ASIDE}; "
            "--resume would have gone on with it"
        )
    return Journal.begun(out / UNFINISHED, start)
