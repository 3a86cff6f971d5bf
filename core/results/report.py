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
from ..fitting.tracking import Fits, columns
from ..motion.motion import Motion
from ..plain import plain


def fit_quality(motion: Motion, fits: Fits) -> dict:
    """IoU, contour distance, lost frames, and seconds and evaluations per frame."""
    frames = motion.frames.tolist()
    contour_px, held, seconds, evaluated, outside = columns(
        fits,
        frames,
        lambda fit: (
            fit.scores.contour_px,
            fit.scores.dof_spreads > UNOBSERVED,
            fit.seconds,
            fit.tally.evaluated,
            fit.tally.outside_windows,
        ),
    )
    return {
        "frames": frames,
        "iou": _mean(motion.iou),
        "iou_per_camera": dict(zip(motion.camera_names, _columns(motion.iou), strict=True)),
        "iou_per_frame": [_mean(row) for row in motion.iou],
        "contour_px": _median(contour_px),
        "lost_frames": motion.frames[motion.lost].tolist(),
        "held_dofs": _shares(motion.dof_names, held),
        "seconds_per_frame": seconds.tolist(),
        "evaluations_per_frame": evaluated.tolist(),
        "outside_windows_per_frame": outside.tolist(),
    }


def _shares(dof_names: Sequence[str], held: np.ndarray) -> dict[str, float]:
    """Share of the frames in which each DOF is ``held`` (T, D) by priors alone, if in any."""
    shares = held.mean(axis=0).round(3)
    return {name: float(share) for name, share in zip(dof_names, shares, strict=True) if share}


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
    with whole_file(path) as partial, partial.open("w", encoding="utf-8") as file:
        json.dump(written, file, indent=1, allow_nan=False)
        file.write("\n")
    return written


def _mean(values: np.ndarray) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if len(finite) else math.nan


def _median(values: np.ndarray) -> float:
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if len(finite) else math.nan


def _columns(values: np.ndarray) -> list[float]:
    return [_mean(column) for column in values.T]
