"""What is rendered and compared: a body, cameras round it, and candidates for its pose."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..body.body import Body, Part
from ..cameras.camera import Camera
from ..cameras.presets import Ring, ring
from ..energy.evaluator import Evaluator, WeightMaps
from ..energy.weight_maps import xor_weight_maps
from ..fitting.part_search import part_windows
from ..rendering.native import NativeEvaluator
from ..silhouettes.silhouette import Silhouette

PAPER_SIZE = (320, 240)
WHOLE_SPREAD, PART_SPREAD = 0.03, 0.05
"""Standard deviations of candidates about the pose, rad and m."""
_FOCAL_PX, _DISTANCE_STEPS = 275.0, 16


def studio(size: tuple[int, int] = PAPER_SIZE, count: int = 8) -> tuple[Camera, ...]:
    """The paper's ring of cameras (`cameras.presets.studio_t`) at any resolution and count."""
    focal = _FOCAL_PX * size[1] / PAPER_SIZE[1]
    return ring(Ring(count, heights=(1.5, 2.2), first_angle_deg=22.5, size=size, focal_px=focal))


def filmed(evaluator: Evaluator, pose: np.ndarray) -> tuple[Silhouette, ...]:
    """Perfect silhouettes of what ``evaluator`` draws in ``pose`` (D,)."""
    pictures = evaluator.silhouettes(pose)
    return tuple(Silhouette(picture, np.ones_like(picture)) for picture in pictures)


@dataclass(frozen=True, eq=False)
class Stage:
    """A body before cameras.

    Attributes:
        full: draws the full mesh.
        pose: (D,) that candidates lie about.
        observed: V silhouettes, of another pose.
    """

    full: NativeEvaluator
    pose: np.ndarray
    observed: tuple[Silhouette, ...]

    @property
    def body(self) -> Body:
        """What is rendered."""
        return self.full.body

    @property
    def cameras(self) -> tuple[Camera, ...]:
        """V of them."""
        return self.full.cameras

    @property
    def everything(self) -> tuple[int, ...]:
        """All segments."""
        return tuple(range(len(self.body.segment_names)))

    def maps(self, weighted: bool = False) -> WeightMaps:
        """Weights of the XOR energy; ``weighted``: any integers, growing with the distance."""
        maps = xor_weight_maps(self.observed)
        return _graded(maps) if weighted else maps

    def windows(self, part: Part, side: int) -> np.ndarray:
        """(V, 4) px about the part; ``side`` px at 240 lines."""
        return part_windows(self.full, self.pose, part, side)


def part_named(body: Body, name: str) -> Part:
    """The part of that name.

    Raises:
        ValueError: there is none.
    """
    for part in body.parts:
        if part.name == name:
            return part
    raise ValueError(f"expected a part of {body.name}, got {name}")


def candidates_about(
    pose: np.ndarray, dofs: Sequence[int], spread: float, count: int
) -> Callable[[int], np.ndarray]:
    """A function of a turn's number: ``count`` poses that differ in ``dofs``; no two are equal."""

    def candidates(turn: int) -> np.ndarray:
        poses = np.repeat(pose[None], count, axis=0)
        rng = np.random.default_rng([turn, len(dofs)])
        poses[:, list(dofs)] += rng.normal(0, spread, (count, len(dofs)))
        return poses

    return candidates


def _graded(maps: WeightMaps) -> WeightMaps:
    """The same signs, but weights of 16 to 256 that grow away from the contour."""
    graded, constants = [], []
    for weights in maps.maps:
        inside = (weights < 0).astype(np.uint8)
        distances = sum(cv2.distanceTransform(m, cv2.DIST_L2, 5) for m in (inside, 1 - inside))
        steps = np.ceil(distances).clip(1, _DISTANCE_STEPS).astype(np.int16)
        graded.append((16 * steps * weights).astype(np.int16))
        constants.append(-int(graded[-1][graded[-1] < 0].sum()))
    return WeightMaps(tuple(graded), np.array(constants, np.int64))
