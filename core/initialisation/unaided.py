"""The first pose of a take that names none: a frame that shows one is found.

Some frames all over the take are looked at. In each that shows the whole performer, stances of
somebody who stands are laid all round (`hunt`); the ends of their descents are judged by how likely
they are right: limbs that are apart, and cameras that agree as they do while the performer is
still, make them so. The most likely are fitted completely. Where none of them convinces, all arms
are tried over all legs, from the visual hull instead of the floor. No pose is taken that is not
likely.
"""

import logging
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..body.body import Body
from ..body.kinematics import points
from ..errors import MocapError
from ..fitting.contour import ContourTracker
from ..fitting.recovery import hull_centre
from ..fitting.tracker import EvaluatorFactory
from .first_pose import FirstFit, PoseRequest, measured, of_height, settled
from .hunt import Hunt, all_round, hung, stood
from .pose_kinds import ASKED, STANDING, all_stances, stance
from .sightings import REMEDY, Footage, Sighting, sightings
from .standing import body_centre

_log = logging.getLogger(__name__)
_DESCENTS, _HULL_DESCENTS = 4, 8
_HULL_FRAMES = 4
"""Frames that are sought in from the visual hull."""
_FINALISTS = 2
"""Frames that are fitted completely."""
_CONVINCING = 0.7
"""Mean confidence of a first pose that needs no other."""
LEAST_LIKELY = 0.4
"""Mean confidence below which no pose is taken."""
_LIFTED_M = 0.3
"""Between the lowest point and where it is in somebody who stands, that is too much."""


@dataclass(frozen=True, eq=False)
class _Starts:
    """Poses to begin from.

    Attributes:
        words: what they are.
        poses: (N, D).
        place: puts them where a frame shows the performer.
        descents: how many are gone on with.
    """

    words: str
    poses: np.ndarray
    place: Callable[[Hunt, np.ndarray], np.ndarray]
    descents: int


@dataclass(frozen=True, eq=False)
class _Found:
    """A frame that was fitted completely.

    Attributes:
        frame: its number.
        first: the fit.
        starts: what it was found from.
        likely: mean confidence.
        lift_m: how much higher above the floor the lowest point is than somebody's who stands.
    """

    frame: int
    first: FirstFit
    starts: str
    likely: float
    lift_m: float

    @property
    def rank(self) -> tuple[bool, float]:
        return abs(self.lift_m) < _LIFTED_M, self.likely

    def check(self) -> None:
        """Refuses what is not likely.

        Raises:
            MocapError: it is a bad fit, or stands in the air or below the floor.
        """
        best = f"no initial pose is given, and none was found: the best, in frame {self.frame}, "
        if abs(self.lift_m) >= _LIFTED_M:
            side = "above" if self.lift_m > 0 else "below"
            fault = f"would have its feet {abs(self.lift_m):.2f} m {side} the floor"
            raise MocapError(best + fault, f"check floor under [world], or {REMEDY}")
        if self.likely < LEAST_LIKELY:
            fault = f"has points right within 50 mm with a probability of {self.likely:.0%}"
            raise MocapError(best + fault, REMEDY)

    @property
    def words(self) -> str:
        return (
            f"No initial pose is given: frame {self.frame} was chosen, starting from "
            f"{self.starts}; its points are right within 50 mm with a probability of "
            f"{self.likely:.0%}."
        )


@dataclass(frozen=True, eq=False)
class _Search:
    """What all frames are searched with."""

    tracker: ContourTracker
    footage: Footage
    request: PoseRequest
    make_evaluator: EvaluatorFactory

    def tried(self, seen: Sighting, starts: _Starts) -> Sighting:
        """The sighting with the best end of all descents."""
        hunt = Hunt(self.tracker, self.footage.look(seen.frame))
        pose = hunt.ends(starts.place(hunt, starts.poses), starts.descents)[0].pose
        likely = float(hunt.scores(pose).confidence.mean())
        _log.info("frame %d from %s: %.2f likely", seen.frame, starts.words, likely)
        return replace(seen, likely=likely, pose=pose)

    def best(self, tried: Sequence[Sighting], starts: _Starts) -> _Found:
        """The likeliest of the complete fits of the likeliest frames, which come first."""
        found = [self._settled(seen, starts.words) for seen in tried[:_FINALISTS]]
        return max(found, key=lambda one: one.rank)

    def _settled(self, seen: Sighting, words: str) -> _Found:
        silhouettes = self.footage.look(seen.frame)
        request = replace(self.request, way=partial(self.footage.way, seen.frame))
        hunt = Hunt(self.tracker, silhouettes)
        first, scores = settled(hunt, seen.pose, (silhouettes,), request, self.make_evaluator)
        lowest, usual = (
            points(first.body, pose[None])[0, :, 2].min()
            for pose in (first.pose, first.body.rest_pose)
        )
        lift = float(lowest - usual) - request.floor
        return _Found(seen.frame, first, words, float(scores.confidence.mean()), lift)


def found_unaided(
    template: Body,
    footage: Footage,
    frames: Sequence[int],
    request: PoseRequest,
    make_evaluator: EvaluatorFactory,
) -> tuple[int, FirstFit]:
    """The number of the frame that was chosen of ``frames``, and the body and its pose in it.

    Raises:
        MocapError: no frame shows the whole performer, or none a pose that is likely.
    """
    seen = sightings(footage, frames, request.floor)
    height = request.height_m or float(np.median([sighting.height_m for sighting in seen]))
    body = of_height(template, height)
    tracker = ContourTracker(body, footage.cameras, make_evaluator)
    search = _Search(tracker, footage, request, make_evaluator)
    starts = _standing_starts(template, body, request.floor)
    tried = _likeliest_first(search.tried(one, starts) for one in seen)
    found = search.best(tried, starts)
    if found.likely < _CONVINCING:
        starts = _hull_starts(template, body)
        tried = _likeliest_first(search.tried(one, starts) for one in tried[:_HULL_FRAMES])
        found = max(found, search.best(tried, starts), key=lambda one: one.rank)
    found.check()
    shown = (footage.look(found.frame),)
    first = measured(found.first, footage.cameras, shown, request, make_evaluator)
    return found.frame, first.with_words(found.words, found.likely < _CONVINCING)


def _likeliest_first(tried: Iterable[Sighting]) -> list[Sighting]:
    return sorted(tried, key=lambda seen: -seen.likely)


def _standing_starts(template: Body, body: Body, floor: float) -> _Starts:
    shapes = np.stack([stance(template, arms, STANDING) for arms in ASKED])

    def place(hunt: Hunt, poses: np.ndarray) -> np.ndarray:
        centre = body_centre(hunt.evaluator.cameras, hunt.silhouettes)
        return stood(hunt.body, poses, centre, floor)

    return _Starts("standing poses", all_round(body, shapes), place, _DESCENTS)


def _hull_starts(template: Body, body: Body) -> _Starts:
    shapes = np.stack([stance(template, *names) for names in all_stances()])

    def place(hunt: Hunt, poses: np.ndarray) -> np.ndarray:
        centre = hull_centre(hunt.evaluator.cameras, hunt.silhouettes)
        assert centre is not None
        return hung(hunt.body, poses, centre)

    words = f"{len(shapes)} poses in the visual hull, as standing ones did not convince"
    return _Starts(words, all_round(body, shapes), place, _HULL_DESCENTS)
