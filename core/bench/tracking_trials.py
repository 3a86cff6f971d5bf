"""What is tracked in the benchmark of tracking, trial by trial."""

from collections.abc import Iterator
from dataclasses import dataclass

from .disturbances.ladder import LEVELS, noise_ladder, torments
from .disturbances.less_footage import EveryKth, SomeCameras
from .disturbances.recording import Recording, disturbed
from .tracking_runs import Track
from .tracking_takes import KnownTake, initial_end, spread_views
from .tracking_variants import BASELINES, DEFAULT, Variant, ablations

TAKES, TORMENTS, ABLATION = "takes", "torments", "ablation"
LADDER, CAMERAS, RATES = "noise ladder", "number of cameras", "frame rate"
SECTIONS = (TAKES, TORMENTS, ABLATION, LADDER, CAMERAS, RATES)


@dataclass(frozen=True)
class TrialSettings:
    """How much is tracked of each take.

    Attributes:
        frames: of the take, from its first on; None for all.
        places: of the torments, shares of the take.
        levels: of the noise ladder.
        camera_counts: as far as the take has so many.
        steps: every so many-th frame.
        seed: of all noise.
        baselines: whether other trackers are tried beside the default.
    """

    frames: int | None = None
    places: tuple[float, ...] = (0.4, 0.7)
    levels: tuple[int, ...] = tuple(range(1, LEVELS + 1))
    camera_counts: tuple[int, ...] = (2, 3, 4, 5, 6, 7, 8)
    steps: tuple[int, ...] = (1, 2, 3, 4)
    seed: int = 0
    baselines: bool = True


@dataclass(frozen=True, eq=False)
class Trial:
    """A recording to be tracked.

    Attributes:
        section: one of `SECTIONS`.
        take: its name.
        name: of what is tried, in tables.
        amount: of it, or whom it hits, in words; empty where there is only one.
        level: of it as a number, for plots.
        recording: what is tracked.
        variant: how.
        frames: first and last frame that are tormented; None where none is, or all.
    """

    section: str
    take: str
    name: str
    recording: Recording
    variant: Variant = DEFAULT
    amount: str = ""
    level: float = 0.0
    frames: tuple[int, int] | None = None


@dataclass(frozen=True, eq=False)
class Result:
    """What became of a trial.

    Attributes:
        trial: which.
        track: None where the performer was not found.
        fault: why not; empty elsewhere.
    """

    trial: Trial
    track: Track | None
    fault: str = ""


def trials_of(known: KnownTake, settings: TrialSettings) -> Iterator[Trial]:
    """All trials of a take; the first is the undisturbed take with the default tracker."""
    name, recording = known.take.name, known.recording
    yield Trial(TAKES, name, DEFAULT.name, recording)
    for variant in BASELINES if settings.baselines else ():
        yield Trial(TAKES, name, variant.name, recording, variant)
    for number, place in enumerate(settings.places):
        for torment in torments(recording, place, number):
            tormented = disturbed(recording, settings.seed, torment.disturbance)
            yield Trial(
                TORMENTS, name, torment.name, tormented,
                amount=torment.whom, frames=torment.frames,
            )  # fmt: skip
    for variant in ablations():
        yield Trial(ABLATION, name, variant.name, recording, variant)
    yield from _ladder(known, settings)
    yield from _sweeps(known, settings)


def _ladder(known: KnownTake, settings: TrialSettings) -> Iterator[Trial]:
    for rung in noise_ladder(known.recording, initial_end(known)):
        if rung.level in settings.levels:
            noisy = disturbed(known.recording, settings.seed, *rung.disturbances)
            yield Trial(
                LADDER, known.take.name, rung.kind, noisy,
                amount=rung.amount, level=rung.level,
            )  # fmt: skip


def _sweeps(known: KnownTake, settings: TrialSettings) -> Iterator[Trial]:
    name, recording = known.take.name, known.recording
    for count in settings.camera_counts:
        if count <= len(recording.cameras):
            fewer = disturbed(recording, 0, SomeCameras(spread_views(recording, count)))
            yield Trial(CAMERAS, name, str(count), fewer, level=count)
    for step in settings.steps:
        fps = float(recording.fps / step)
        slower = disturbed(recording, 0, EveryKth(step))
        yield Trial(RATES, name, f"{fps:.3g}", slower, level=fps)
