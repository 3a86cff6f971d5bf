"""Paper mode: the energy as Theobalt et al. 2003 computed it on a GeForce3 (section 4).

* 4.1: the observed silhouettes of up to eight cameras of one size are packed into the bit planes of
  one byte per pixel, and written into the stencil buffer. The model is drawn for one camera after
  the other, flattened into one plane of depth; every fragment that passes the depth test inverts
  the bit in its camera's plane, and the test rejects what is not nearer than before, so that each
  pixel is inverted once. The stencil buffer is read back, and the processor counts the bits.
* 4.2: with windows, only a part of each silhouette is written, drawn and read.
* 4.3: what fixed parts cover is drawn once into a mask; the processor takes the bitwise AND of it
  and the stencil buffer before it counts.

Every segment is one draw call with its own matrix, and one candidate is evaluated after the other.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ...energy.evaluator import WeightMaps
from .common import HeldWeights, MaskedMaps, OpenGLBase
from .stencil import PLANES, StencilDrawing, StencilPrograms
from .tiles import Tiles

_PLACED_AT_ONCE = 256
_MOST_COUNTED = 1 << 24
"""px; up to here single precision counts exactly."""
_HAS_PLANE = (np.arange(256)[:, None] >> np.arange(PLANES)) & 1


@dataclass(frozen=True, eq=False)
class PlaneSet:
    """Up to eight views that share the stencil buffer.

    Attributes:
        tiles: the views and their windows, all in the buffer's corner.
        observed: (H, W) uint8, a bit plane for each view: its observed silhouette.
        mask: (H, W) uint8, likewise: where it was observed and no fixed part covers.
        base: (k,) int64, the energy beside the bits that are counted.
        weights: k maps (h, w) int16 of the windows where weights are other than -1, 0 and 1;
            ``observed`` is empty then, and the model's pixels are weighed, not counted.
    """

    tiles: Tiles
    observed: np.ndarray
    mask: np.ndarray
    base: np.ndarray
    weights: tuple[np.ndarray, ...]


@dataclass(frozen=True, eq=False)
class PaperWeights(HeldWeights):
    """Weight maps as bit planes.

    Attributes:
        sets: their planes; a view without a window is in none.
    """

    sets: tuple[PlaneSet, ...]


def plane_sets(masked: MaskedMaps, sizes: np.ndarray) -> tuple[PlaneSet, ...]:
    """The planes of V maps, whose pictures have sizes (V, 2): eight of one size to a set."""
    order = sorted(range(len(sizes)), key=lambda v: (*sizes[v], v))
    shown = [v for v in order if (masked.windows[v, 2:] > masked.windows[v, :2]).all()]
    sets, begin = [], 0
    for end in range(1, len(shown) + 1):
        full = end - begin == PLANES or end == len(shown)
        if full or (sizes[shown[end]] != sizes[shown[begin]]).any():
            sets.append(_plane_set(masked, shown[begin:end]))
            begin = end
    return tuple(sets)


def _plane_set(masked: MaskedMaps, views: Sequence[int]) -> PlaneSet:
    windows = masked.windows[list(views)]
    width, height = (windows[:, 2:] - windows[:, :2]).max(axis=0).tolist()
    parts = [
        masked.maps[view][y0:y1, x0:x1]
        for view, (x0, y0, x1, y1) in zip(views, windows, strict=True)
    ]
    counted = all(part.min() >= -1 and part.max() <= 1 for part in parts)
    observed, mask = np.zeros((2, height, width), np.uint8)
    base = masked.constants[list(views)]
    for plane, part in enumerate(parts):
        corner = np.s_[: part.shape[0], : part.shape[1]]
        mask[corner] |= (part != 0).astype(np.uint8) << plane
        if counted:
            observed[corner] |= (part < 0).astype(np.uint8) << plane
            base[plane] -= np.count_nonzero(part < 0)
    tiles = Tiles(np.array(views), windows, np.zeros((len(views), 2), np.int64), (width, height))
    return PlaneSet(tiles, observed, mask, base, () if counted else tuple(parts))


def bits_by_plane(planes: np.ndarray) -> np.ndarray:
    """(8,) int64, how many bits are set in each plane of planes (H, W) uint8."""
    step = max(1, _MOST_COUNTED // planes.shape[1])
    counts = np.zeros(256, np.int64)
    for y in range(0, len(planes), step):
        found = cv2.calcHist([planes[y : y + step]], [0], None, [256], [0, 256])
        counts += found[:, 0].astype(np.int64)
    return counts @ _HAS_PLANE


class PaperEvaluator(OpenGLBase[PaperWeights]):
    """Energies and silhouettes by the paper's method; see `energy.evaluator.Evaluator`.

    Arguments and faults are those of `OpenGLBase`.
    """

    weights_kind = PaperWeights

    def __init__(self, *arguments, **keywords):
        super().__init__(*arguments, **keywords)
        self._programs = self.thread.kept(StencilPrograms)
        self._everything = tuple(range(len(self.body.segment_names)))

    def energies(
        self, weights: PaperWeights, poses: np.ndarray, segments: Sequence[int] | None = None
    ) -> np.ndarray:
        """(N, V) int64 energies of poses (N, D) or (N, V, D), of all or the given segments."""
        self._check(weights)
        poses, chosen = self._checked(poses), self._chosen(segments)
        energies = np.repeat(weights.constants[None], len(poses), axis=0)
        for begin in range(0, len(poses), _PLACED_AT_ONCE):
            transforms = self._placer.transforms(poses[begin : begin + _PLACED_AT_ONCE])
            for planes in weights.sets:
                found = self.thread.call(self._evaluate, planes, transforms, chosen)
                energies[begin : begin + len(found), planes.tiles.views] = found
        return energies

    def _evaluate(
        self, planes: PlaneSet, transforms: np.ndarray, segments: tuple[int, ...]
    ) -> np.ndarray:
        """(N, k) int64 energies in the views of one set; in the thread only."""
        placement = self._placed(transforms, segments, planes.tiles)
        mesh = self._mesh(self._everything)
        drawing = StencilDrawing(self._programs, planes.tiles, planes.observed)
        energies = np.repeat(planes.base[None], placement.states.shape[1], axis=0)
        for n, row in enumerate(energies):
            drawing.write()
            drawing.invert(mesh, placement, n, segments)
            left = cv2.bitwise_and(drawing.read(), planes.mask)
            if planes.weights:
                row += self._weighed(left, planes)
            else:
                row += bits_by_plane(left)[: len(row)]
        return energies

    @staticmethod
    def _weighed(left: np.ndarray, planes: PlaneSet) -> list[int]:
        """Sums of the weights of each view's pixels."""
        sums = []
        for plane, weights in enumerate(planes.weights):
            height, width = weights.shape
            inverted = (left[:height, :width] >> plane & 1).view(bool)
            sums.append(int(weights.sum(where=inverted, dtype=np.int64)))
        return sums

    def _held(self, masked: MaskedMaps) -> PaperWeights:
        return PaperWeights(masked, plane_sets(masked, self._sizes))

    def _draw_silhouettes(
        self, pose: np.ndarray, segments: tuple[int, ...]
    ) -> tuple[np.ndarray, ...]:
        zeros = tuple(np.zeros(camera.size[::-1], np.int16) for camera in self.cameras)
        nothing = self._whole(WeightMaps(zeros, np.zeros(len(zeros), np.int64)))
        transforms, found = self._placer.transforms(pose), {}
        mesh = self._mesh(self._everything)
        for planes in plane_sets(nothing, self._sizes):
            placement = self._placed(transforms, segments, planes.tiles)
            drawing = StencilDrawing(self._programs, planes.tiles, planes.observed)
            drawing.write()
            drawing.invert(mesh, placement, 0, segments)
            left = drawing.read()
            for plane, view in enumerate(planes.tiles.views):
                found[view] = (left >> plane & 1).view(bool)
        return tuple(found[view] for view in range(len(self.cameras)))
