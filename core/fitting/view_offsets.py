"""How far each camera's pictures are beside where the tracked poses say they should be.

A camera that stands otherwise than calibrated sees everything beside its place; one that is out of
step sees another moment; one whose silhouettes are swollen sees the outline further out. To first
order each of these moves the model's outline with a known velocity, and so do the DOFs of the pose.
From the distances between outlines and observed contours all are estimated at once, by weighted
least squares. As every lie has pulled the poses a little, they are left free: the DOFs of each
frame are eliminated from its normal equations (Schur complement, as in Triggs et al., Bundle
Adjustment: A Modern Synthesis, 2000, section 6).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..body.body import DofKind
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator, Outline
from .scores import metres_at
from .twists import Twists

OFFSETS = ("right", "down", "turn", "swelling", "delay")
"""Of a view: px to the right and downwards, rad clockwise about the picture's middle, px by which
its silhouettes are larger all round, and frames by which its pictures are early."""
_SPACING_M = 0.03
_ROBUST_M = 0.1
"""Distance at which a point counts for a quarter."""
_DEVIATION_M = 0.015
_PULL_M, _PULL_RAD = 0.1, 0.5
"""Standard deviations: of a point's distance, and of the poses' translations and angles."""


@dataclass(frozen=True, eq=False)
class Moment:
    """One frame, seen by V views.

    Attributes:
        poses: (3, V, D) one frame before what each view shows, as it shows it, and one after.
        fields: V `ObservedContour.field`; None for a view that says nothing.
        known: (V, 5) `OFFSETS` that are known already; ``poses`` have the delays in them.
    """

    poses: np.ndarray
    fields: Sequence[np.ndarray | None]
    known: np.ndarray


class OffsetEquations:
    """Makes the normal equations of a body's views.

    The unknowns are the `OFFSETS` of V views, one view after the other, and the body's girth, in
    metres, by which all silhouettes are larger alike: P = 5 V + 1.

    Args:
        evaluator: draws the body.
    """

    def __init__(self, evaluator: Evaluator):
        self._evaluator, self._twists = evaluator, Twists(evaluator.body)
        kinds = evaluator.body.dofs.kinds
        pulls = np.where(kinds == DofKind.TRANSLATION, _PULL_M, _PULL_RAD)
        self._held = np.diag(_DEVIATION_M**2 / pulls**2)
        self.unknowns = len(evaluator.cameras) * len(OFFSETS) + 1

    def of(self, moment: Moment) -> tuple[np.ndarray, np.ndarray]:
        """(P, P) and (P,) of one moment: of the squared distances' sum, in m^2, halved."""
        own, mixed, sums = self._whole(moment)
        reduced = sums - mixed.T @ np.linalg.solve(own, mixed)
        return reduced[:-1, :-1], reduced[:-1, -1]

    def freed(self, moment: Moment) -> np.ndarray:
        """(D,) what the pose would change, if it had not been pulled by what is ``known``."""
        own, mixed, _ = self._whole(moment)
        return -np.linalg.solve(own, mixed @ np.r_[moment.known.ravel(), 0.0, 1.0])

    def _whole(self, moment: Moment) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(D, D), (D, P + 1) and (P + 1, P + 1), the last of P + 1 being the distances."""
        poses = moment.poses[1]
        metres = metres_at(self._evaluator, poses[0])
        outlines = self._evaluator.outline(poses, None, float(_SPACING_M / metres.max()))
        ends = [self._evaluator.transforms(moment.poses[end]) for end in (0, 2)]
        dofs = poses.shape[1]
        own, mixed = self._held.copy(), np.zeros((dofs, self.unknowns + 1))
        sums = np.zeros((self.unknowns + 1,) * 2)
        for view, field in enumerate(moment.fields):
            if field is None or not len(outlines[view].px):
                continue
            placed, moving = self._twists.at(poses[view])
            motion = np.stack([placed, ends[0][view], ends[1][view]])
            joined = self._joined(outlines[view], view, motion, field, moment.known[view])
            joined *= metres[view] ** 2
            # what moves with the view itself, with the girth, and the distances
            first = view * len(OFFSETS)
            places = [*range(first, first + len(OFFSETS)), self.unknowns - 1, self.unknowns]
            scales = np.r_[np.ones(len(OFFSETS)), 1 / metres[view], 1.0]
            by_joint = moving @ joined[:, :6]
            across = np.moveaxis(moving, 1, 0).reshape(dofs, -1)
            own += np.moveaxis(by_joint[:, :, :6], 1, 0).reshape(dofs, -1) @ across.T
            mixed[:, places] += by_joint[:, :, 6:].sum(axis=0) * scales
            sums[np.ix_(places, places)] += joined[:, 6:, 6:].sum(axis=0) * np.outer(scales, scales)
        return own, mixed, sums

    def misfits(self, moment: Moment) -> np.ndarray:
        """(V,) robust mean distances between outlines and contours, from 0 to 1."""
        poses, found = moment.poses[1], np.zeros(len(moment.fields))
        metres = metres_at(self._evaluator, poses[0])
        outlines = self._evaluator.outline(poses, None, float(_SPACING_M / metres.max()))
        for view, field in enumerate(moment.fields):
            if field is None:
                continue
            camera = self._evaluator.cameras[view]
            distances = _distances(field, camera, outlines[view], moment.known[view])
            squares = (distances[np.isfinite(distances)] * metres[view] / _ROBUST_M) ** 2
            found[view] = np.mean(squares / (1.0 + squares)) if len(squares) else 0.0
        return found

    def _joined(
        self,
        outline: Outline,
        view: int,
        motion: np.ndarray,
        field: np.ndarray,
        known: np.ndarray,
    ) -> np.ndarray:
        """(J, 13, 13) weighted sums of products of what each point's distance depends on.

        The joint's twist (6), the offsets (5), the girth, and the distance itself, all in px.
        ``motion`` (3, J, 3, 4) places the joints now, a frame before and after.
        """
        camera = self._evaluator.cameras[view]
        joints = self._evaluator.body.segment_joints[outline.segments]
        distances = _distances(field, camera, outline, known)
        velocities = _velocities(outline, joints, camera, motion[1:])
        lines = _lines(outline, joints, camera, motion[0])
        metre = 1.0 / np.linalg.norm(lines[:, :3], axis=1).mean()
        weights = 1.0 / (1.0 + (distances * metre / _ROBUST_M) ** 2) ** 2
        # the equations are of the whole offsets, not of what is left to find
        whole = distances - velocities @ known
        rows = np.column_stack([lines, velocities, velocities[:, 3], whole])
        usable = np.isfinite(rows).all(axis=1)
        found = np.zeros((motion.shape[1], rows.shape[1], rows.shape[1]))
        for joint in np.unique(joints[usable]):
            own = rows[usable & (joints == joint)]
            found[joint] = (own * weights[usable & (joints == joint), None]).T @ own
        return found


def _arms(outline: Outline, camera: Camera) -> np.ndarray:
    """(n, 2) px from the picture's middle."""
    return outline.px - (np.array(camera.size) - 1) / 2


def _distances(
    field: np.ndarray, camera: Camera, outline: Outline, known: np.ndarray
) -> np.ndarray:
    """(n,) px that points, moved by ``known`` offsets (5,), lie outside the contour, or NaN."""
    arms = _arms(outline, camera)
    moved = outline.px + known[:2] + known[2] * np.column_stack([-arms[:, 1], arms[:, 0]])
    x, y = np.ascontiguousarray(moved.T, np.float32)
    nothing = {"borderMode": cv2.BORDER_CONSTANT, "borderValue": (np.nan,)}
    found = cv2.remap(field, x[:, None], y[:, None], cv2.INTER_LINEAR, **nothing)
    return found[:, 0].astype(float) + known[3]


def _velocities(
    outline: Outline, joints: np.ndarray, camera: Camera, ends: np.ndarray
) -> np.ndarray:
    """(n, 5) px outwards per unit of the `OFFSETS`; ``ends`` (2, J, 3, 4) are two frames apart."""
    (x, y), arms = outline.normals.T, _arms(outline, camera)
    before, after = (camera.project(_placed(outline, end[joints])) for end in ends)
    per_frame = (outline.normals * (after - before)).sum(axis=1) / 2
    turning = y * arms[:, 0] - x * arms[:, 1]
    return np.column_stack([x, y, turning, np.ones(len(x)), per_frame])


def _lines(
    outline: Outline, joints: np.ndarray, camera: Camera, transforms: np.ndarray
) -> np.ndarray:
    """(n, 6) px outwards per unit of the twist of each point's joint."""
    points = _placed(outline, transforms[joints])
    projection = camera.projection[:, :3]
    along = outline.normals @ projection[:2]
    along -= (outline.normals * outline.px).sum(axis=1)[:, None] * projection[2]
    along /= camera.depths(points)[:, None]
    return np.column_stack([along, np.cross(points, along)])


def _placed(outline: Outline, transforms: np.ndarray) -> np.ndarray:
    """(n, 3) where the points are by the transforms (n, 3, 4) of their joints."""
    return np.einsum("nij,nj->ni", transforms[:, :, :3], outline.points) + transforms[:, :, 3]
