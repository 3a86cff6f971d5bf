"""How well a pose explains the silhouettes of a frame, view by view and limb by limb."""

from dataclasses import dataclass

import numpy as np

from ..energy.evaluator import Evaluator
from ..silhouettes.silhouette import Silhouette
from .confidence import LimbSigns, point_confidence
from .limbs import limb_segments, point_limbs
from .lumps import Lumps
from .observability import Observability
from .part_search import metres_per_pixel
from .sights import BACKGROUND, FOREGROUND, sets_with_limbs, sights_of
from .view_trust import view_weights

_EXPLAINED_SHARE = 0.6


@dataclass(frozen=True, eq=False)
class FrameScores:
    """Scores of one frame; V views.

    Attributes:
        xor_px: (V,) px that differ between observed and rendered silhouette.
        iou: (V,) intersection over union; NaN where both are empty.
        contour_px: median distance from the rendered contours to the observed ones.
        limb_residual: (L,) mean distance of each of `limb_names`' own contour to the observed one,
            px; NaN where no view shows any of it.
        unexplained: (L,) share of what each of `limb_names` covers that the footage shows as
            background, mean over views by weight; 1 where no view shows any of it.
        view_weights: (V,) how far each view is trusted, see `view_weights`.
        lumps: (L,) m^2 of `Lumps` that each of `limb_names` may explain, summed over views.
        point_spreads: (P,) m, `Observability.point_spreads`.
        dof_spreads: (D,) rad or m, `Observability.dof_spreads`.
        confidence: (P,) see `point_confidence`.
        lost: whether any limb's px are explained in less than 60 % of the views (SPEC §8), which
            count by their weights.
    """

    xor_px: np.ndarray
    iou: np.ndarray
    contour_px: float
    limb_residual: np.ndarray
    unexplained: np.ndarray
    view_weights: np.ndarray
    lumps: np.ndarray
    point_spreads: np.ndarray
    dof_spreads: np.ndarray
    confidence: np.ndarray
    lost: bool


def frame_scores(
    evaluator: Evaluator,
    pose: np.ndarray,
    silhouettes: tuple[Silhouette, ...],
    usual: np.ndarray | None = None,
) -> FrameScores:
    """Scores of ``pose`` (D,) against the V silhouettes.

    ``usual`` (L,) are the `FrameScores.lumps` that other frames have usually; None where there are
    no others.
    """
    rendered = evaluator.silhouettes(pose)
    sights = sights_of(evaluator, pose, rendered, silhouettes)
    limbs = limb_segments(evaluator.body)
    sets = sets_with_limbs(len(limbs))
    px = np.array([sight.counts() for sight in sights])
    union = px.sum(axis=(1, 2)) - px[:, BACKGROUND, 0]
    xor = px[:, BACKGROUND, 1:].sum(axis=1) + px[:, FOREGROUND, 0]
    weights = view_weights(xor, 2 * union - xor)
    with np.errstate(invalid="ignore", divide="ignore"):
        iou = np.where(union > 0, 1.0 - xor / union, np.nan)
    explained, most = _explained(px @ sets, weights)
    contours = [sight.contour() for sight in sights]
    distances = np.concatenate([contour[0] for contour in contours], dtype=float)
    own = sets[np.concatenate([contour[1] for contour in contours])]
    residual = np.array([_figure(np.mean, distances[chosen]) for chosen in own.T])
    metres = metres_at(evaluator, pose)
    found = Lumps.of(rendered, silhouettes, metres)
    lumps = found.of_limbs(evaluator, pose, limbs, weights).sum(axis=0)
    seen = Observability.of(evaluator, pose, silhouettes, weights, metres)
    trusted = max(float(weights.sum()), 1e-9)
    usual = np.full(len(limbs), np.inf) if usual is None else usual
    shares = (lumps / trusted, 1.0 - explained, usual / trusted)
    signs = LimbSigns(residual * metres.mean(), *shares)
    return FrameScores(
        xor_px=xor,
        iou=iou,
        contour_px=_figure(np.median, distances),
        limb_residual=residual,
        unexplained=1.0 - explained,
        view_weights=weights,
        lumps=lumps,
        point_spreads=seen.point_spreads,
        dof_spreads=seen.dof_spreads,
        confidence=point_confidence(seen.point_spreads, signs, point_limbs(evaluator.body)),
        lost=bool((most < _EXPLAINED_SHARE).any()),
    )


def metres_at(evaluator: Evaluator, pose: np.ndarray) -> np.ndarray:
    """(V,) m that a pixel of each view is wide where the root is in a pose (D,)."""
    root = evaluator.transforms(pose[None])[0, 0, :, 3]
    return np.array([metres_per_pixel((camera,), root) for camera in evaluator.cameras])


def _explained(px: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(L,) shares, by weights (V,), of limbs' px that are foreground, and of views where most are.

    Only views that show some of a limb count; both are 0 where none does. ``px`` (V, 2, L) are
    those that each limb covers of background and of foreground.
    """
    drawn = px.sum(axis=1)
    shares = px[:, FOREGROUND] / np.maximum(drawn, 1)
    by_weight = weights[:, None] * (drawn > 0)
    total = by_weight.sum(axis=0)
    total[total == 0] = 1.0
    most = shares >= _EXPLAINED_SHARE
    return (by_weight * shares).sum(axis=0) / total, (by_weight * most).sum(axis=0) / total


def _figure(reduction, values: np.ndarray) -> float:
    return float(reduction(values)) if len(values) else np.nan
