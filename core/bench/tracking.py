"""The benchmark of tracking: how well and how fast the trackers hold on.

Every track of a take begins with the same initial pose, found in the undisturbed take; only where
the cameras are others, fewer or moved, it is found anew with these.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import MocapError
from ..progress import Progress
from .machine import machine
from .rows import opengl_renderer
from .tracking_runs import tracked
from .tracking_speed import SpeedFigures, SpeedSettings, speed_figures
from .tracking_takes import SAMPLE, Beginning, KnownTake, beginning, known_take
from .tracking_trials import Result, Trial, TrialSettings, trials_of


@dataclass(frozen=True)
class TrackingSettings:
    """How much to measure.

    Attributes:
        takes: take.toml files with a truth.npz beside each; speed is measured with the first.
        trials: what is tried with each take.
        speed: how long speed is measured.
    """

    takes: tuple[Path, ...] = (SAMPLE,)
    trials: TrialSettings = field(default_factory=TrialSettings)
    speed: SpeedSettings = field(default_factory=SpeedSettings)

    def __post_init__(self):
        if not self.takes:
            raise ValueError("expected at least one take")


QUICK = TrackingSettings(
    trials=TrialSettings(
        frames=24, places=(0.5,), levels=(2,), camera_counts=(2, 4), steps=(1, 2), baselines=False
    ),
    speed=SpeedSettings(frames=24, hierarchical_frames=1, baseline_frames=1),
)


@dataclass(frozen=True, eq=False)
class TrackingFigures:
    """Everything that was measured.

    Attributes:
        machine: what on.
        results: of all trials, take by take.
        speed: of the first take.
    """

    machine: dict
    results: tuple[Result, ...]
    speed: SpeedFigures


def tracking_figures(settings: TrackingSettings, progress: Progress) -> TrackingFigures:
    """Measures all of it.

    Raises:
        MocapError: a take is at fault, has no known motion, or its performer cannot be found.
    """
    facts = machine(opengl_renderer())
    takes = [known_take(path, settings.trials.frames, progress) for path in settings.takes]
    results: list[Result] = []
    speed: SpeedFigures | None = None
    for known in takes:
        start = _found(known, progress)
        if speed is None:
            speed = speed_figures(known, start, settings.speed, progress)
        results += take_results(known, start, list(trials_of(known, settings.trials)), progress)
    assert speed is not None
    return TrackingFigures(facts, tuple(results), speed)


def take_results(
    known: KnownTake, start: Beginning, trials: Sequence[Trial], progress: Progress
) -> list[Result]:
    """What becomes of all trials of a take, told frame by frame."""
    progress.begin(f"track {known.take.name}", sum(len(t.recording.frames) for t in trials))
    return [_result(known, trial, start, progress) for trial in trials]


def _found(known: KnownTake, progress: Progress) -> Beginning:
    progress.begin(f"find {known.take.name}", 1)
    start = beginning(known.take, known.recording)
    progress.advance(None)
    return start


def _result(known: KnownTake, trial: Trial, start: Beginning, progress: Progress) -> Result:
    try:
        if trial.recording.cameras != known.recording.cameras:
            start = beginning(known.take, trial.recording)
        track = tracked(trial.recording, start, trial.variant, progress.advance)
    except MocapError as error:
        fault = f"{trial.take}, {trial.name} {trial.amount}: {error}"
        progress.note(fault)
        for frame in trial.recording.frames:
            progress.advance(frame)
        return Result(trial, None, fault)
    return Result(trial, track)
