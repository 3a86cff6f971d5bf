"""The beginning of a take: its performer's body, and the pose in the first frame that shows it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from .body.body import Body
from .errors import MocapError
from .initialisation.first_pose import FirstFit, initialised
from .initialisation.plausibility import check_first_fit
from .initialisation.sightings import Footage
from .initialisation.unaided import found_unaided
from .progress import Progress
from .rendering.choice import Choice
from .silhouettes.silhouette import Silhouette
from .take.first_look import check_first_look
from .take.performer import pose_request
from .take.take import Take
from .take.views import Views

_MOST_INITIAL_FRAMES = 8
Silhouettes = tuple[Silhouette, ...]
"""One frame's, camera by camera."""


@dataclass(frozen=True, eq=False)
class Beginning:
    """Where a take begins.

    Attributes:
        views: of the take, their pictures reduced as the initial pose allows.
        frames: numbers of the frames that were looked at; the first shows the first pose.
        stamps: (n, V, 2) of the files they were read from.
        seen: what the initial frames show, by number.
        first: the body and the first pose.
        notes: what the user was told.
    """

    views: Views
    frames: Sequence[int]
    stamps: np.ndarray
    seen: Mapping[int, Silhouettes]
    first: FirstFit
    notes: tuple[str, ...]


def take_begun(
    take: Take, body: Body, views: Views, choice: Choice, progress: Progress
) -> Beginning:
    """The first pose of ``take``, and what it was found from.

    Args:
        take: the take.
        body: its performer's, as `take.performer.performer_body` gives it.
        views: its cameras.
        choice: what draws.
        progress: is told what is found.

    Raises:
        MocapError: the take or its footage is at fault, or the performer is not found.
    """
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
    chosen, first = _first_fit(take, body, views, (frames, seen), choice)
    frames = [chosen, *(frame for frame in frames if frame != chosen)]
    for note in first.notes:
        progress.note(note)
    for doubt in first.doubts:
        progress.warn(doubt)
    return Beginning(
        views=views,
        frames=frames,
        stamps=np.stack([stamps[frame] for frame in frames]),
        seen=seen,
        first=first,
        notes=(*choice.notes, *views.notes, *looks, *first.notes, *first.doubts),
    )


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
    body: Body,
    views: Views,
    looked: tuple[Sequence[int], Mapping[int, Silhouettes]],
    choice: Choice,
) -> tuple[int, FirstFit]:
    """The frame that the first pose is of, and that pose.

    ``looked`` at are some frames, and some of what they show is seen already.
    """
    frames, seen = looked
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
