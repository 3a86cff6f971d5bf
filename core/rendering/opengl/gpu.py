"""GPU mode: many candidates in one drawing, XOR and sums on the device, one small read-back.

All views lie side by side in one large picture of 32-bit words, and every candidate owns one bit
of them: drawing or-s the bit into the words that a candidate covers, so that 32 candidates share
their pixels, and further groups of 32 lie in further blocks. Then a compute shader adds up the
weights of the pixels that each candidate covers in each view (energy = constant + sum, see
energy/evaluator.py).
"""

from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field

import numpy as np

from ...cameras.camera import Camera
from .atlas import Atlas, DeviceTiles
from .common import HeldWeights, MaskedMaps, OpenGLBase, check_sizes, check_version
from .context import shared_thread
from .gpu_shaders import CANDIDATES
from .placing import Placement
from .tiles import clipped_windows, packed

VERSION = (4, 3)
"""Of OpenGL, at least: the first with compute shaders."""
_MOST_CANDIDATES = 4096
_MOST_MATRICES = 1 << 16
"""In a batch; 3 MiB of them, so that placing and drawing overlap."""


@dataclass(frozen=True, eq=False)
class GpuWeights(HeldWeights):
    """Weight maps on the device.

    Attributes:
        blocks: their tiles, block by block.
    """

    blocks: tuple[DeviceTiles, ...] = field(repr=False)


def check_usable(cameras: Sequence[Camera]) -> str:
    """The name of what draws these cameras' pictures.

    Raises:
        MocapError: OpenGL cannot be used, or not for pictures of their size.
    """
    thread = shared_thread()
    check_version(thread, VERSION)
    check_sizes(thread, cameras)
    thread.kept(Atlas)
    return thread.renderer


class OpenGLEvaluator(OpenGLBase[GpuWeights]):
    """Energies and silhouettes by a graphics processor; see `energy.evaluator.Evaluator`.

    May be called from several threads at once; they take turns. What a call returns depends on
    nothing but its arguments. Arguments and faults are those of `OpenGLBase`.
    """

    version = VERSION
    weights_kind = GpuWeights

    def __init__(self, *arguments, **keywords):
        super().__init__(*arguments, **keywords)
        self._atlas = self.thread.kept(Atlas)
        self._pictures: tuple[DeviceTiles, ...] = ()

    def energies(
        self, weights: GpuWeights, poses: np.ndarray, segments: Sequence[int] | None = None
    ) -> np.ndarray:
        """(N, V) int64 energies of poses (N, D) or (N, V, D), of all or the given segments."""
        self._check(weights)
        poses, chosen = self._checked(poses), self._chosen(segments)
        energies = np.repeat(weights.constants[None], len(poses), axis=0)
        for begin in range(0, len(poses), _MOST_CANDIDATES):
            part = slice(begin, begin + _MOST_CANDIDATES)
            transforms = self._placer.transforms(poses[part])
            for tiles in weights.blocks:
                sums = self._sums(tiles, transforms, chosen)
                energies[part, tiles.tiles.views] += sums
        return energies

    def _sums(
        self, tiles: DeviceTiles, transforms: np.ndarray, segments: tuple[int, ...]
    ) -> np.ndarray:
        """(N, k) int64 sums of the weights that each candidate covers in each tile."""
        count = transforms.shape[1]
        parts: list[Future[np.ndarray]] = []
        step = self._most_at_once(tiles, len(segments))
        for begin in range(0, count, step):
            placement = self._placed(transforms[:, begin : begin + step], segments, tiles.tiles)
            # while one batch is drawn the next is placed
            for part in parts[-2:-1]:
                part.result()
            parts.append(self.thread.submit(self._add_up, tiles, placement, segments))
        empty = np.zeros((0, len(tiles.tiles.views)), np.int64)
        return np.concatenate([empty, *(part.result() for part in parts)])

    def _most_at_once(self, tiles: DeviceTiles, segments: int) -> int:
        """How many candidates, whole groups of them, a batch may have."""
        matrices = len(tiles.tiles.views) * max(1, segments)
        groups = _MOST_MATRICES // matrices // CANDIDATES
        return CANDIDATES * max(1, min(groups, self._atlas.most_groups(tiles.tiles.size)))

    def _add_up(
        self, tiles: DeviceTiles, placement: Placement, segments: tuple[int, ...]
    ) -> np.ndarray:
        self._atlas.draw(self._mesh(segments), tiles, placement)
        return self._atlas.sums(tiles, placement)

    def _draw_silhouettes(
        self, pose: np.ndarray, segments: tuple[int, ...]
    ) -> tuple[np.ndarray, ...]:
        if not self._pictures:
            self._pictures = self._blocks(clipped_windows(self._sizes, None), None)
        transforms, found = self._placer.transforms(pose), {}
        for tiles in self._pictures:
            placement = self._placed(transforms, segments, tiles.tiles)
            self._atlas.draw(self._mesh(segments), tiles, placement)
            words = self._atlas.words(tiles)
            for view, (x0, y0, x1, y1) in zip(tiles.tiles.views, tiles.tiles.areas, strict=True):
                found[view] = words[y0:y1, x0:x1] != 0
        return tuple(found[view] for view in range(len(self.cameras)))

    def _held(self, masked: MaskedMaps) -> GpuWeights:
        return GpuWeights(masked, self.thread.call(self._blocks, masked.windows, masked.maps))

    def _blocks(
        self, windows: np.ndarray, maps: tuple[np.ndarray, ...] | None
    ) -> tuple[DeviceTiles, ...]:
        blocks = packed(windows, self._range.largest, self._atlas.most_px)
        return tuple(DeviceTiles(self.thread, self._range, tiles, maps) for tiles in blocks)
