"""Ways to track: the default, others to compare with, and the default without one of its parts."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from ..body.body import Body
from ..cameras.camera import Camera
from ..fitting.contour import ContourTracker
from ..fitting.contour_descent import DescentSettings
from ..fitting.contour_search import ContourSettings
from ..fitting.limb_search import LimbSettings
from ..fitting.search import Search
from ..fitting.tracker import EvaluatorFactory, Past, PoseFit, Tally, Tracker

MakeTracker = Callable[[Body, tuple[Camera, ...], EvaluatorFactory], Tracker]


@dataclass(frozen=True, eq=False)
class Variant:
    """A way to track.

    Attributes:
        name: in tables.
        make: the tracker of a body in cameras.
        second_look: whether doubtful stretches are tracked from their other end, too.
    """

    name: str
    make: MakeTracker
    second_look: bool = True


class HoldLast:
    """The tracker that does nothing: every frame's pose is the last one's."""

    def __init__(self, body: Body, cameras: tuple[Camera, ...], make_evaluator: EvaluatorFactory):
        self.evaluator = make_evaluator(body, cameras)

    def fit(self, silhouettes, past: Past) -> PoseFit:
        """The last pose, whatever the silhouettes show."""
        return PoseFit(past.last, 0, Tally())


class _Still(ContourTracker):
    """The default tracker, but that nothing is expected to go on moving."""

    def fit(self, silhouettes, past: Past) -> PoseFit:
        return super().fit(silhouettes, replace(past, predicted=past.last))


class _Unturned(ContourTracker):
    """The default tracker, but that no frame counts as unexplained for long."""

    def fit(self, silhouettes, past: Past) -> PoseFit:
        return super().fit(silhouettes, replace(past, amiss=0))


DEFAULT = Variant("contour", Search("contour").made)
HIERARCHICAL = Variant("hierarchical", Search("hierarchical").made)
HELD = Variant("hold the first pose", HoldLast, second_look=False)
BASELINES = (HIERARCHICAL, HELD)


def ablations() -> tuple[Variant, ...]:
    """The default tracker with one of its parts off at a time, and with all of them off."""
    near = LimbSettings(everywhere=0)
    bare = _contour(limbs=None, views_weighed=False)
    return (
        Variant("no second look", DEFAULT.make, second_look=False),
        Variant("all views count the same", _contour(views_weighed=False)),
        Variant("no limb is sought again", _contour(limbs=None)),
        Variant("limbs are sought near by only", _contour(limbs=near)),
        Variant("the trunk is never turned", _Unturned),
        Variant("no movement is expected to go on", _Still),
        Variant("no rest prior where ends are compared", _contour(prior_share=0.0)),
        Variant("no rest prior in descents", _contour(descent=DescentSettings(rest=0.0))),
        Variant("no normals in descents", _contour(descent=DescentSettings(turn_m=0.0))),
        Variant("descents reach 6 cm from the start", _contour(reaches_m=(0.06, 0.06))),
        Variant("the first four: descents alone", bare, second_look=False),
    )


def _contour(**changes) -> MakeTracker:
    return partial(ContourTracker, settings=ContourSettings(**changes))
