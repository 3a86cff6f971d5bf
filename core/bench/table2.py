"""Table 2 of Theobalt et al. 2003: seconds per frame of two sequences, with their settings.

XOR draws the whole body for every candidate, the second row pre-renders what stands still; both
find the same poses. In the third the limbs are searched beside each other, there by four further
computers, here by four threads: the schedule in one thread finds the same poses again.
"""

import time
from collections.abc import Callable
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from ..body.body import Body
from ..body.kinematics import points
from ..cameras.camera import Camera
from ..fitting.hierarchical import SETTINGS, HierarchicalSettings, HierarchicalTracker
from ..fitting.tracker import Past, PoseFit
from ..rendering.native import NativeEvaluator
from .rows import coarse_level, full_level
from .sequences import sequence
from .stage import filmed

PAPER_SECONDS = {
    "xor": {"A": 7.98, "B": 14.1},
    "prerendered": {"A": 3.30, "B": 10.1},
    "shared_out": {"A": 1.16, "B": 1.76},
}
PAPER_EVALUATIONS = {"A": 1156, "B": 2043}
"""Most evaluations per frame that their tables leave room for."""
_WORKERS = 4


@dataclass(frozen=True, eq=False)
class SequenceFits:
    """One row of the table for one sequence of T frames.

    Attributes:
        seconds: (T,) of each fit.
        evaluations: (T,) candidates that were drawn.
        errors: (T, 14) mm from the truth.
        poses: (T, D) found.
    """

    seconds: np.ndarray
    evaluations: np.ndarray
    errors: np.ndarray
    poses: np.ndarray

    def as_dict(self) -> dict:
        """For JSON."""
        return {
            "seconds_per_frame": float(self.seconds.mean()),
            "median_seconds": float(np.median(self.seconds)),
            "evaluations_per_frame": float(self.evaluations.mean()),
            "error_mm": float(self.errors.mean()),
            "p95_error_mm": float(np.percentile(self.errors, 95)),
        }


def ways(name: str) -> dict[str, HierarchicalSettings]:
    """The settings of each row for sequence A or B."""
    faithful = SETTINGS["faithful"][name == "B"]
    return {
        "xor": replace(faithful, prerendered=False),
        "prerendered": faithful,
        "shared_out": replace(faithful, shared_out=True),
    }


def table2(
    body: Body, cameras: tuple[Camera, ...], name: str, frames: int, advance: Callable[[], None]
) -> dict[str, SequenceFits]:
    """All rows for sequence ``name``, fitted frame by frame in turns.

    Args:
        body: that was filmed and is fitted.
        cameras: V of them.
        name: A or B.
        frames: how many to fit, after the first, whose pose is known.
        advance: called after each frame.
    """
    truth = sequence(body, name, frames + 1)
    full = NativeEvaluator(body, cameras, full_level(body))
    with ThreadPoolExecutor(_WORKERS) as executor:
        tracks = {
            way: _Track(body, cameras, s, truth[0], executor) for way, s in ways(name).items()
        }
        for pose in truth[1:]:
            silhouettes = filmed(full, pose)
            for track in tracks.values():
                track.fit(silhouettes)
            advance()
    return {way: track.result(truth[1:]) for way, track in tracks.items()}


class _Track:
    """The fits of one row so far."""

    def __init__(
        self,
        body: Body,
        cameras: tuple[Camera, ...],
        settings: HierarchicalSettings,
        pose: np.ndarray,
        executor: Executor,
    ):
        def evaluator(body: Body, cameras: tuple[Camera, ...]) -> NativeEvaluator:
            return NativeEvaluator(body, cameras, coarse_level(body, cameras))

        chosen = executor if settings.shared_out else None
        self.tracker = HierarchicalTracker(body, cameras, evaluator, settings, chosen)
        self.pose, self.seconds = pose, []
        self.fits: list[PoseFit] = []

    def fit(self, silhouettes) -> None:
        begin = time.perf_counter()
        found = self.tracker.fit(silhouettes, Past.still(self.pose))
        self.seconds.append(time.perf_counter() - begin)
        self.fits.append(found)
        self.pose = found.pose

    def result(self, truth: np.ndarray) -> SequenceFits:
        poses = np.stack([fit.pose for fit in self.fits])
        body = self.tracker.body
        errors = np.linalg.norm(points(body, poses) - points(body, truth), axis=2)
        evaluations = np.array([fit.tally.evaluated for fit in self.fits])
        return SequenceFits(np.array(self.seconds), evaluations, 1000 * errors, poses)
