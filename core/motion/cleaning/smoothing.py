"""A motion smoothed as a whole, joint by joint, in rotation space.

All joints are filtered alike, so that errors of root and limbs that cancel each other at hands and
feet still do. How much the fit's values count follows from its confidence: read as the probability
that a normal error in the plane stays below 50 mm, it tells a spread; weights fall with its square
where it is beyond 20 mm, which stronger smoothing answers: a spread twice as large lowers the
cut-off by 30 %.
"""

from collections.abc import Callable

import numpy as np

from ...body.body import Body, DofKind
from ...body.kinematics import clamped
from ...progress import Progress
from ..motion import Motion
from .filters import OTHER_FILTERS
from .joint_rotations import JointRotation
from .paths import bridged_values, smoothed_rotations
from .refit import Refit
from .settings import REFIT, CleanSettings

_SURE_M, _CONFIDENT_M = 0.02, 0.05
_LEAST_WEIGHT = 1e-3
_FASTEST_RAD, _FASTEST_M = 1000.0, 60.0
"""Accelerations per s² that nobody exceeds: of a joint, and of the whole body."""
_FEWEST = 3
"""Frames that have an acceleration."""


def smoothed(body: Body, motion: Motion, settings: CleanSettings, progress: Progress) -> np.ndarray:
    """(T, D) the raw poses of ``motion`` of ``body``, smoothed, gaps bridged, within the limits.

    Locked frames are as they were, to the bit. ``progress`` is told how far it is.

    Raises:
        MocapError: a cut-off that is too high for the motion's rate.
    """
    gaps = motion.lost & ~motion.locked
    weights = frame_weights(motion.confidence_raw)
    cut_off = settings.cut_off(motion.rate)
    refit = Refit(float(motion.rate), cut_off, weights, gaps, motion.locked)
    progress.begin("smoothing", len(body.joint_names) * (1 + (settings.filter != REFIT)))
    poses = _filtered(body, motion.pose_raw, gaps, refit.curve, progress)
    if settings.filter != REFIT:
        known = np.where(gaps[:, None], poses, motion.pose_raw)
        poses = _filtered(
            body, known, np.zeros_like(gaps), _pinning(settings.filter, refit), progress
        )
    poses = clamped(body, poses)
    poses[motion.locked] = motion.pose_raw[motion.locked]
    return poses


def frame_weights(confidence: np.ndarray) -> np.ndarray:
    """(T,) weights of confidence (T, 14), at most 1, the points' mean."""
    doubt = np.maximum(1.0 - confidence, np.finfo(float).tiny)
    # 1 - confidence = exp(-confident^2 / (2 spread^2))
    weights = -np.log(doubt) * 2 * (_SURE_M / _CONFIDENT_M) ** 2
    return np.clip(weights, _LEAST_WEIGHT, 1.0).mean(axis=1)


Curve = Callable[[np.ndarray, float], np.ndarray]
"""(T, K) values, and the fastest acceleration, to (T, K) values."""


def _pinning(name: str, refit: Refit) -> Curve:
    """The filter of that name, with values that are held."""

    def curve(values: np.ndarray, fastest: float) -> np.ndarray:
        return refit.pinned(OTHER_FILTERS[name](values, refit.rate, refit.cut_off), values)

    return curve


def _filtered(
    body: Body, poses: np.ndarray, gaps: np.ndarray, curve: Curve, progress: Progress
) -> np.ndarray:
    """(T, D) poses (T, D) with every joint's moves and turns filtered."""
    found = bridged_values(poses, gaps)
    if len(poses) < _FEWEST:
        return found
    shifts = np.flatnonzero(body.dofs.kinds == DofKind.TRANSLATION)
    found[:, shifts] = curve(found[:, shifts], _FASTEST_M)

    def turned(values: np.ndarray) -> np.ndarray:
        return curve(values, _FASTEST_RAD)

    for joint in range(len(body.joint_names)):
        rotation = JointRotation.of(body, joint)
        rows = rotation.rows
        if len(rows) == 1:
            found[:, rows] = turned(found[:, rows])
        elif len(rows):
            raw = rotation.rotations(found[:, rows])
            found[:, rows] = rotation.nearest(smoothed_rotations(raw, gaps, turned), found[:, rows])
        progress.advance(None)
    return found
