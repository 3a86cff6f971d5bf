"""What a pose leaves unexplained once the silhouettes' edges are forgiven.

Noise and a body of slightly other girth leave thin seams along the contours; a limb that is lost
leaves lumps: where the footage shows it and the model does not, and where the model draws it and
the footage shows nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import cv2
import numpy as np

from ..body.body import Body
from ..energy.evaluator import Evaluator
from ..geometry.boxes import box_round
from ..rendering.arguments import fixed_segments
from ..silhouettes.silhouette import Silhouette

THICK_M = 0.045
"""Thinner differences are none."""
_DROPPED = 0.6
"""Share of a limb's visible part that is background where a view has dropped it."""
_IN_PLACE, _WITNESSES = 0.3, 2
"""Share of it that is background at most in a view that shows it in its place; so many such views
prove the others wrong."""
_ALL_GONE = 0.85
"""Share of it, in all views together, that is too much for a limb that has only moved."""
_NEAR_M = 0.08
"""Beside a limb that a view has dropped, where it tells nothing either."""
_REACHED = 1.15
"""Times a limb's length that lumps may be away from its first joint."""
_UNUSUAL, _MUCH_M2 = 1.5, 0.015
"""Lumps that leave a pose unexplained: so many times the usual ones, and so much more."""


@dataclass(frozen=True, eq=False)
class Lumps:
    """The lumps of one pose in V views.

    Attributes:
        missing: V arrays (n, 2) of px (x, y), foreground that the model leaves uncovered.
        surplus: likewise, background that the model covers.
        metres: (V,) m that a pixel is wide where the performer stands.
    """

    missing: tuple[np.ndarray, ...]
    surplus: tuple[np.ndarray, ...]
    metres: np.ndarray

    @classmethod
    def of(
        cls,
        rendered: Sequence[np.ndarray],
        silhouettes: Sequence[Silhouette],
        metres: np.ndarray,
    ) -> "Lumps":
        """Those between what a model covers, V pictures (H, W), and the silhouettes."""
        missing, surplus = [], []
        for model, silhouette, metre in zip(rendered, silhouettes, metres.tolist(), strict=True):
            differing = (silhouette.foreground ^ model) & silhouette.observed
            missing.append(_thick(differing & silhouette.foreground, metre))
            surplus.append(_thick(differing & model, metre))
        return cls(tuple(missing), tuple(surplus), metres)

    def __bool__(self) -> bool:
        return any(map(len, (*self.missing, *self.surplus)))

    def of_limbs(
        self,
        evaluator: Evaluator,
        pose: np.ndarray,
        limbs: Sequence[Sequence[int]],
        weights: np.ndarray,
    ) -> np.ndarray:
        """(2, len(limbs)) m^2 of lumps that each limb may explain, missing and surplus.

        They are summed over views by their ``weights`` (V,). What is missing may belong to any
        limb, given by its segments, that reaches there from where it is in ``pose`` (D,); surplus
        belongs to what is drawn there.
        """
        areas = np.zeros((2, len(limbs)))
        if not self:
            return areas
        shares = weights * self.metres**2
        places = evaluator.transforms(pose[None])[0, :, :, 3]
        reaches = [first_joint_and_length(evaluator.body, tuple(limb)) for limb in limbs]
        joints, lengths = np.array([r[0] for r in reaches]), np.array([r[1] for r in reaches])
        for view, px in enumerate(self.missing):
            if len(px):
                roots = evaluator.cameras[view].project(places[joints])
                apart = np.hypot(px[:, 0] - roots[:, :1], px[:, 1] - roots[:, 1:])
                within = apart < (_REACHED * lengths / self.metres[view])[:, None]
                areas[0] += shares[view] * within.sum(axis=1)
        for index, segments in enumerate(limbs if any(map(len, self.surplus)) else ()):
            drawn = evaluator.silhouettes(pose, segments)
            for view, px in enumerate(self.surplus):
                areas[1, index] += shares[view] * np.count_nonzero(drawn[view][px[:, 1], px[:, 0]])
        return areas


def unexplained(lumps: np.ndarray, usual: np.ndarray) -> bool:
    """Whether a pose leaves more in ``lumps`` (L,) than is ``usual`` (L,), for any limb."""
    return bool((lumps > _UNUSUAL * usual + _MUCH_M2).any())


def dropped(
    evaluator: Evaluator,
    pose: np.ndarray,
    segments: Sequence[int],
    silhouettes: Sequence[Silhouette],
    metres: np.ndarray,
) -> tuple[np.ndarray | None, ...]:
    """V pictures of where a limb should be seen in ``pose`` (D,), and is background for the most.

    None in views that show most of it, or where the rest of the body hides it, and in all views
    where the limb may as well have moved: unless two views at least show it in its place, or nearly
    all of it is gone in all views together. The pictures reach a little beyond the limb. ``metres``
    (V,) are those that a pixel is wide.
    """
    others = fixed_segments(evaluator.body, segments)
    limbs = evaluator.silhouettes(pose, segments)
    pictures = zip(limbs, evaluator.silhouettes(pose, others), silhouettes, strict=True)
    counts = np.array([_seen_and_gone(*picture) for picture in pictures])
    seen, gone = (counts * metres[:, None] ** 2).T
    visible = seen > THICK_M**2
    lost = visible & (gone > _DROPPED * seen)
    in_place = visible & (gone < _IN_PLACE * seen)
    if in_place.sum() < _WITNESSES and gone.sum() < _ALL_GONE * seen.sum():
        lost[:] = False
    return tuple(
        _beyond(limb, metre) if drop else None
        for limb, metre, drop in zip(limbs, metres.tolist(), lost.tolist(), strict=True)
    )


def _seen_and_gone(limb: np.ndarray, rest: np.ndarray, silhouette: Silhouette) -> tuple[int, int]:
    """Px of a limb beside the rest of the body, and of those that are background."""
    visible = limb & ~rest & silhouette.observed
    return np.count_nonzero(visible), np.count_nonzero(visible & ~silhouette.foreground)


def _beyond(drawn: np.ndarray, metre: float) -> np.ndarray:
    """What is drawn and what is near."""
    side = 2 * round(_NEAR_M / metre) + 1
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    return cv2.dilate(drawn.view(np.uint8), kernel).astype(bool)


@lru_cache(maxsize=64)
def first_joint_and_length(body: Body, segments: tuple[int, ...]) -> tuple[int, float]:
    """The joint that carries a limb's segments, and how far away its farthest end can be, m."""
    joints = sorted({int(joint) for joint in body.segment_joints[list(segments)]})
    lengths = {joints[0]: 0.0}
    for joint in joints[1:]:
        above = lengths.get(int(body.parents[joint]), 0.0)
        lengths[joint] = above + float(np.linalg.norm(body.offsets[joint]))
    ends = [lengths[joint] + float(np.linalg.norm(body.tails[joint])) for joint in joints]
    return joints[0], max(ends)


def _thick(differing: np.ndarray, metre: float) -> np.ndarray:
    """(n, 2) px (x, y) where more than a seam differs."""
    side = max(3, round(THICK_M / metre) | 1)
    # beside a camera the kernel is far larger than the picture; half of it fits in at an edge
    extents = (axis.stop - axis.start for axis in box_round(differing))
    if any(a <= side // 2 and a < b for a, b in zip(extents, differing.shape, strict=True)):
        return np.zeros((0, 2), int)
    # with room for what erodes the lumps from outside
    rows, columns = box_round(differing, margin_px=side)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
    opened = cv2.morphologyEx(differing[rows, columns].view(np.uint8), cv2.MORPH_OPEN, kernel)
    y, x = np.nonzero(opened)
    return np.stack([x + columns.start, y + rows.start], axis=1)
