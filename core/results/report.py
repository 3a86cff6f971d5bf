"""report.json: what was done with which settings, how well it fits and how long it took."""

import json
import math
import platform
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import cv2
import numpy as np
import scipy

from ..files import whole_file
from ..fitting.observability import UNOBSERVED
from ..fitting.tracking import FrameFit
from ..motion.motion import Motion
from ..plain import plain


def fit_quality(motion: Motion, fits: Sequence[FrameFit]) -> dict:
    """IoU, contour distance, lost frames, and seconds and evaluations per frame."""
    ordered = sorted(fits, key=lambda fit: fit.frame)
    return {
        "frames": motion.frames.tolist(),
        "iou": _mean(motion.iou),
        "iou_per_camera": dict(zip(motion.camera_names, _columns(motion.iou), strict=True)),
        "iou_per_frame": [_mean(row) for row in motion.iou],
        "contour_px": _median([fit.scores.contour_px for fit in ordered]),
        "lost_frames": motion.frames[motion.lost].tolist(),
        "held_dofs": _held(motion, ordered),
        "seconds_per_frame": [fit.seconds for fit in ordered],
        "evaluations_per_frame": [fit.tally.evaluated for fit in ordered],
        "outside_windows_per_frame": [fit.tally.outside_windows for fit in ordered],
    }


def _held(motion: Motion, fits: Sequence[FrameFit]) -> dict[str, float]:
    """Share of the frames in which each DOF is held by priors alone, where there are any."""
    spreads = np.stack([fit.scores.dof_spreads for fit in fits])
    shares = (spreads > UNOBSERVED).mean(axis=0).round(3)
    return {
        name: float(share) for name, share in zip(motion.dof_names, shares, strict=True) if share
    }


def versions() -> dict[str, str]:
    """What the result depends on: this product, Python, libraries, machine."""
    try:
        own = version("silhouette-mocap")
    except PackageNotFoundError:
        own = "not installed"
    return {
        "silhouette_mocap": own,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "opencv": cv2.__version__,
        "machine": f"{platform.system()} {platform.machine()}",
    }


def write_report(path: Path, report: dict) -> dict:
    """Writes ``report`` as JSON, whole or not at all.

    Returns:
        It as it reads back: lists for arrays and tuples, None for what is not finite.

    Raises:
        MocapError: the file cannot be written.
    """
    written = {key: plain(value) for key, value in report.items()}
    text = json.dumps(written, indent=1, allow_nan=False) + "\n"
    with whole_file(path) as partial:
        partial.write_text(text, "utf-8")
    return written


def _mean(values: np.ndarray) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if len(finite) else math.nan


def _median(values: Sequence[float]) -> float:
    finite = [value for value in values if math.isfinite(value)]
    return float(np.median(finite)) if finite else math.nan


def _columns(values: np.ndarray) -> list[float]:
    return [_mean(column) for column in values.T]
