"""How well a pose explains the silhouettes of a frame, view by view and limb by limb."""

from dataclasses import dataclass

import numpy as np

from ..energy.evaluator import Evaluator
from ..silhouettes.silhouette import Silhouette
from .confidence import LimbSigns, point_confidence
from .limbs import LIMB_NAMES, limb_segments
from .lumps import Lumps
from .observability import Observability
from .part_search import metres_per_pixel
from .view_trust import view_weights

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
        unexplained: (5,) share of what each of `LIMB_NAMES` covers that the footage shows as
            background, mean over views by weight; 1 where no view shows any of it.
        view_weights: (V,) how far each view is trusted, see `view_weights`.
        lumps: (5,) m^2 of `Lumps` that each of `LIMB_NAMES` may explain, summed over views.
        point_spreads: (14,) m, `Observability.point_spreads`.
        dof_spreads: (D,) rad or m, `Observability.dof_spreads`.
        confidence: (14,) see `point_confidence`.
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

    ``usual`` (5,) are the `FrameScores.lumps` that other frames have usually; None where there are
    no others.
    """
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
    found = Lumps.of(rendered, silhouettes, metres)
    lumps = found.of_limbs(evaluator, pose, chosen, weights).sum(axis=0)
    explained, most = np.array([_explained(parts, silhouettes, weights) for parts in limbs]).T
    seen = Observability.of(evaluator, pose, silhouettes, weights, metres)
    trusted = max(float(weights.sum()), 1e-9)
    usual = np.full(len(LIMB_NAMES), np.inf) if usual is None else usual
    shares = (lumps / trusted, 1.0 - explained, usual / trusted)
    signs = LimbSigns(residual * metres.mean(), *shares)
    return FrameScores(
        xor_px=xor,
        iou=iou,
        contour_px=_figure(np.median, distances_of(rendered)),
        limb_residual=residual,
        unexplained=1.0 - explained,
        view_weights=weights,
        lumps=lumps,
        point_spreads=seen.point_spreads,
        dof_spreads=seen.dof_spreads,
        confidence=point_confidence(seen.point_spreads, signs),
        lost=bool((most < _EXPLAINED_SHARE).any()),
    )


def metres_at(evaluator: Evaluator, pose: np.ndarray) -> np.ndarray:
    """(V,) m that a pixel of each view is wide where the root is in a pose (D,)."""
    root = evaluator.transforms(pose[None])[0, 0, :, 3]
    return np.array([metres_per_pixel((camera,), root) for camera in evaluator.cameras])


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


def _explained(
    limb: tuple[np.ndarray, ...], silhouettes: tuple[Silhouette, ...], weights: np.ndarray
) -> tuple[float, float]:
    """Shares, by weights (V,), of a limb's px that are foreground, and of views where most are.

    Only views that show some of it count; both are 0 where none does.
    """
    found = []
    for part, silhouette, weight in zip(limb, silhouettes, weights.tolist(), strict=True):
        drawn = part & silhouette.observed
        if weight and drawn.any():
            share = float(silhouette.foreground[drawn].mean())
            found.append((weight, share, share >= _EXPLAINED_SHARE))
    if not found:
        return 0.0, 0.0
    by_weight, shares, most = np.array(found, float).T
    return float(by_weight @ shares / by_weight.sum()), float(by_weight @ most / by_weight.sum())


def _figure(reduction, values: np.ndarray) -> float:
    return float(reduction(values)) if len(values) else np.nan
