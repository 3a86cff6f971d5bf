"""What both modes share: cameras and poses checked, fixed parts masked, bounds and transforms."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, TypeVar

import numpy as np

from ...body.body import Body
from ...body.kinematics import skinned_segments
from ...cameras.camera import Camera
from ...energy.evaluator import Outline, WeightMaps
from ..arguments import (
    Sizes,
    check_weights,
    checked_level,
    checked_maps,
    chosen_segments,
    fixed_segments,
    picture_sizes,
)
from ..model import check_cameras
from ..native import NativeEvaluator
from .canvas import DeviceMesh, Range, drawing_range
from .context import GlThread, no_opengl, shared_thread
from .meshes import segment_mesh
from .placing import Placement, Placer
from .tiles import Tiles, clipped_windows

_MOST_MESHES = 64


@dataclass(frozen=True, eq=False)
class MaskedMaps:
    """Weight maps, as far as energies need them.

    Attributes:
        maps: V arrays (H, W) int16; 0 where fixed parts cover and outside of the windows.
        constants: (V,) int64, the energy of an empty rendering, fixed parts included.
        windows: (V, 4) px x0, y0, x1, y1; nothing lies outside.
        sizes: of the V pictures.
    """

    maps: tuple[np.ndarray, ...]
    constants: np.ndarray
    windows: np.ndarray
    sizes: Sizes


@dataclass(frozen=True, eq=False)
class HeldWeights:
    """Weight maps as a mode holds them.

    Attributes:
        masked: the maps as they are.
    """

    masked: MaskedMaps

    @property
    def constants(self) -> np.ndarray:
        """(V,) int64, the energy of an empty rendering, fixed parts included."""
        return self.masked.constants

    @property
    def sizes(self) -> Sizes:
        """(width, height) px of the V pictures."""
        return self.masked.sizes


Held = TypeVar("Held", bound=HeldWeights)


def check_version(thread: GlThread, wanted: tuple[int, int]) -> None:
    """Raises a MocapError unless the context is as new as ``wanted``."""
    if thread.version < wanted:
        have, need = (".".join(map(str, version)) for version in (thread.version, wanted))
        raise no_opengl(f"{thread.renderer} has version {have}, older than {need}")


def check_sizes(thread: GlThread, cameras: Sequence[Camera]) -> Range:
    """What can be drawn, which the cameras' pictures are part of.

    Raises:
        MocapError: a picture is too large.
    """
    reach = thread.call(drawing_range, thread.gl)
    largest = max(max(camera.size) for camera in cameras)
    if largest > reach.largest:
        raise no_opengl(f"it draws pictures of at most {reach.largest} px, one has {largest}")
    return reach


class OpenGLBase(Generic[Held]):
    """A body and cameras, and the thread that draws the one as seen by the others.

    Args:
        body: the model.
        cameras: V pinhole cameras, of any sizes.
        level: which of the body's surfaces to draw.
        thread: the thread with the context; by default the one that all share.

    Raises:
        ValueError: a camera with lens distortion or too large pictures, or no such level.
        MocapError: there is no OpenGL, or it is too old, or a picture is too large for it.
    """

    version = (3, 3)
    """Of OpenGL, at least."""
    weights_kind: type[HeldWeights] = HeldWeights
    """What `prepared` makes."""

    def __init__(
        self,
        body: Body,
        cameras: Sequence[Camera],
        level: int = 0,
        thread: GlThread | None = None,
    ):
        check_cameras(cameras)
        if skinned_segments(body, body.surfaces[checked_level(body, level)]).any():
            raise no_opengl("it draws rigid segments only")
        self.body, self.cameras, self.level = body, tuple(cameras), level
        self.thread = thread or shared_thread()
        check_version(self.thread, self.version)
        self._range = check_sizes(self.thread, cameras)
        self._picture_sizes = picture_sizes(cameras)
        self._sizes = np.array(self._picture_sizes, np.int64)
        self._placer = Placer(body, cameras, level)
        self._meshes: dict[tuple[int, ...], DeviceMesh] = {}

    def prepared(self, maps: WeightMaps) -> Held:
        """The maps in the mode's own form."""
        return self._held(self._whole(maps))

    def masked(
        self,
        weights: Held,
        pose: np.ndarray,
        moving: Sequence[int],
        windows: np.ndarray | None = None,
    ) -> Held:
        """Weights under which the ``moving`` segments alone give the full energy.

        ``pose`` may be (V, D) as well, one pose per view.
        """
        self._check(weights)
        return self._held(self._masked(weights.masked, pose, moving, windows))

    def transforms(self, poses: np.ndarray) -> np.ndarray:
        """(N, J, 3, 4) float64 world from joint of poses (N, D)."""
        poses = self._checked(poses)
        if poses.ndim == 3:
            raise ValueError("expected poses (N, D)")
        return self._placer.transforms(poses)[0]

    def bounds(self, poses: np.ndarray, segments: Sequence[int]) -> np.ndarray:
        """(N, V, 4) int: x0, y0, x1, y1 (exclusive), px that the segments can cover, unclipped.

        The whole guard region (16,000 px either way) where a segment leaves it or comes too near.
        """
        transforms = self._placer.transforms(self._checked(poses))
        return self._placer.bounds(transforms, self._chosen(segments))

    def silhouettes(
        self, pose: np.ndarray, segments: Sequence[int] | None = None
    ) -> tuple[np.ndarray, ...]:
        """V boolean pictures (H, W), True where the body covers the pixel's centre."""
        pose = self._checked(np.asarray(pose, float)[None])
        chosen = self._chosen(segments)
        return self.thread.call(self._draw_silhouettes, pose, chosen)

    def outline(
        self, pose: np.ndarray, segments: Sequence[int] | None = None, spacing_px: float = 1.0
    ) -> tuple[Outline, ...]:
        """V outlines of what the segments cover, in steps of at most ``spacing_px``.

        The native kernel's: what it covers differs by single pixels from what OpenGL does.
        """
        return self._kernel.outline(pose, segments, spacing_px)

    @cached_property
    def _kernel(self) -> NativeEvaluator:
        return NativeEvaluator(self.body, self.cameras, self.level)

    def _check(self, weights: Held) -> None:
        """Refuses with a ValueError weights that are not the mode's own, or of other sizes."""
        check_weights(weights, self.weights_kind, self._picture_sizes)

    def _held(self, masked: MaskedMaps) -> Held:
        raise NotImplementedError

    def _draw_silhouettes(
        self, pose: np.ndarray, segments: tuple[int, ...]
    ) -> tuple[np.ndarray, ...]:
        raise NotImplementedError

    def _whole(self, maps: WeightMaps) -> MaskedMaps:
        maps = checked_maps(maps, self._picture_sizes)
        windows = clipped_windows(self._sizes, None)
        return MaskedMaps(maps.maps, maps.constants, windows, self._picture_sizes)

    def _masked(
        self,
        before: MaskedMaps,
        pose: np.ndarray,
        moving: Sequence[int],
        windows: np.ndarray | None,
    ) -> MaskedMaps:
        fixed = fixed_segments(self.body, moving)
        within = clipped_windows(self._sizes, windows)
        low = np.maximum(within[:, :2], before.windows[:, :2])
        high = np.maximum(np.minimum(within[:, 2:], before.windows[:, 2:]), low)
        maps, constants = [], before.constants.copy()
        covered = self.silhouettes(pose, fixed)
        for v, (weight_map, picture) in enumerate(zip(before.maps, covered, strict=True)):
            constants[v] += weight_map[picture].sum(dtype=np.int64)
            left = np.zeros_like(weight_map)
            part = np.s_[low[v, 1] : high[v, 1], low[v, 0] : high[v, 0]]
            left[part] = np.where(picture[part], 0, weight_map[part])
            maps.append(left)
        return MaskedMaps(tuple(maps), constants, np.concatenate([low, high], axis=1), before.sizes)

    def _placed(self, transforms: np.ndarray, segments: tuple[int, ...], tiles: Tiles) -> Placement:
        """The segments in the tiles' windows, of transforms (V or 1, N, J, 3, 4)."""
        # snapping may move a vertex by half a step
        margin = self._range.margin - 1
        return self._placer.placed(transforms, segments, tiles.views, tiles.windows, margin)

    def _mesh(self, segments: tuple[int, ...]) -> DeviceMesh:
        """The segments' mesh; in the thread only."""
        if segments not in self._meshes:
            if len(self._meshes) >= _MOST_MESHES:
                del self._meshes[next(iter(self._meshes))]
            mesh = segment_mesh(self._placer.surface, segments)
            self._meshes[segments] = DeviceMesh(self.thread, mesh)
        return self._meshes[segments]

    def _chosen(self, segments: Sequence[int] | None) -> tuple[int, ...]:
        everything = tuple(range(len(self.body.segment_names)))
        return everything if segments is None else chosen_segments(self.body, segments)

    def _checked(self, poses: np.ndarray) -> np.ndarray:
        """float64 poses (N, D) or (N, V, D)."""
        poses = np.ascontiguousarray(poses, float)
        dofs, views = len(self.body.dofs), len(self.cameras)
        if poses.shape[1:] not in ((dofs,), (views, dofs)):
            wanted = f"(N, {dofs}) or (N, {views}, {dofs})"
            raise ValueError(f"expected poses of shape {wanted}, got {poses.shape}")
        return poses
