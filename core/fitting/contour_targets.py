"""What outlines are drawn towards, and the normal equations of doing so.

Points of an outline are drawn along the distance field of the observed contour; points of the
contour draw the nearest point of the outline that looks the same way. Both directions together
leave neither surplus nor missing parts unexplained (Rosenhahn, Brox, Weickert, IJCV 73, 2007,
section 3, has the second).
"""

from collections.abc import Sequence
from ctypes import byref
from dataclasses import dataclass

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator, Outline
from ..native.library import PointsRecord, TargetsRecord, check, load
from ..silhouettes.observed_contour import ObservedContour
from ..silhouettes.silhouette import Silhouette

_TERMS, _ROWS, _BLOCK = 50, 48, 32


@dataclass(frozen=True, eq=False)
class ContourTerms:
    """Normal equations of the distances r between outlines and contours, by view and joint.

    Attributes:
        squares: (V, J, 6, 6) sums of w l l', with l (6,) the change of r with the joint's twist.
        slopes: (V, J, 6) sums of w r l; r in metres.
        cost: (V, J) sums of the robust squares, m^2.
        count: (V, J) number of distances.
    """

    squares: np.ndarray
    slopes: np.ndarray
    cost: np.ndarray
    count: np.ndarray

    def gathered(self, twists: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Those of the pose: (D, D) and (D,), from the joints' `Twists.at` (J, D, 6)."""
        dofs = twists.shape[1]
        across = np.moveaxis(twists, 1, 0).reshape(dofs, -1)
        weighed = np.moveaxis(twists @ self.squares.sum(axis=0), 1, 0).reshape(dofs, -1)
        return weighed @ across.T, across @ self.slopes.sum(axis=0).ravel()


class ContourTargets:
    """The observed contours of one frame in V views.

    Args:
        body: whose outline is drawn towards them.
        cameras: V pinhole cameras.
        contours: V observed contours.
        metres: (V,) m that a pixel is wide where the performer stands.

    Attributes:
        shares: (V,) that the views have in the normal equations; 1 to begin with.
    """

    def __init__(
        self,
        body: Body,
        cameras: Sequence[Camera],
        contours: Sequence[ObservedContour],
        metres: np.ndarray,
    ):
        self._segment_joints = np.ascontiguousarray(body.segment_joints, np.int32)
        self._shape = len(cameras), len(body.joint_names)
        sizes = np.array([camera.size for camera in cameras], np.int32)
        if [contour.field.shape for contour in contours] != [(h, w) for w, h in sizes.tolist()]:
            raise ValueError("expected one contour of each camera's size")
        self._fields = [np.ascontiguousarray(contour.field, np.float32) for contour in contours]
        self._arrays = {
            "sizes": sizes,
            "fields": np.array([field.ctypes.data for field in self._fields], np.uintp),
            "starts": _starts(np.array([len(contour.px) for contour in contours])),
            "px": np.concatenate([contour.px for contour in contours]),
            "normals": np.concatenate([contour.normals for contour in contours]),
            "projections": np.stack([camera.projection for camera in cameras]),
            "metres": np.ascontiguousarray(metres, float),
        }
        addresses = {name: array.ctypes.data for name, array in self._arrays.items()}
        self._record = TargetsRecord(len(cameras), load().sm_processor(), **addresses)
        self.shares = np.ones(len(cameras))

    @classmethod
    def of(
        cls,
        evaluator: Evaluator,
        silhouettes: Sequence[Silhouette],
        metres: np.ndarray,
        spacing_m: float,
    ) -> "ContourTargets":
        """The contours of V silhouettes, their points about ``spacing_m`` apart."""
        contours = [
            silhouette.contour.thinned(spacing)
            for silhouette, spacing in zip(silhouettes, (spacing_m / metres).tolist(), strict=True)
        ]
        return cls(evaluator.body, evaluator.cameras, contours, metres)

    def terms(
        self, outlines: Sequence[Outline], transforms: np.ndarray, reach_m: float, turn_m: float
    ) -> ContourTerms:
        """Normal equations of V outlines that were drawn with transforms (J, 3, 4).

        Distances beyond ``reach_m`` count for less and less (Geman and McClure); the nearest point
        of an outline is sought as if normals that differ by a radian were ``turn_m`` apart.
        """
        arrays = {
            name: np.concatenate([getattr(outline, name) for outline in outlines])
            for name in ("segments", "points", "px", "normals")
        }
        arrays["starts"] = _starts(np.array([len(outline.px) for outline in outlines]))
        room = len(arrays["px"])
        points = PointsRecord(room, **{name: array.ctypes.data for name, array in arrays.items()})
        self._record.reach, self._record.turn = reach_m, turn_m
        transforms = np.ascontiguousarray(transforms, float)
        out, scratch = np.empty((*self._shape, _TERMS)), np.empty((4, room + _BLOCK), np.float32)
        check(
            load().sm_contour_terms(
                byref(self._record), byref(points), transforms.ctypes.data, self._shape[1],
                self._segment_joints.ctypes.data, out.ctypes.data, scratch.ctypes.data,
            )
        )  # fmt: skip
        out *= self.shares[:, None, None]
        rows = out[..., :_ROWS].reshape(*self._shape, 6, 8)
        return ContourTerms(rows[..., :6], rows[..., 6], out[..., -2], out[..., -1])


def _starts(counts: np.ndarray) -> np.ndarray:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
