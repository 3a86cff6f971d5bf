"""The performer's shape from the initial pose, or from limbs that bend in further frames."""

from dataclasses import dataclass
from itertools import chain

import numpy as np

from ..beginning import Beginning
from ..body.body import Body
from ..fitting.passes import Passes, directions_from, with_contours
from ..fitting.tracking import FrameFit
from ..initialisation.further_frames import most_different
from ..initialisation.own_shape import in_own_shape
from ..initialisation.shape_fit import ShapeFit
from ..progress import Progress
from ..rendering.choice import Choice
from ..rendering.detail import with_level_for
from ..take.performer import known_height
from ..take.take import Take

_FRAMES = 12


@dataclass(frozen=True, eq=False)
class Shown:
    """What frames show of the performer.

    Attributes:
        body: in the shape that explains them best.
        shape: how it was found.
        poses: (F, D) that it was found in.
        notes: sentences on it.
    """

    body: Body
    shape: ShapeFit
    poses: np.ndarray
    notes: tuple[str, ...] = ()


def first_shape(begin: Beginning) -> Shown:
    """The shape that the first pose shows.

    Raises:
        ValueError: none was sought.
    """
    shape = begin.first.shape
    if shape is None:
        raise ValueError("expected a first pose with a shape")
    return Shown(begin.first.body, shape, shape.poses)


def shape_from_track(
    take: Take, begin: Beginning, further: tuple[int, int], choice: Choice, progress: Progress
) -> Shown:
    """The shape that those of the ``further`` frames (first, last) show that differ most.

    They are tracked from the first pose on, with the shape that it shows.

    Raises:
        MocapError: footage at fault.
    """
    fits = _tracked(take, begin, further, choice, progress)
    frames, template = sorted(fits), first_shape(begin).shape.template
    poses = np.stack([fits[frame].pose for frame in frames])
    usable = [not fits[f].scores.lost and further[0] <= f <= further[1] for f in frames]
    origin = [frames.index(begin.frames[0])]
    chosen = most_different(template, poses, np.array(usable), origin, _FRAMES)
    progress.begin("shape", 1)
    own = in_own_shape(
        template,
        begin.views.cameras,
        [begin.views.silhouettes(frames[k]) for k in chosen],
        poses[chosen],
        choice,
        known_height(take.performer, template),
    )
    progress.advance(None)
    note = f"shape from frames {', '.join(str(frames[k]) for k in chosen)}: {own.note}"
    progress.note(note)
    return Shown(own.body, own.fit, poses[chosen], (note,))


def _tracked(
    take: Take, begin: Beginning, further: tuple[int, int], choice: Choice, progress: Progress
) -> dict[int, FrameFit]:
    """The fits of all frames from the first pose to the ``further`` ones."""
    views, first, origin = begin.views, begin.first, begin.frames[0]
    frames = range(min(origin, further[0]), max(origin, further[1]) + 1)
    tracker = take.search.made(first.body, views.cameras, with_level_for(first.pose, choice))
    fits: dict[int, FrameFit] = {}
    directions = directions_from(origin, frames)
    passes = Passes(tracker, first.pose, directions, fits, float(take.fps))
    progress.begin("track", len(frames))
    for fit in chain.from_iterable(passes.first(with_contours(views.silhouettes))):
        fits[fit.frame] = fit
        progress.advance(fit.frame)
    return fits
