"""Every step of the rules as a picture, for users who want to see why.

Three panels for each view: the contour points and their spline, coloured by curvature; creases,
bulges and cuts; the labels and, once they are known, the joints in the world seen by this view.
"""

import cv2
import numpy as np

from ...cameras.camera import Camera
from ...silhouettes.silhouette import Silhouette
from .from_frames import DEFAULT, ContourSettings, check_kind, performer_in, seen_views
from .labelling import Labelled
from .outline import SPACING
from .seen_view import SeenView
from .skeleton import JOINT_NAMES

_TALL, _MARGIN, _HEAD = 560, 30, 46
"""px: one height of the performer, round it, and for the words above."""
_NARROWEST = 340
_INK, _FILL, _PAPER = (60, 60, 60), (235, 235, 235), (255, 255, 255)
_CONCAVE, _CONVEX, _CUT, _LABEL, _JOINT = (
    (30, 30, 220), (220, 120, 20), (40, 140, 40), (180, 30, 180), (0, 140, 255),
)  # fmt: skip
"""BGR."""
_SHARP = 40.0
"""Curvature of full colour."""
_BONES = (
    ("virtual_foot", "back"), ("back", "neck"),
    ("back", "left_shoulder"), ("left_shoulder", "left_elbow"), ("left_elbow", "left_wrist"),
    ("back", "right_shoulder"), ("right_shoulder", "right_elbow"), ("right_elbow", "right_wrist"),
)  # fmt: skip
_TITLES = ("contour points, spline, curvature", "creases, bulges and cuts", "labels and joints")


def drawn_steps(
    cameras: tuple[Camera, ...],
    silhouettes: tuple[Silhouette, ...],
    kind: str,
    joints: np.ndarray | None = None,
    settings: ContourSettings = DEFAULT,
) -> tuple[np.ndarray, ...]:
    """V pictures (H, W, 3) uint8 BGR of how the rules read one frame.

    Args:
        cameras: V pinhole cameras.
        silhouettes: what they see.
        kind: of the pose, "A", "T" or "elbows".
        joints: (9, 3) of a `ContourSkeleton` in this frame; None, or NaN, where there are none.
        settings: as the skeleton was found with.

    Raises:
        MocapError: an unknown kind.
    """
    check_kind(kind)
    performer = performer_in(cameras, silhouettes, settings)
    if performer is None:
        return tuple(_empty(camera.name, "fewer than two views show anybody") for camera in cameras)
    views = seen_views(cameras, silhouettes, performer, (kind, settings.mode))
    return tuple(_drawn(view, joints) for view in views)


def _drawn(view: SeenView, joints: np.ndarray | None) -> np.ndarray:
    if view.outline is None or view.upright is None:
        return _empty(view.camera.name, view.reason)
    sheet = _Sheet(view)
    panels = [sheet.curvature(), sheet.cuts(), sheet.joints(joints)]
    for panel, title in zip(panels, _TITLES, strict=True):
        _write(panel, title, 18)
    _write(panels[0], f"{view.camera.name}: {view.reason or 'labelled'}", 36)
    return np.hstack(panels)


def _empty(name: str, reason: str) -> np.ndarray:
    picture = np.full((_TALL + 2 * _MARGIN + _HEAD, 3 * _TALL, 3), _PAPER, np.uint8)
    _write(picture, f"{name}: {reason}", 36)
    return picture


def _write(picture: np.ndarray, words: str, row: int) -> None:
    cv2.putText(picture, words, (8, row), cv2.FONT_HERSHEY_SIMPLEX, 0.45, _INK, 1, cv2.LINE_AA)


class _Sheet:
    """The panels of one view."""

    def __init__(self, view: SeenView):
        assert view.outline is not None
        self._view, self._outline = view, view.outline
        points = self._outline.points
        self._wide = max(_NARROWEST, round(_TALL * float(np.ptp(points[:, 0]))) + 2 * _MARGIN)
        self._middle = float((points[:, 0].min() + points[:, 0].max()) / 2)

    def curvature(self) -> np.ndarray:
        """The contour points, and the spline in the colours of its curvature."""
        picture = self._paper()
        places = self._px(self._outline.points)
        strengths = np.clip(self._outline.curvature / _SHARP, -1.0, 1.0)
        ends = np.roll(places, -1, axis=0)
        for begin, end, strength in zip(places, ends, strengths, strict=True):
            colour = _mixed(_INK, _CONVEX if strength > 0 else _CONCAVE, abs(float(strength)))
            cv2.line(picture, begin.tolist(), end.tolist(), colour, 4, cv2.LINE_AA)
        length = self._outline.spline.t[-4]
        knots = self._outline.spline(np.arange(0.0, length, SPACING))
        for place in self._px(knots):
            cv2.circle(picture, place.tolist(), 1, _PAPER, -1, cv2.LINE_AA)
        return picture

    def cuts(self) -> np.ndarray:
        """Creases, bulges and the cuts that the rules take."""
        picture = self._paper()
        for indices, colour in (
            (self._outline.bulges, _CONVEX),
            (self._outline.creases, _CONCAVE),
        ):
            for place in self._px(self._outline.points[indices]):
                cv2.circle(picture, place.tolist(), 5, colour, 1, cv2.LINE_AA)
        if self._view.joints is not None:
            for cut in self._view.joints.cuts.values():
                first, last = self._px(cut.ends).tolist()
                cv2.line(picture, first, last, _CUT, 2, cv2.LINE_AA)
        return picture

    def joints(self, joints: np.ndarray | None) -> np.ndarray:
        """Labels as discs, the joints in the world as a skeleton."""
        picture = self._paper()
        if joints is not None and np.isfinite(joints).all():
            self._draw_skeleton(picture, joints)
        if self._view.joints is not None:
            for place in self._px(_labels(self._view.joints)):
                cv2.circle(picture, place.tolist(), 5, _LABEL, -1, cv2.LINE_AA)
        return picture

    def _draw_skeleton(self, picture: np.ndarray, joints: np.ndarray) -> None:
        assert self._view.upright is not None
        seen = self._px(self._view.upright.from_px(self._view.camera.project(joints)))
        for ends in _BONES:
            begin, end = (seen[JOINT_NAMES.index(name)].tolist() for name in ends)
            cv2.line(picture, begin, end, _JOINT, 2, cv2.LINE_AA)
        for place in seen:
            cv2.drawMarker(picture, place.tolist(), _JOINT, cv2.MARKER_CROSS, 14, 2)

    def _paper(self) -> np.ndarray:
        picture = np.full((_TALL + 2 * _MARGIN + _HEAD, self._wide, 3), _PAPER, np.uint8)
        places = self._px(self._outline.points)
        cv2.fillPoly(picture, [places], _FILL)
        cv2.polylines(picture, [places], True, _INK, 1, cv2.LINE_AA)
        return picture

    def _px(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) int32 px of points (n, 2) in heights."""
        across = self._wide / 2 + _TALL * (points[:, 0] - self._middle)
        down = _HEAD + _MARGIN + _TALL * (1.0 - points[:, 1])
        return np.stack([across, down], axis=1).round().astype(np.int32)


def _labels(joints: Labelled) -> np.ndarray:
    middle = [joints.back[None], joints.neck[None]]
    return np.concatenate([*middle, joints.shoulders, joints.elbows, joints.wrists, joints.ankles])


def _mixed(one: tuple[int, ...], other: tuple[int, ...], share: float) -> tuple[int, ...]:
    return tuple(round(a + (b - a) * share) for a, b in zip(one, other, strict=True))
