"""The evaluator behind the native kernel: exact, batched, views apart.

What a call returns depends on nothing but its arguments: candidates are independent, so that any
number of threads gives the same integers.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from ctypes import byref
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import Outline, WeightMaps
from ..native.library import MAPS, PLANES, PointsRecord, WeightsRecord, check, load
from .arguments import (
    Sizes,
    check_weights,
    checked_level,
    checked_maps,
    chosen_segments,
    fixed_segments,
    picture_sizes,
)
from .model import body_record, views_record

OUTLINE_ROOM = 500
"""Points of an outline to begin with, per view."""


@dataclass(frozen=True, eq=False)
class NativeWeights:
    """Weight maps as bit planes, or as maps with prefix sums along the rows.

    Attributes:
        constants: (V,) int64, the energy of an empty rendering, fixed parts included.
        arrays: the kernel's arrays by name.
        record: the ``sm_weights`` that points at them.
        sizes: of the V pictures.
    """

    constants: np.ndarray
    arrays: dict[str, np.ndarray]
    record: WeightsRecord
    sizes: Sizes


class _Pointed:
    """An array and its address, which numpy takes a microsecond to tell."""

    __slots__ = ("address", "array", "length")

    def __init__(self, array: np.ndarray):
        self.array, self.length = array, len(array)
        self.address = array.ctypes.data


class NativeEvaluator:
    """Energies and silhouettes by the native kernel; see `energy.evaluator.Evaluator`.

    May be called from several threads at once.

    Args:
        body: the model.
        cameras: V pinhole cameras, any sizes up to 16,000 px.
        level: which of the body's surfaces to draw.
        threads: number of threads over which a batch of candidates is spread.
        processor: code path, 1 (any), 3 (x86-64-v3) or 4 (x86-64-v4); None for the best here.

    Raises:
        ValueError: a camera with lens distortion or too large pictures, a body whose indices are
            out of range, no such level or code path, or less than one thread.
        MocapError: the native library is missing or stale.
    """

    def __init__(
        self,
        body: Body,
        cameras: Sequence[Camera],
        level: int = 0,
        threads: int = 1,
        processor: int | None = None,
    ):
        if threads < 1:
            raise ValueError(f"expected at least one thread, got {threads}")
        self._library = load()
        best = self._library.sm_processor()
        if processor is not None and not 1 <= processor <= best:
            raise ValueError(f"expected a code path of at most {best} here, got {processor}")
        self.body, self.cameras, self.threads = body, tuple(cameras), threads
        self.level, self._sizes = checked_level(body, level), picture_sizes(cameras)
        self._views = views_record(cameras, best if processor is None else processor)
        self._body = body_record(body, level)
        self._refs = byref(self._body), byref(self._views)
        check(self._library.sm_check(*self._refs))
        self._scratch_bytes = self._library.sm_scratch(*self._refs)
        self._scratches: list[_Pointed] = []
        everything = _Pointed(np.arange(len(body.segment_names), dtype=np.int32))
        self._segments: dict[tuple[int, ...] | None, _Pointed] = {None: everything}
        self._outline_room = OUTLINE_ROOM * len(self.cameras)
        self._pool = ThreadPoolExecutor(threads) if threads > 1 else None

    def prepared(self, maps: WeightMaps) -> NativeWeights:
        """Bit planes where all weights are -1, 0 or 1; else maps with prefix sums."""
        maps = checked_maps(maps, self._sizes)
        pixels = np.concatenate([weight_map.ravel() for weight_map in maps.maps])
        small = pixels.min() >= -1 and pixels.max() <= 1
        weights = self._empty_weights(PLANES if small else MAPS, maps.constants)
        column = self._column()
        arguments = pixels.ctypes.data, byref(weights.record), column.ctypes.data
        check(self._library.sm_prepare(self._refs[1], *arguments))
        return weights

    def masked(
        self,
        weights: NativeWeights,
        pose: np.ndarray,
        moving: Sequence[int],
        windows: np.ndarray | None = None,
    ) -> NativeWeights:
        """Weights under which the ``moving`` segments alone give the full energy.

        ``pose`` may be (V, D) as well, one pose per view.
        """
        check_weights(weights, NativeWeights, self._sizes)
        covered = self._covered(pose, fixed_segments(self.body, moving))
        result = self._empty_weights(weights.record.kind, weights.constants)
        column = self._column()
        if windows is not None:
            windows = np.ascontiguousarray(windows, np.int32)
            if windows.shape != (len(self.cameras), 4):
                raise ValueError(f"expected windows of shape (V, 4), got {windows.shape}")
        check(
            self._library.sm_mask(
                self._refs[1],
                byref(weights.record),
                covered.ctypes.data,
                None if windows is None else windows.ctypes.data,
                byref(result.record),
                column.ctypes.data,
            )
        )
        return result

    def energies(
        self, weights: NativeWeights, poses: np.ndarray, segments: Sequence[int] | None = None
    ) -> np.ndarray:
        """(N, V) int64 energies of poses (N, D) or (N, V, D), of all or the given segments."""
        check_weights(weights, NativeWeights, self._sizes)
        poses, per_view = self._checked(poses)
        chosen = self._chosen(segments)
        count = len(poses)
        energies = np.empty((count, len(self.cameras)), np.int64)
        first_pose, first_energy = poses.ctypes.data, energies.ctypes.data

        def run(begin: int, end: int) -> None:
            self._run(
                self._library.sm_energies,
                byref(weights.record),
                first_pose + begin * poses.strides[0],
                end - begin,
                per_view,
                chosen.address,
                chosen.length,
                first_energy + begin * energies.strides[0],
            )

        if self._pool is None or count < 2 * self.threads:
            run(0, count)
        else:
            cuts = [count * k // self.threads for k in range(self.threads + 1)]
            list(self._pool.map(run, cuts[:-1], cuts[1:]))
        return energies

    def silhouettes(
        self, pose: np.ndarray, segments: Sequence[int] | None = None
    ) -> tuple[np.ndarray, ...]:
        """V boolean pictures (H, W), True where the body covers the pixel's centre."""
        words = self._covered(pose, segments)
        starts = self._views.arrays["word_starts"]
        pictures = []
        for camera, begin, end in zip(self.cameras, starts[:-1], starts[1:], strict=True):
            width, height = camera.size
            columns = words[begin:end].reshape(-1, height)
            rows = np.ascontiguousarray(columns.T).view(np.uint8)
            pictures.append(np.unpackbits(rows, axis=1, count=width, bitorder="little").view(bool))
        return tuple(pictures)

    def outline(
        self, pose: np.ndarray, segments: Sequence[int] | None = None, spacing_px: float = 1.0
    ) -> tuple[Outline, ...]:
        """V outlines of what the segments cover, in steps of at most ``spacing_px``."""
        poses, per_view = self._checked(np.asarray(pose)[None])
        chosen, room = self._chosen(segments), self._outline_room
        arguments = poses.ctypes.data, per_view, chosen.address, chosen.length, spacing_px
        while True:
            arrays = {
                "starts": np.empty(len(self.cameras) + 1, np.int64),
                "segments": np.empty(room, np.int32),
                "points": np.empty((room, 3)),
                "px": np.empty((room, 2)),
                "normals": np.empty((room, 2)),
            }
            record = PointsRecord(room, *(array.ctypes.data for array in arrays.values()))
            self._run(self._library.sm_outline, *arguments, byref(record))
            starts = arrays.pop("starts")
            if starts[-1] <= room:
                break
            room = self._outline_room = int(starts[-1])
        return tuple(
            Outline(**{name: array[begin:end] for name, array in arrays.items()})
            for begin, end in pairwise(starts.tolist())
        )

    def bounds(self, poses: np.ndarray, segments: Sequence[int]) -> np.ndarray:
        """(N, V, 4) int: x0, y0, x1, y1 (exclusive), px that the segments can cover, unclipped.

        The whole guard region (16,000 px either way) where a segment leaves it or comes too near.
        """
        poses, per_view = self._checked(poses)
        chosen = self._chosen(segments)
        boxes = np.empty((len(poses), len(self.cameras), 4), np.int32)
        arguments = poses.ctypes.data, len(poses), per_view, chosen.address, chosen.length
        self._run(self._library.sm_bounds, *arguments, boxes.ctypes.data)
        return boxes

    def snapped(self, pose: np.ndarray) -> np.ndarray:
        """(V, n, 2) int32 vertices in 1/256 px; the lowest int32 where one is clipped away."""
        poses, _ = self._checked(np.asarray(pose)[None])
        vertices = np.empty((len(self.cameras), self._body.vertices, 2), np.int32)
        self._run(self._library.sm_snapped, poses.ctypes.data, vertices.ctypes.data)
        return vertices

    def transforms(self, poses: np.ndarray) -> np.ndarray:
        """(N, J, 3, 4) float64 world from joint of poses (N, D)."""
        poses, per_view = self._checked(poses)
        if per_view:
            raise ValueError("expected poses (N, D)")
        out = np.empty((len(poses), self._body.joints, 3, 4))
        check(
            self._library.sm_transforms(
                self._refs[0], poses.ctypes.data, len(poses), out.ctypes.data
            )
        )
        return out

    def _empty_weights(self, kind: int, constants: np.ndarray) -> NativeWeights:
        starts = {
            name: int(array[-1]) for name, array in self._views.arrays.items() if "starts" in name
        }
        arrays = {
            "constants": np.array(constants, np.int64),
            "rows": np.empty((len(self.cameras), 2), np.int32),
        }
        if kind == PLANES:
            arrays |= {
                name: np.empty(starts["word_starts"], np.uint64) for name in ("plus", "minus")
            }
        else:
            arrays["maps"] = np.empty(starts["map_starts"], np.int16)
            arrays["sums"] = np.empty(starts["sum_starts"], np.int32)
        record = WeightsRecord(kind, **{name: array.ctypes.data for name, array in arrays.items()})
        return NativeWeights(arrays["constants"], arrays, record, self._sizes)

    def _column(self) -> np.ndarray:
        """Scratch for a column of words."""
        return np.empty(max(camera.size[1] for camera in self.cameras), np.uint64)

    def _covered(self, pose: np.ndarray, segments: Sequence[int] | None) -> np.ndarray:
        """Packed rows of what the segments cover in one pose (D,) or (V, D)."""
        poses, per_view = self._checked(np.asarray(pose)[None])
        chosen = self._chosen(segments)
        words = np.empty(self._views.arrays["word_starts"][-1], np.uint64)
        arguments = poses.ctypes.data, per_view, chosen.address, chosen.length
        self._run(self._library.sm_silhouettes, *arguments, words.ctypes.data)
        return words

    def _run(self, function, *arguments) -> None:
        scratch = self._take_scratch()
        code = function(*self._refs, *arguments, scratch.address, self._scratch_bytes)
        self._scratches.append(scratch)
        check(code)

    def _take_scratch(self) -> _Pointed:
        try:
            return self._scratches.pop()
        except IndexError:
            return _Pointed(np.empty(self._scratch_bytes, np.uint8))

    def _chosen(self, segments: Sequence[int] | None) -> _Pointed:
        key = None if segments is None else tuple(segments)
        chosen = self._segments.get(key)
        if chosen is None:
            assert key is not None
            checked = chosen_segments(self.body, key)
            chosen = self._segments[key] = _Pointed(np.array(checked, np.int32))
        return chosen

    def _checked(self, poses: np.ndarray) -> tuple[np.ndarray, int]:
        """Contiguous float64 poses, and whether they are per view."""
        poses = np.ascontiguousarray(poses, float)
        if poses.ndim == 2 and poses.shape[1] == self._body.dofs:
            return poses, 0
        if poses.ndim == 3 and poses.shape[1:] == (len(self.cameras), self._body.dofs):
            return poses, 1
        wanted = f"(N, {self._body.dofs}) or (N, {len(self.cameras)}, {self._body.dofs})"
        raise ValueError(f"expected poses of shape {wanted}, got {poses.shape}")
