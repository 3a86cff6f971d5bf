"""Takes with known truth, held in memory, and the poses that their tracks begin with."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import numpy as np

from ..beginning import initial_frames
from ..body.body import Body
from ..errors import MocapError
from ..initialisation.first_pose import initialised
from ..initialisation.sightings import Footage
from ..initialisation.unaided import found_unaided
from ..motion.point_track import PointTrack, read_point_track
from ..progress import Progress
from ..rendering.choice import Choice
from ..silhouettes.silhouette import Silhouette
from ..take.performer import performer_body, pose_request
from ..take.reading import read_take
from ..take.take import Take
from ..take.views import open_views
from .disturbances.recording import Recording

TRUTH = "truth.npz"
SAMPLE = Path(__file__).resolve().parents[2] / "sample_scenes" / "walk" / "take.toml"


@dataclass(frozen=True, eq=False)
class KnownTake:
    """A take whose motion is known.

    Attributes:
        take: as it was read.
        recording: what its cameras saw.
    """

    take: Take
    recording: Recording


@dataclass(frozen=True, eq=False)
class Beginning:
    """Where a track starts.

    Attributes:
        body: at the performer's scale.
        pose: (D,) the initial one.
        frame: that shows it.
    """

    body: Body
    pose: np.ndarray
    frame: int


def known_take(path: Path, most_frames: int | None, progress: Progress) -> KnownTake:
    """The take of a take.toml, its first ``most_frames`` frames, read and reduced as fit does.

    Raises:
        MocapError: the take is at fault, or no truth lies beside it.
    """
    take = read_take(path)
    file = take.path.parent / TRUTH
    if not file.exists():
        raise MocapError(
            "is missing, and the benchmark measures errors against it",
            "give a take with known motion", file=file,
        )  # fmt: skip
    views = open_views(take, progress=progress)
    first, last = views.frames
    last = last if most_frames is None else min(last, first + most_frames - 1)
    views, _ = views.reduced_and_seen(initial_frames(take, (first, last)))
    frames = range(first, last + 1)
    progress.begin(f"read {take.name}", len(frames))
    kept = {}
    for frame in frames:
        kept[frame] = [_Packed(silhouette) for silhouette in views.silhouettes(frame)]
        progress.advance(frame)
    return KnownTake(
        take,
        Recording(
            cameras=views.cameras,
            frames=tuple(frames),
            look=lambda frame, view: kept[frame][view].silhouette(),
            truth=_truth(file, first, last),
            fps=take.fps,
            floor=take.floor,
        ),
    )


def beginning(take: Take, recording: Recording) -> Beginning:
    """The initial pose, found in ``recording`` as fit finds it in the take.

    Raises:
        MocapError: the performer cannot be found.
    """
    whole = (recording.frames[0], recording.frames[-1])
    frames = [f for f in initial_frames(take, whole) if f in recording.frames]
    body = performer_body(take.performer)
    wanted = pose_request(take, body)
    if wanted.kind is None:
        footage = Footage(recording.cameras, recording.silhouettes, whole, float(take.fps))
        chosen, found = found_unaided(body, footage, frames, wanted, native_choice())
        return Beginning(found.body, found.pose, chosen)
    seen = tuple(recording.silhouettes(frame) for frame in frames)
    found = initialised(body, recording.cameras, seen, wanted, native_choice())
    return Beginning(found.body, found.pose, frames[0])


def initial_end(known: KnownTake) -> int:
    """The last frame that shows the initial pose; the first one where the take names none."""
    frames = known.recording.frames
    if known.take.initial_pose.kind is None:
        return frames[0]
    return initial_frames(known.take, (frames[0], frames[-1]))[-1]


def native_choice() -> Choice:
    """What fits draw with where nothing else is asked for; it has no failure to tell of."""
    return Choice(None, lambda note: None)


def truth_of(recording: Recording) -> PointTrack:
    """The truth in the frames of ``recording``, at their mean rate."""
    truth = recording.truth
    kept = np.isin(truth.frames, recording.frames)
    rotations = None if truth.rotations is None else truth.rotations[kept]
    span = recording.frames[-1] - recording.frames[0]
    share = (len(recording.frames) - 1) / span if span else 1.0
    return replace(
        truth,
        frames=truth.frames[kept],
        points=truth.points[kept],
        rotations=rotations,
        fps=float(recording.fps) * share,
    )


def _truth(file: Path, first: int, last: int) -> PointTrack:
    truth = read_point_track(file).between(first, last)
    if not len(truth.frames):
        raise MocapError(
            f"holds no frame from {first} to {last}", "give the truth of this take", file=file
        )
    return truth


class _Packed:
    """A silhouette in an eighth of the memory."""

    def __init__(self, silhouette: Silhouette):
        self._shape = silhouette.foreground.shape
        self._planes = [
            np.packbits(plane) for plane in (silhouette.foreground, silhouette.observed)
        ]

    def silhouette(self) -> Silhouette:
        count = int(np.prod(self._shape))
        foreground, observed = (
            np.unpackbits(plane, count=count).astype(bool).reshape(self._shape)
            for plane in self._planes
        )
        return Silhouette(foreground, observed)


def spread_views(recording: Recording, count: int) -> tuple[int, ...]:
    """Indices of ``count`` cameras that look at the performer from as different sides as can be.

    Cameras that face each other see nearly the same, so that sides are lines, not directions; of
    sets that are alike in this the one with more different directions is taken.
    """
    centre = np.nanmean(recording.truth.points, axis=(0, 1))
    away = np.stack([camera.centre - centre for camera in recording.cameras])
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    cosines = away @ away.T

    def likeness(views: Sequence[int]) -> float:
        pairs = np.array([cosines[a, b] for a, b in combinations(views, 2)])
        return round(float((pairs**2 + 0.1 * pairs).sum()), 9)

    return min(combinations(range(len(away)), count), key=likeness)
