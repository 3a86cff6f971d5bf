"""Is the confidence what it says, the probability that a point is off by less than 50 mm?"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .tracking_runs import Track

GOOD_MM, BAD_MM, DOUBT = 50.0, 150.0, 0.3
BINS = 10


@dataclass(frozen=True, eq=False)
class Reliability:
    """Points by their confidence, in bins of equal width.

    Attributes:
        counts: (BINS,) points.
        confidence: (BINS,) their mean confidence; NaN in empty bins.
        good: (BINS,) share of them that are off by less than `GOOD_MM`; likewise.
        doubted_of_bad: share of the points off by more than `BAD_MM` with a confidence below
            `DOUBT`; at least 0.9 is wanted. NaN where there is no such point.
        doubted_of_good: the same of the points off by less than `GOOD_MM`; below 0.05 is wanted.
    """

    counts: np.ndarray
    confidence: np.ndarray
    good: np.ndarray
    doubted_of_bad: float
    doubted_of_good: float


def reliability(tracks: Sequence[Track]) -> Reliability:
    """Of all points of ``tracks`` whose truth is known."""
    errors = np.concatenate([track.errors.ravel() for track in tracks])
    confidence = np.concatenate([track.motion.confidence.ravel() for track in tracks])
    known = np.isfinite(errors)
    errors, confidence = errors[known], confidence[known]
    bins = np.minimum((confidence * BINS).astype(int), BINS - 1)
    counts = np.bincount(bins, minlength=BINS)

    def means(values: np.ndarray) -> np.ndarray:
        sums = np.bincount(bins, values, minlength=BINS)
        return np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)

    doubted = confidence < DOUBT
    return Reliability(
        counts=counts,
        confidence=means(confidence),
        good=means((errors < GOOD_MM).astype(float)),
        doubted_of_bad=_share(doubted[errors > BAD_MM]),
        doubted_of_good=_share(doubted[errors < GOOD_MM]),
    )


def _share(flags: np.ndarray) -> float:
    return float(flags.mean()) if len(flags) else float("nan")
