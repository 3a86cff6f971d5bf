"""The frames of a motion that fit worst, and what is wrong with them."""

from dataclasses import dataclass

import numpy as np

from ..motion.motion import Motion

_NEIGHBOURHOOD = 24
"""No two frames are nearer to each other than this fraction of the motion."""


@dataclass(frozen=True)
class BadFrame:
    """One frame and its worst sides.

    Attributes:
        frame: its number.
        iou: mean over the cameras that observed something; NaN where none did.
        lost: whether the pose is not to be trusted.
        camera: the camera that falls furthest below its usual IoU; None where none observed
            anything.
        camera_iou: its IoU here and its median.
        limb: the limb furthest off its usual residual, of the motion's; None where all are hidden.
        limb_px: its residual here and its median, px.
        unseen: cameras that observed nothing and show nothing.
        hidden: limbs that no camera shows.
    """

    frame: int
    iou: float
    lost: bool
    camera: str | None
    camera_iou: tuple[float, float]
    limb: str | None
    limb_px: tuple[float, float]
    unseen: tuple[str, ...]
    hidden: tuple[str, ...]


def worst_frames(motion: Motion, count: int) -> list[BadFrame]:
    """Up to ``count`` frames, worst first: lost ones before others, then by falling IoU.

    They are spread out in time, as the neighbours of a bad frame show the same fault.
    """
    iou = mean_iou(motion)
    order = np.lexsort((np.nan_to_num(iou, nan=-1.0), ~motion.lost))
    apart = max(2, len(iou) // _NEIGHBOURHOOD)
    chosen: list[int] = []
    for index in order:
        if len(chosen) == count:
            break
        if all(abs(index - other) >= apart for other in chosen):
            chosen.append(int(index))
    usual = (_medians(motion.iou), _medians(motion.limb_residual))
    return [_described(motion, index, float(iou[index]), usual) for index in chosen]


def mean_iou(motion: Motion) -> np.ndarray:
    """(T,) IoU over the cameras that observed something; NaN where none did."""
    known = np.isfinite(motion.iou)
    counts = known.sum(axis=1)
    total = np.where(known, motion.iou, 0.0).sum(axis=1)
    return np.where(counts > 0, total / np.maximum(counts, 1), np.nan)


def _medians(values: np.ndarray) -> np.ndarray:
    """The median of the finite values of every column; NaN where there are none."""
    finite = (column[np.isfinite(column)] for column in values.T)
    return np.array([np.median(column) if len(column) else np.nan for column in finite])


def _described(
    motion: Motion, index: int, iou: float, usual: tuple[np.ndarray, np.ndarray]
) -> BadFrame:
    views, limbs = motion.iou[index], motion.limb_residual[index]
    camera = _largest(usual[0] - views)
    limb = _largest(limbs - usual[1])
    return BadFrame(
        frame=int(motion.frames[index]),
        iou=iou,
        lost=bool(motion.lost[index]),
        camera=None if camera is None else motion.camera_names[camera],
        camera_iou=_pair(views, usual[0], camera),
        limb=None if limb is None else motion.limb_names[limb],
        limb_px=_pair(limbs, usual[1], limb),
        unseen=tuple(np.array(motion.camera_names)[np.isnan(views)].tolist()),
        hidden=tuple(np.array(motion.limb_names)[np.isnan(limbs)].tolist()),
    )


def _largest(values: np.ndarray) -> int | None:
    return None if np.isnan(values).all() else int(np.nanargmax(values))


def _pair(here: np.ndarray, usual: np.ndarray, index: int | None) -> tuple[float, float]:
    return (np.nan, np.nan) if index is None else (float(here[index]), float(usual[index]))
