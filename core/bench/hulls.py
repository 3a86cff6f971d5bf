"""What OpenCV alone can do: convex hulls of projected segments, filled and compared.

Quick to write and wrong where a segment is not convex: a yardstick, not a backend.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import WeightMaps
from ..rendering.native import NativeEvaluator

_SHIFT = 8


@dataclass(frozen=True, eq=False)
class HullWeights:
    """Weights of +1 and -1 as pictures.

    Attributes:
        constants: (V,) int64 energy of an empty rendering.
        foreground: V pictures (H, W) uint8, 1 where the weight is -1.
        known: V pictures, 1 where the weight is not 0; None where that is everywhere.
        origins: (V, 2) px of the pictures' first pixels.
    """

    constants: np.ndarray
    foreground: tuple[np.ndarray, ...]
    known: tuple[np.ndarray, ...] | None
    origins: np.ndarray


class HullEvaluator:
    """Energies by OpenCV's ``convexHull`` and ``fillConvexPoly``, one candidate after another."""

    def __init__(self, body: Body, cameras: Sequence[Camera], level: int):
        self.native = NativeEvaluator(body, cameras, level)
        self.body, self.cameras = body, tuple(cameras)
        surface = body.surfaces[level]
        starts = surface.vertex_starts
        self.vertices = [
            surface.vertices[begin:end].astype(float) for begin, end in pairwise(starts)
        ]
        self.projections = np.stack([camera.projection for camera in cameras])

    def prepared(self, maps: WeightMaps) -> HullWeights:
        """The weights as pictures."""
        foreground = tuple((m < 0).astype(np.uint8) for m in maps.maps)
        return HullWeights(maps.constants, foreground, None, np.zeros((len(foreground), 2), int))

    def masked(
        self,
        weights: HullWeights,
        pose: np.ndarray,
        moving: Sequence[int],
        windows: np.ndarray | None = None,
    ) -> HullWeights:
        """Weights for the ``moving`` segments alone, cut to ``windows`` (V, 4)."""
        fixed = [s for s in range(len(self.vertices)) if s not in set(moving)]
        covered = self.native.silhouettes(pose, fixed)
        constants, foreground, known, origins = weights.constants.copy(), [], [], []
        for view, cover in enumerate(covered):
            height, width = cover.shape
            seen = weights.foreground[view]
            constants[view] += np.count_nonzero(cover & (seen == 0))
            constants[view] -= np.count_nonzero(cover & (seen == 1))
            x0, y0, x1, y1 = (0, 0, width, height) if windows is None else windows[view]
            x0, y0 = min(max(x0, 0), width - 1), min(max(y0, 0), height - 1)
            cut = np.s_[y0 : max(min(y1, height), y0 + 1), x0 : max(min(x1, width), x0 + 1)]
            known.append(np.ascontiguousarray(~cover[cut]).view(np.uint8))
            foreground.append(np.ascontiguousarray(seen[cut] & known[-1]))
            origins.append((x0, y0))
        return HullWeights(constants, tuple(foreground), tuple(known), np.array(origins))

    def energies(
        self, weights: HullWeights, poses: np.ndarray, segments: Sequence[int] | None = None
    ) -> np.ndarray:
        """(N, V) int64 energies of poses (N, D)."""
        chosen = range(len(self.vertices)) if segments is None else segments
        transforms = self.native.transforms(poses)[:, self.body.segment_joints]
        empty = [count - cv2.countNonZero(f) for count, f in
                 zip(weights.constants.tolist(), weights.foreground, strict=True)]  # fmt: skip
        return np.array(
            [[base + n for base, n in zip(empty, self._differing(weights, placed, chosen),
              strict=True)] for placed in transforms], np.int64,
        )  # fmt: skip

    def _differing(
        self, weights: HullWeights, placed: np.ndarray, segments: Sequence[int]
    ) -> list[int]:
        """Px per view in which a candidate, (S, 3, 4) world from segment, differs."""
        corners = self._corners(placed, segments, weights.origins)
        counts = []
        for view, seen in enumerate(weights.foreground):
            drawn = np.zeros_like(seen)
            for points in corners:
                cv2.fillConvexPoly(drawn, cv2.convexHull(points[view]), (1,), cv2.LINE_8, _SHIFT)
            if weights.known is not None:
                cv2.bitwise_and(drawn, weights.known[view], dst=drawn)
            counts.append(cv2.countNonZero(cv2.bitwise_xor(drawn, seen, dst=drawn)))
        return counts

    def _corners(
        self, placed: np.ndarray, segments: Sequence[int], origins: np.ndarray
    ) -> list[np.ndarray]:
        """For each segment (V, n, 2) int32 projected vertices, in 1/256 px from the origins."""
        found = []
        for segment in segments:
            carried = self.projections[:, :, :3] @ placed[segment]
            carried[:, :, 3] += self.projections[:, :, 3]
            h = self.vertices[segment] @ carried[:, :, :3].transpose(0, 2, 1)
            h += carried[:, None, :, 3]
            px = h[..., :2] / h[..., 2:] - origins[:, None]
            found.append(np.round(px * (1 << _SHIFT)).astype(np.int32))
        return found
