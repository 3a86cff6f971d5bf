"""How well a pose explains the silhouettes of a frame, view by view and limb by limb."""

from dataclasses import dataclass

import numpy as np

from ..body.body import POINT_NAMES, Body
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
    fields = [silhouette.distances for silhouette in silhouettes]

    def distances_of(parts: tuple[np.ndarray, ...]) -> np.ndarray:
        views = zip(parts, rendered, fields, silhouettes, strict=True)
        seen = [(p, m, d, s.observed) for p, m, d, s in views if s.foreground.any()]
        return np.concatenate([contour_distances(*view) for view in seen] or [np.zeros(0)])

    limbs = [evaluator.silhouettes(pose, segments) for segments in limb_segments(evaluator.body)]
    residual = np.array([_figure(np.mean, distances_of(parts)) for parts in limbs])
    place = evaluator.transforms(pose[None])[0, 0, :, 3]
    return FrameScores(
        xor_px=xor,
        iou=iou,
        contour_px=_figure(np.median, distances_of(rendered)),
        limb_residual=residual,
        confidence=point_confidence(residual * metres_per_pixel(evaluator.cameras, place)),
        lost=any(_is_unexplained(parts, silhouettes) for parts in limbs),
    )


def limb_segments(body: Body) -> tuple[tuple[int, ...], ...]:
    """The segments of each of `LIMB_NAMES`; the torso holds all that no limb moves."""
    limbs = {part.name: part.segments for part in body.parts if part.role == "limb"}
    moved = {segment for segments in limbs.values() for segment in segments}
    torso = tuple(s for s in range(len(body.segment_names)) if s not in moved)
    return (torso, *(limbs[name] for name in LIMB_NAMES[1:]))


def point_confidence(limb_residual: np.ndarray) -> np.ndarray:
    """(14,) probability that each point is off by less than 50 mm, not calibrated on truth.

    The mean contour distance (5,) of the point's limb, in metres, is taken as the spread of a
    two-dimensional normal error; a limb that no view shows has none.
    """
    spread = np.maximum(np.nan_to_num(limb_residual, nan=np.inf), 1e-4)
    return (1.0 - np.exp(-(0.05**2) / (2.0 * spread**2)))[[limb_of(n) for n in POINT_NAMES]]


def limb_of(point: str) -> int:
    """Index in `LIMB_NAMES` of the limb that moves a point of `POINT_NAMES`."""
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


def contour_distances(
    part: np.ndarray, model: np.ndarray, distance: np.ndarray, observed: np.ndarray
) -> np.ndarray:
    """(n,) px from the model's contour, as far as it belongs to ``part``, to the observed one.

    ``distance`` holds the `Silhouette.distances` of the observed one. The model's contour
    runs between two neighbouring pixels, one inside and one outside; there the distance is the
    mean of theirs. The picture's edge is no contour.
    """
    found = []
    for one, other in (np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:-1], np.s_[1:]):
        crossing = (model[one] != model[other]) & (part[one] | part[other])
        crossing &= observed[one] & observed[other]
        found.append(np.abs(distance[one][crossing] + distance[other][crossing]) / 2)
    return np.concatenate(found)


def _is_unexplained(limb: tuple[np.ndarray, ...], silhouettes: tuple[Silhouette, ...]) -> bool:
    """Whether most of the limb's px are foreground in fewer than 60 % of the views showing it.

    A limb that no view shows is unexplained.
    """
    explained = []
    for part, silhouette in zip(limb, silhouettes, strict=True):
        drawn = part & silhouette.observed
        if drawn.any():
            explained.append(silhouette.foreground[drawn].mean() >= _EXPLAINED_SHARE)
    return not explained or float(np.mean(explained)) < _EXPLAINED_SHARE


def _figure(reduction, values: np.ndarray) -> float:
    return float(reduction(values)) if len(values) else np.nan
