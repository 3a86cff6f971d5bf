"""A fit judged in one plain sentence."""

from dataclasses import dataclass

import numpy as np

from ..motion.motion import Motion
from ..pages.wording import counted, decimal, listed, spans, whole
from .worst_frames import mean_iou

_GOOD_IOU, _FAIR_IOU = 0.8, 0.6
_FAIR_LOST_SHARE = 0.05
_MOST_NAMED = 6


@dataclass(frozen=True)
class Verdict:
    """What to think of a fit.

    Attributes:
        word: one or two words.
        tone: ``good``, ``fair`` or ``bad``.
        sentence: why, in plain words.
        expected: frames that were asked for.
        iou: mean over frames and cameras; NaN where nothing was observed.
    """

    word: str
    tone: str
    sentence: str
    expected: int
    iou: float


def verdict(motion: Motion, report: dict) -> Verdict:
    """The verdict on ``motion``, whose ``report`` tells what was asked for."""
    first, last = report["settings"]["frames"]
    expected, done = last - first + 1, len(motion.frames)
    iou = mean_iou(motion)
    mean = float(np.nanmean(iou)) if np.isfinite(iou).any() else float("nan")
    word, tone = _judged(mean, float(motion.lost.mean()))
    if done < expected:
        word, tone = "Unfinished", "fair" if tone == "good" else tone
    parts = (_extent(done, expected), _agreement(mean), _losses(motion), _error(report))
    return Verdict(word, tone, " ".join(part for part in parts if part), expected, mean)


def _judged(iou: float, lost_share: float) -> tuple[str, str]:
    if iou >= _GOOD_IOU and lost_share == 0:
        return "Good", "good"
    if iou >= _FAIR_IOU and lost_share <= _FAIR_LOST_SHARE:
        return "Look at the worst frames", "fair"
    return "Poor", "bad"


def _extent(done: int, expected: int) -> str:
    if done < expected:
        return (
            f"The fit was interrupted: {whole(done)} of {counted(expected, 'frame')} "
            "are done, the rest is missing."
        )
    return f"All {counted(done, 'frame')} are tracked." if done > 1 else "The frame is tracked."


def _agreement(iou: float) -> str:
    if np.isnan(iou):
        return "No camera observed anybody."
    return f"Model and footage overlap by {decimal(100 * iou, 1)} % on average."


def _losses(motion: Motion) -> str:
    lost = motion.frames[motion.lost].tolist()
    if not lost:
        return "No frame was lost."
    places = spans(lost)
    if len(places) > _MOST_NAMED:
        places = [*places[:_MOST_NAMED], f"{len(places) - _MOST_NAMED} further places"]
    be = "was" if len(lost) == 1 else "were"
    return (
        f"{counted(len(lost), 'frame')} {be} lost ({listed(places)}): do not trust the pose there."
    )


def _error(report: dict) -> str:
    error = report["error_mm"]
    if not error:
        return ""
    removed = error["offset_removed"]["mean"]
    told = f"Against the truth it is off by {decimal(error['absolute']['mean'], 1)} mm on average"
    if removed is None or np.isnan(removed):
        return f"{told}."
    return f"{told}, {decimal(removed, 1)} mm after removing constant offsets."
