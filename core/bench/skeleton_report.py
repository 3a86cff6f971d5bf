"""The figures of the benchmark of the skeleton: tables, JSON and pictures."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..footage.pictures import write_picture
from ..initialisation.contour_rules.drawing import drawn_steps
from ..initialisation.contour_rules.skeleton import JOINT_NAMES
from ..pages.wording import decimal, whole
from .energy_files import write_texts
from .markdown import lined
from .skeleton import JITTER, KIND, UNDISTURBED, SkeletonFigures, SkeletonTrial

REPORT = "skeleton.md"


def skeleton_report(figures: SkeletonFigures) -> str:
    """All tables."""
    one = figures.trials[0].recording
    parts = [
        "# The skeleton from the contour",
        f"The template `performer` in the pose `{KIND}`, {one.mm_per_px:.1f} mm per px at the "
        "performer; 2 cameras are a stereo pair 30° apart, 4 and more stand all round. Distances "
        "in mm from the body's own joints, the mean over the frames that show the pose; wrists "
        "without colour.",
        "## Joint by joint",
        _joints_table([t for t in figures.trials if t.noise in (UNDISTURBED, JITTER)]),
        "## How far the stereo pair's rays pass each other, mm",
        _gaps_table([t for t in figures.trials if t.count == 2]),
        "## Measures without noise, mm",
        _measures_table(figures),
        "## Kinds of noise",
        "Mean over the nine joints, and the worst of them in any frame.",
        _noise_table(figures.trials),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def as_dict(figures: SkeletonFigures) -> dict:
    """For JSON."""
    return {
        "pose": KIND,
        "joint_names": list(JOINT_NAMES),
        "true_measures_mm": {name: 1000 * m for name, m in figures.true_measures.items()},
        "trials": [_trial_dict(trial) for trial in figures.trials],
    }


def write_skeleton_files(figures: SkeletonFigures, folder: Path) -> list[Path]:
    """Writes skeleton.md, and the steps of the rules in every view of the undisturbed trials.

    Raises:
        MocapError: they cannot be written.
    """
    paths = write_texts({REPORT: skeleton_report(figures)}, folder)
    for trial in figures.trials:
        if trial.noise == UNDISTURBED:
            paths += _write_steps(trial, folder)
    return paths


def _write_steps(trial: SkeletonTrial, folder: Path) -> list[Path]:
    recording = trial.recording
    joints = None if trial.skeleton is None else trial.skeleton.joints[0]
    seen = recording.silhouettes(recording.frames[0])
    paths = []
    for camera, picture in zip(
        recording.cameras, drawn_steps(recording.cameras, seen, KIND, joints), strict=True
    ):
        paths.append(folder / f"skeleton_{trial.count}_{camera.name}.png")
        write_picture(paths[-1], picture)
    return paths


def _trial_dict(trial: SkeletonTrial) -> dict:
    found = trial.skeleton
    return {
        "cameras": trial.count,
        "noise": trial.noise,
        "level": trial.level,
        "amount": trial.amount,
        "mm_per_px": trial.recording.mm_per_px,
        "frames": len(trial.recording.frames),
        "frames_shown": trial.shown,
        "fault": trial.fault,
        "mean_mm": None if found is None else np.nanmean(trial.errors, axis=0).tolist(),
        "largest_mm": None if found is None else np.nanmax(trial.errors, axis=0).tolist(),
        "gap_mm": None if found is None else np.nanmean(found.gaps_mm, axis=0).tolist(),
        "measures_mm": None
        if found is None
        else {name: [1000 * m.mean, 1000 * m.spread] for name, m in found.measures.items()},
    }


def _joints_table(trials: Sequence[SkeletonTrial]) -> str:
    heads = ["cameras", "noise", *(name.replace("_", " ") for name in JOINT_NAMES), "frames"]
    rows = [
        [str(trial.count), _noise(trial), *map(whole, _means(trial.errors)), _frames(trial)]
        for trial in sorted(trials, key=lambda t: (t.count, t.level))
    ]
    return lined(heads, rows)


def _gaps_table(trials: Sequence[SkeletonTrial]) -> str:
    heads = ["noise", *(name.replace("_", " ") for name in JOINT_NAMES)]
    rows = [
        [_noise(trial), *map(whole, _means(trial.skeleton.gaps_mm))]
        for trial in trials
        if trial.skeleton is not None and trial.noise in (UNDISTURBED, JITTER)
    ]
    return lined(heads, rows)


def _measures_table(figures: SkeletonFigures) -> str:
    clean = [t for t in figures.trials if t.noise == UNDISTURBED and t.skeleton is not None]
    heads = ["measure", "the body's", *(f"{trial.count} cameras" for trial in clean)]
    rows = [
        [
            name.replace("_", " "), whole(1000 * own),
            *(whole(1000 * t.skeleton.measures[name].mean) for t in clean if t.skeleton),
        ]
        for name, own in figures.true_measures.items()
    ]  # fmt: skip
    return lined(heads, rows)


def _noise_table(trials: Sequence[SkeletonTrial]) -> str:
    heads = ["noise", "cameras", "mean", "worst", "frames", "mm/px"]
    rows = [
        [
            _noise(trial), str(trial.count), whole(_mean(trial.errors)),
            whole(_largest(trial.errors)), _frames(trial), decimal(trial.recording.mm_per_px, 1),
        ]
        for trial in trials
    ]  # fmt: skip
    return lined(heads, rows)


def _noise(trial: SkeletonTrial) -> str:
    return f"{trial.noise} {trial.level}: {trial.amount}" if trial.level else trial.noise


def _frames(trial: SkeletonTrial) -> str:
    return f"{trial.shown} of {len(trial.recording.frames)}"


def _means(values: np.ndarray) -> list[float]:
    """Of each column, over the rows that are known."""
    known = values[np.isfinite(values).all(axis=1)]
    return known.mean(axis=0).tolist() if len(known) else [math.nan] * values.shape[1]


def _mean(values: np.ndarray) -> float:
    return float(np.mean(_means(values)))


def _largest(values: np.ndarray) -> float:
    return float(np.nanmax(values)) if np.isfinite(values).any() else math.nan
