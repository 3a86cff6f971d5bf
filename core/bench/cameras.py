"""The cost of an energy against the number of cameras: it should be a straight line.

Costs are those of the best of many short turns: what others do on the machine only ever adds to
them, and would bend the line.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .rows import Row, variant
from .stage import WHOLE_SPREAD, candidates_about, studio
from .table1 import Scene
from .turns import Turns, Variant, measured

_SHORTER = 3


@dataclass(frozen=True, eq=False)
class CameraCosts:
    """Seconds for one candidate in V cameras.

    Attributes:
        counts: (n,) numbers of cameras.
        seconds: (n,) for one candidate in all of them.
        fixed: seconds of the fitted line at no camera.
        per_camera: seconds that each camera adds.
    """

    counts: np.ndarray
    seconds: np.ndarray
    fixed: float
    per_camera: float

    @classmethod
    def fitted(cls, counts: Sequence[int], seconds: Sequence[float]) -> "CameraCosts":
        """With the line of least squares through the costs."""
        slope, fixed = np.polyfit(counts, seconds, 1)
        return cls(np.array(counts), np.array(seconds), float(fixed), float(slope))

    @property
    def line(self) -> np.ndarray:
        """(n,) seconds on the line."""
        return self.fixed + self.per_camera * self.counts

    @property
    def largest_residual(self) -> float:
        """The largest distance of a cost from the line, as a share of the line there."""
        return float((np.abs(self.seconds - self.line) / self.line).max())

    def as_dict(self) -> dict:
        """For JSON."""
        return {
            "cameras": self.counts.tolist(),
            "microseconds": (1e6 * self.seconds).tolist(),
            "fixed_microseconds": 1e6 * self.fixed,
            "microseconds_per_camera": 1e6 * self.per_camera,
            "largest_residual": self.largest_residual,
        }


def camera_costs(
    scene: Scene, counts: Sequence[int], rows: Sequence[Row], turns: Turns
) -> dict[str, CameraCosts]:
    """The costs of the whole body by row; all counts and rows take turns."""
    variants = []
    for count in counts:
        stage = scene.stage(studio(count=count))
        for row in rows:
            evaluator = row.make(stage.body, stage.cameras)
            one = variant(row, evaluator, stage, stage.everything, None)
            variants.append(Variant(f"{row.name} {count}", one.energies))
    moved = range(len(scene.body.dofs))
    poses = candidates_about(scene.pose, moved, WHOLE_SPREAD, turns.poses)
    short = replace(turns, count=_SHORTER * turns.count, seconds=turns.seconds / _SHORTER)
    rates = measured(variants, poses, short).fastest
    return {
        row.name: CameraCosts.fitted(counts, [1 / rates[f"{row.name} {n}"] for n in counts])
        for row in rows
    }
