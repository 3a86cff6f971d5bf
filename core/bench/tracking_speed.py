"""How fast a take is tracked, where the time goes, and what the same work took before.

The baseline is what Theobalt et al. 2003 did, on the machine at hand: Powell's method by scipy,
one energy at a time, and a grid for each limb, with the energy computed by OpenGL as in the paper
(`rendering.opengl.paper`) on a mesh as fine as theirs.

What a fit takes beyond its stages (`tracking_stages`) is for the overlay and the files.
"""

import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from ..errors import MocapError
from ..fitting.hierarchical import FAITHFUL, HierarchicalTracker
from ..fitting.search import Search
from ..pipeline import FitRequest, fit
from ..progress import Progress, Silence
from ..rendering.choice import MakeEvaluator
from ..rendering.native import NativeEvaluator
from ..rendering.opengl.paper import PaperEvaluator
from ..take.take import Take
from .disturbances.recording import Recording
from .energy import named
from .rows import full_level
from .tracking_runs import Track, tracked
from .tracking_stages import KEPT, stage_seconds
from .tracking_takes import Beginning, KnownTake
from .tracking_variants import DEFAULT, HIERARCHICAL, Variant

BASELINE = Variant("2003", partial(HierarchicalTracker, settings=FAITHFUL), second_look=False)


@dataclass(frozen=True)
class SpeedSettings:
    """How much to measure.

    Attributes:
        frames: with the default tracker, from the initial pose on; None for all.
        hierarchical_frames: with the tracker hierarchical.
        baseline_frames: with the baseline.
    """

    frames: int | None = None
    hierarchical_frames: int = 10
    baseline_frames: int = 3

    def steps(self, frames: int) -> int:
        """How many frames are told to the progress where the default tracker has ``frames``."""
        return 4 * frames + self.hierarchical_frames + self.baseline_frames


@dataclass(frozen=True, eq=False)
class SpeedFigures:
    """Of one take, with the default tracker unless said.

    Attributes:
        take: its name.
        cameras: in words.
        frames: that were tracked.
        all_told: seconds per frame of a fit, with all that belongs to it after the first pose.
        busy: processor seconds per frame of the same.
        stages: processor seconds per frame by `STAGES`; together ``busy``.
        threads: seconds per frame of tracking by number of threads.
        same_bits: whether these came to the same poses and scores, bit by bit.
        hierarchical: seconds per frame of the tracker hierarchical.
        baseline: the same of the baseline; None where there is no OpenGL.
        baseline_evaluations: energies per frame, likewise.
        notes: what was left out, and why.
    """

    take: str
    cameras: str
    frames: int
    all_told: float
    busy: float
    stages: dict[str, float]
    threads: dict[int, float]
    same_bits: bool
    hierarchical: float
    baseline: float | None
    baseline_evaluations: float | None
    notes: tuple[str, ...]


def speed_figures(
    known: KnownTake, start: Beginning, settings: SpeedSettings, progress: Progress
) -> SpeedFigures:
    """Measures all of it; what is slow in the middle of the take, where the performer moves.

    Raises:
        MocapError: the take is at fault.
    """
    frames = [frame for frame in known.recording.frames if frame >= start.frame]
    recording = replace(known.recording, frames=tuple(frames[: settings.frames]))
    progress.begin(f"speed of {known.take.name}", settings.steps(len(recording.frames)))
    stages = stage_seconds(known.take, recording, start, progress.advance)
    all_told, busy = _all_told(known.take, recording.frames, progress)
    one, two = (
        tracked(recording, start, DEFAULT, progress.advance, threaded(count)) for count in (1, 2)
    )
    middle = len(recording.frames) // 2
    later = replace(start, pose=one.motion.pose[middle - 1], frame=recording.frames[middle])
    slow = _Slow(recording, later, progress)
    hierarchical = slow.track(HIERARCHICAL, settings.hierarchical_frames)
    baseline, notes = slow.baseline(settings.baseline_frames)
    return SpeedFigures(
        take=known.take.name,
        cameras=f"{len(recording.cameras)} x {named(recording.cameras[0].size)}",
        frames=len(recording.frames),
        all_told=all_told,
        busy=busy,
        stages={**stages, KEPT: busy - sum(stages.values())},
        threads={1: one.seconds_per_frame, 2: two.seconds_per_frame},
        same_bits=same_bits(one, two),
        hierarchical=hierarchical.seconds_per_frame,
        baseline=baseline.seconds_per_frame if baseline else None,
        baseline_evaluations=float(baseline.evaluations.mean()) if baseline else None,
        notes=notes,
    )


def same_bits(one: Track, other: Track) -> bool:
    """Whether two tracks of the same frames came to the same, to the last bit."""
    kept = ("pose", "points", "xor_px", "iou", "limb_residual", "confidence", "lost")
    return all(
        getattr(one.motion, name).tobytes() == getattr(other.motion, name).tobytes()
        for name in kept
    )


def threaded(count: int) -> MakeEvaluator:
    """Native evaluators with ``count`` threads."""

    def make(body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
        return NativeEvaluator(body, cameras, level, threads=count)

    return make


class _Slow:
    """Trackers that take long, on some frames from a known pose on."""

    def __init__(self, recording: Recording, start: Beginning, progress: Progress):
        self._recording, self._start, self._progress = recording, start, progress

    def track(
        self, variant: Variant, count: int, make_evaluator: MakeEvaluator | None = None
    ) -> Track:
        later = [frame for frame in self._recording.frames if frame >= self._start.frame]
        recording = replace(self._recording, frames=tuple(later[:count]))
        return tracked(recording, self._start, variant, self._progress.advance, make_evaluator)

    def baseline(self, count: int) -> tuple[Track | None, tuple[str, ...]]:
        """The baseline's track and notes."""
        try:
            return self.track(BASELINE, count, _paper), ()
        except MocapError as error:
            note = f"no baseline by OpenGL as in the paper: {error}"
            self._progress.note(note)
            return None, (note,)


def _paper(body: Body, cameras: tuple[Camera, ...], level: int = 0) -> Evaluator:
    return PaperEvaluator(body, cameras, full_level(body))


class _Clock(Silence):
    """Notes when the first pose is over; the frames of the fit are told to ``progress``."""

    def __init__(self, progress: Progress):
        self._progress, self._task = progress, ""
        self.begun = self._now()

    def begin(self, task: str, total: int) -> None:
        self._task = task
        if task == "fit":
            self.begun = self._now()

    def advance(self, frame: int | None, figures=None) -> None:
        if self._task == "fit":
            self._progress.advance(frame)

    @property
    def since(self) -> tuple[float, float]:
        """Seconds, and processor seconds."""
        now = self._now()
        return now[0] - self.begun[0], now[1] - self.begun[1]

    @staticmethod
    def _now() -> tuple[float, float]:
        return time.perf_counter(), time.process_time()


def _all_told(take: Take, frames: Sequence[int], progress: Progress) -> tuple[float, float]:
    """Seconds and processor seconds per frame of a whole fit after its first pose."""
    clock = _Clock(progress)
    with tempfile.TemporaryDirectory(prefix="bench_") as scratch:
        request = FitRequest(
            Path(scratch) / "out", Search(DEFAULT.name), frames=(frames[0], frames[-1])
        )
        fit(take, request, clock)
        seconds, busy = clock.since
    return seconds / len(frames), busy / len(frames)
