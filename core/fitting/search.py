"""Which tracker searches, and how hard."""

from dataclasses import dataclass

from ..body.body import Body
from ..cameras.camera import Camera
from .contour import ContourTracker
from .hierarchical import SETTINGS, HierarchicalTracker
from .tracker import EvaluatorFactory, Tracker

TRACKERS = ("contour", "hierarchical")


@dataclass(frozen=True)
class Search:
    """How to track.

    Attributes:
        tracker: one of `TRACKERS`.
        setting: of the tracker ``hierarchical``, one of its `SETTINGS`: "robust", or "faithful" to
            the paper.
        fast_motion: of the same, whether limbs may turn far between two frames: wider, finer grids.
    """

    tracker: str = TRACKERS[0]
    setting: str = "robust"
    fast_motion: bool = False

    def made(
        self, body: Body, cameras: tuple[Camera, ...], make_evaluator: EvaluatorFactory
    ) -> Tracker:
        """The tracker of a body in cameras."""
        if self.tracker == "contour":
            return ContourTracker(body, cameras, make_evaluator)
        setting = SETTINGS[self.setting][self.fast_motion]
        return HierarchicalTracker(body, cameras, make_evaluator, setting)
