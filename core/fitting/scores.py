"""How well a pose explains the silhouettes of a frame, view by view and limb by limb."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..body.body import POINT_NAMES, Body
from ..energy.evaluator import Evaluator
from ..silhouettes.silhouette import Silhouette
from .lumps import Lumps
from .part_search import metres_per_pixel
from .view_trust import view_weights

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
        view_weights: (V,) how far each view is trusted, see `view_weights`.
        lumps: (5,) m^2 of `Lumps` that each of `LIMB_NAMES` may explain, summed over views.
        confidence: (14,) see `point_confidence`.
        lost: whether any limb's px are explained in fewer than 60 % of the views (SPEC §8).
    """

    xor_px: np.ndarray
    iou: np.ndarray
    contour_px: float
    limb_residual: np.ndarray
    view_weights: np.ndarray
    lumps: np.ndarray
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
    weights = view_weights(xor, 2 * union - xor)
    with np.errstate(invalid="ignore", divide="ignore"):
        iou = np.where(union > 0, 1.0 - xor / union, np.nan)
    views = [v for v, silhouette in enumerate(silhouettes) if silhouette.foreground.any()]
    pairs = {v: contour_pairs(rendered[v], silhouettes[v].observed) for v in views}
    distances = {
        v: np.abs(silhouettes[v].distances.ravel()[pairs[v]].sum(axis=0)) / 2 for v in views
    }

    def distances_of(parts: tuple[np.ndarray, ...]) -> np.ndarray:
        own = [distances[v][parts[v].ravel()[pairs[v]].any(axis=0)] for v in views]
        return np.concatenate([np.zeros(0), *own])

    chosen = limb_segments(evaluator.body)
    limbs = [evaluator.silhouettes(pose, segments) for segments in chosen]
    residual = np.array([_figure(np.mean, distances_of(parts)) for parts in limbs])
    metres = metres_at(evaluator, pose)
    lumps = Lumps.of(rendered, silhouettes, metres)
    return FrameScores(
        xor_px=xor,
        iou=iou,
        contour_px=_figure(np.median, distances_of(rendered)),
        limb_residual=residual,
        view_weights=weights,
        lumps=lumps.of_limbs(evaluator, pose, chosen, weights),
        confidence=point_confidence(residual * metres.mean()),
        lost=any(_is_unexplained(parts, silhouettes) for parts in limbs),
    )


def metres_at(evaluator: Evaluator, pose: np.ndarray) -> np.ndarray:
    """(V,) m that a pixel of each view is wide where the root is in a pose (D,)."""
    root = evaluator.transforms(pose[None])[0, 0, :, 3]
    return np.array([metres_per_pixel((camera,), root) for camera in evaluator.cameras])


@lru_cache(maxsize=16)
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


def points_of(limb: str) -> list[int]:
    """Indices in `POINT_NAMES` of the points that one of `LIMB_NAMES` moves."""
    index = LIMB_NAMES.index(limb)
    return [k for k, name in enumerate(POINT_NAMES) if limb_of(name) == index]


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


def contour_pairs(model: np.ndarray, observed: np.ndarray) -> np.ndarray:
    """(2, n) flat indices of neighbouring pixels between which the model's contour runs.

    One of them lies inside, one outside, both are observed. The picture's edge is no contour.
    """
    width, found = model.shape[1], []
    for one, other, step in (np.s_[:, :-1], np.s_[:, 1:], 1), (np.s_[:-1], np.s_[1:], width):
        crossing = np.zeros(model.shape, bool)
        crossing[one] = (model[one] != model[other]) & observed[one] & observed[other]
        found.append(np.flatnonzero(crossing) + np.array([[0], [step]]))
    return np.concatenate(found, axis=1)


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
