"""An evaluator that may fail, such as OpenGL when its memory is full, and one that then goes on.

Whoever fits knows nothing of it: weights keep how they were made, so that the other evaluator can
make them once more, and the call that failed is repeated there. The two evaluators may differ by
the few pixels on an edge in which OpenGL differs from the native kernel.
"""

from collections.abc import Callable, Sequence
from threading import Lock
from typing import Any, TypeVar

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator, Outline, WeightMaps
from ..errors import MocapError

R = TypeVar("R")


class Failures:
    """Whether the first evaluators have failed: if one has, none of them is used any more.

    Args:
        tell: told of the first failure.
    """

    def __init__(self, tell: Callable[[MocapError], None]):
        self.any = False
        self._tell, self._lock = tell, Lock()

    def add(self, fault: MocapError) -> None:
        """One more."""
        with self._lock:
            first, self.any = not self.any, True
        if first:
            self._tell(fault)


class RemadeWeights:
    """Weights that are made anew where another evaluator takes over.

    Args:
        make: makes them with an evaluator.
        evaluator: the first to hold them.
    """

    def __init__(self, make: Callable[[Evaluator], Any], evaluator: Evaluator):
        self._make = make
        self._held = evaluator, make(evaluator)

    @property
    def constants(self) -> np.ndarray:
        """(V,) int64 constants, fixed parts included."""
        return self._held[1].constants

    def of(self, evaluator: Evaluator) -> Any:
        """The weights in that evaluator's form."""
        owner, weights = self._held
        if owner is not evaluator:
            weights = self._make(evaluator)
            self._held = evaluator, weights
        return weights


class FallbackEvaluator:
    """The first evaluator until it fails, then the second; see `energy.evaluator.Evaluator`.

    Args:
        first: is used as long as it works.
        second: makes the one that goes on.
        failures: shared by all of a fit.
    """

    def __init__(self, first: Evaluator, second: Callable[[], Evaluator], failures: Failures):
        self.body: Body = first.body
        self.cameras: tuple[Camera, ...] = first.cameras
        self._first, self._make_second, self._failures = first, second, failures
        self._second: Evaluator | None = None
        self._lock = Lock()

    def prepared(self, maps: WeightMaps) -> RemadeWeights:
        """The weight maps, and how they are made."""
        return self._by(lambda e: RemadeWeights(lambda other: other.prepared(maps), e))

    def masked(
        self,
        weights: RemadeWeights,
        pose: np.ndarray,
        moving: Sequence[int],
        windows: np.ndarray | None = None,
    ) -> RemadeWeights:
        """Weights under which the ``moving`` segments alone give the full energy."""
        pose = np.array(pose)

        def make(evaluator: Evaluator) -> Any:
            return evaluator.masked(weights.of(evaluator), pose, moving, windows)

        return self._by(lambda e: RemadeWeights(make, e))

    def energies(
        self, weights: RemadeWeights, poses: np.ndarray, segments: Sequence[int] | None = None
    ) -> np.ndarray:
        """(N, V) int64 energies of poses (N, D) or (N, V, D), of all or the given segments."""
        return self._by(lambda e: e.energies(weights.of(e), poses, segments))

    def silhouettes(
        self, pose: np.ndarray, segments: Sequence[int] | None = None
    ) -> tuple[np.ndarray, ...]:
        """V boolean pictures (H, W), True where the body covers the pixel's centre."""
        return self._by(lambda e: e.silhouettes(pose, segments))

    def outline(
        self, pose: np.ndarray, segments: Sequence[int] | None = None, spacing_px: float = 1.0
    ) -> tuple[Outline, ...]:
        """V outlines of what the segments cover, in steps of at most ``spacing_px``."""
        return self._by(lambda e: e.outline(pose, segments, spacing_px))

    def bounds(self, poses: np.ndarray, segments: Sequence[int]) -> np.ndarray:
        """(N, V, 4) int: x0, y0, x1, y1 (exclusive), px that the segments can cover, unclipped."""
        return self._by(lambda e: e.bounds(poses, segments))

    def transforms(self, poses: np.ndarray) -> np.ndarray:
        """(N, J, 3, 4) world_from_joint of poses (N, D), metres."""
        return self._by(lambda e: e.transforms(poses))

    def _by(self, work: Callable[[Evaluator], R]) -> R:
        """What ``work`` gives with the evaluator in use; with the second where that fails."""
        if not self._failures.any:
            try:
                return work(self._first)
            except MocapError as fault:
                self._failures.add(fault)
        with self._lock:
            if self._second is None:
                self._second = self._make_second()
        return work(self._second)
