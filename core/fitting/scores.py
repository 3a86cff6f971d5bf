"""How well a pose explains the silhouettes of a frame, view by view and limb by limb."""

from dataclasses import dataclass

import cv2
import numpy as np

from ..body.body import POINT_NAMES, Body
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from ..silhouettes.silhouette import Silhouette
from .part_search import metres_per_pixel

LIMB_NAMES = ("torso", "left_arm", "right_arm", "left_leg", "right_leg")
_EXPLAINED_SHARE = 0.6


@dataclass(frozen=True, eq=False)
class FrameScores:
    """Scores of one frame; V views.

    Attributes:
        xor_px: (V,) px that differ between observed and rendered silhouette.
        iou: (V,) intersection over union; NaN where both are empty.
        contour_px: median distance from the rendered contours to the observed ones.
        limb_residual: (5,) mean distance of each of `LIMB_NAMES`' own contour to the observed one,
            px; NaN where no view shows any of it.
        confidence: (14,) see `point_confidence`.
        lost: whether any limb's px are explained in fewer than 60 % of the views (SPEC §8).
    """

    xor_px: np.ndarray
    iou: np.ndarray
    contour_px: float
    limb_residual: np.ndarray
    confidence: np.ndarray
    lost: bool


def frame_scores(
    evaluator: Evaluator, pose: np.ndarray, silhouettes: tuple[Silhouette, ...]
) -> FrameScores:
    """Scores of ``pose`` (D,) against the V silhouettes."""
    rendered = evaluator.silhouettes(pose)
    xor, union = np.array(
        [_differences(s, model) for s, model in zip(silhouettes, rendered, strict=True)]
    ).T
    with np.errstate(invalid="ignore", divide="ignore"):
        iou = np.where(union > 0, 1.0 - xor / union, np.nan)
    limbs = [
        _limb_distances(evaluator.silhouettes(pose, segments), rendered, silhouettes)
        for segments in limb_segments(evaluator.body)
    ]
    distances = [_contour_distances(m, m, s) for m, s in zip(rendered, silhouettes, strict=True)]
    residual = np.array([_mean(np.concatenate(views)) for views, _ in limbs])
    lost = any(np.mean(shares) < _EXPLAINED_SHARE for _, shares in limbs if len(shares))
    contours = np.concatenate(distances)
    return FrameScores(
        xor_px=xor,
        iou=iou,
        contour_px=float(np.median(contours)) if len(contours) else np.nan,
        limb_residual=residual,
        confidence=point_confidence(evaluator.body, evaluator.cameras, residual),
        lost=bool(lost),
    )


def limb_segments(body: Body) -> tuple[tuple[int, ...], ...]:
    """The segments of each of `LIMB_NAMES`; the torso holds all that no limb moves."""
    limbs = {part.name: part.segments for part in body.parts if part.role == "limb"}
    moved = {segment for segments in limbs.values() for segment in segments}
    torso = tuple(s for s in range(len(body.segment_names)) if s not in moved)
    return (torso, *(limbs[name] for name in LIMB_NAMES[1:]))


def point_confidence(
    body: Body, cameras: tuple[Camera, ...], limb_residual: np.ndarray
) -> np.ndarray:
    """(14,) probability that each point is off by less than 50 mm, not calibrated on truth.

    The mean contour distance of the point's limb, in metres, is taken as the spread of a
    two-dimensional normal error.
    """
    limb_of_point = [_limb_of(name) for name in POINT_NAMES]
    pixel = metres_per_pixel(cameras, body.offsets[0])
    spread = np.maximum(np.nan_to_num(limb_residual, nan=np.inf) * pixel, 1e-4)
    return (1.0 - np.exp(-(0.05**2) / (2.0 * spread**2)))[limb_of_point]


def _limb_of(point: str) -> int:
    side, _, joint = point.partition("_")
    if joint in ("elbow", "wrist"):
        return LIMB_NAMES.index(f"{side}_arm")
    if joint in ("knee", "ankle"):
        return LIMB_NAMES.index(f"{side}_leg")
    return 0


def _differences(silhouette: Silhouette, model: np.ndarray) -> tuple[int, int]:
    """Px of the symmetric difference and of the union, where something was observed."""
    seen, drawn = silhouette.foreground & silhouette.observed, model & silhouette.observed
    return np.count_nonzero(seen ^ drawn), np.count_nonzero(seen | drawn)


def _contour(mask: np.ndarray) -> np.ndarray:
    """(H, W) bool: px of ``mask`` with a neighbour outside it; the picture's edge is no contour."""
    inner = cv2.erode(mask.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    return mask & ~inner


def _contour_distances(part: np.ndarray, model: np.ndarray, silhouette: Silhouette) -> np.ndarray:
    """(n,) px from the model's contour, as far as it belongs to ``part``, to the observed one."""
    observed = _contour(silhouette.foreground)
    if not observed.any():
        return np.zeros(0)
    distance = cv2.distanceTransform((~observed).astype(np.uint8), cv2.DIST_L2, 5)
    return distance[_contour(model) & part & silhouette.observed]


def _limb_distances(limb, rendered, silhouettes) -> tuple[list[np.ndarray], list[bool]]:
    """Contour distances per view, and whether the view explains most of the limb's px."""
    distances, explained = [], []
    for part, model, silhouette in zip(limb, rendered, silhouettes, strict=True):
        distances.append(_contour_distances(part, model, silhouette))
        drawn = part & silhouette.observed
        if drawn.any():
            explained.append(silhouette.foreground[drawn].mean() >= _EXPLAINED_SHARE)
    return distances, explained


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if len(values) else np.nan
