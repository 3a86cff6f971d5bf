"""What every tracker offers: a frame's pose, searched from the poses before it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from ..silhouettes.silhouette import Silhouette

EvaluatorFactory = Callable[[Body, tuple[Camera, ...]], Evaluator]

_LEAST_AREA = 0.2
"""Of what a pose covers; with less foreground, nobody is shown."""


@dataclass
class Tally:
    """What searching a frame took.

    Attributes:
        evaluated: candidates rendered and compared.
        outside_windows: candidates among them that reached out of their part's window.
    """

    evaluated: int = 0
    outside_windows: int = 0

    def add(self, other: "Tally") -> None:
        """Counts what ``other`` has counted, too."""
        self.evaluated += other.evaluated
        self.outside_windows += other.outside_windows


@dataclass(frozen=True, eq=False)
class PoseFit:
    """The pose found for one frame.

    Attributes:
        pose: (D,).
        energy: px that differ, summed over views.
        tally: what the search took.
        rivals: other poses (D,) that explain nearly as much.
    """

    pose: np.ndarray
    energy: int
    tally: Tally
    rivals: tuple[np.ndarray, ...] = ()


def shows_nobody(observed_px: int, covered_px: int) -> bool:
    """Whether the foreground is a fraction only of what the pose before covers, both in px.

    A search would then walk the body out of the pictures, from where none leads back.
    """
    return observed_px < _LEAST_AREA * covered_px


@dataclass(frozen=True, eq=False)
class Past:
    """What a frame is searched from.

    Attributes:
        last: (D,) the pose of the frame before.
        predicted: (D,) the pose expected now.
        usual: (L,) `FrameScores.lumps` that the frames before had usually, or (1,) for all limbs;
            infinite where there were none.
        trusted: (D,) the pose expected now, with each limb that was in trouble as it was before.
        patient: likewise, bool, whether a limb may be held there while the silhouettes drop it.
        amiss: frames in a row before this one that were not explained (`lumps.unexplained`).
    """

    last: np.ndarray
    predicted: np.ndarray
    usual: np.ndarray
    trusted: np.ndarray
    patient: np.ndarray
    amiss: int = 0

    @classmethod
    def still(cls, pose: np.ndarray) -> "Past":
        """Nothing but a pose (D,), that is not expected to change."""
        return cls(pose, pose, np.array([np.inf]), pose, np.array([True]))


class Tracker(Protocol):
    """Fits one frame after another; keeps no state between frames."""

    @property
    def evaluator(self) -> Evaluator:
        """Renders the body."""
        ...

    def fit(self, silhouettes: tuple[Silhouette, ...], past: Past) -> PoseFit:
        """The pose that explains the V silhouettes best."""
        ...
