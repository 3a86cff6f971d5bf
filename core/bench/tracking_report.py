"""What is written of `TrackingFigures`: the numbers as JSON, the worst first."""

import math
from collections.abc import Sequence
from dataclasses import asdict

from .tracking import TrackingFigures
from .tracking_confidence import BAD_MM, BINS, DOUBT, GOOD_MM, Reliability, reliability
from .tracking_runs import Track
from .tracking_speed import SpeedFigures
from .tracking_torments import recovery
from .tracking_trials import LADDER, SECTIONS, TAKES, TORMENTS, Result
from .tracking_variants import DEFAULT


def as_dict(figures: TrackingFigures) -> dict:
    """All figures for JSON."""
    results = figures.results
    return {
        "machine": figures.machine,
        "faults": [result.fault for result in results if result.fault],
        **{section.replace(" ", "_"): rows for section, rows in rows_of(results).items()},
        "confidence": {
            name: confidence_figures(found) for name, found in confidence_of(results).items()
        },
        "speed": speed_as_dict(figures.speed),
    }


def speed_as_dict(speed: SpeedFigures) -> dict:
    """For JSON; ratios are to tracking with the most threads."""
    tracking = speed.threads[max(speed.threads)]
    return {
        **asdict(speed),
        "hierarchical_ratio": speed.hierarchical / tracking,
        "baseline_ratio": None if speed.baseline is None else speed.baseline / tracking,
        "shares": {stage: s / speed.busy for stage, s in speed.stages.items()},
    }


def rows_of(results: Sequence[Result]) -> dict[str, list[dict]]:
    """The rows of each section's table, the largest error first; failed trials before all."""
    undisturbed = _undisturbed(results)
    sections: dict[str, list[dict]] = {section: [] for section in SECTIONS}
    for result in results:
        row = _row(result)
        if result.trial.section == TORMENTS and result.track is not None:
            row |= _recovery(result, undisturbed[result.trial.take])
        sections[result.trial.section].append(row)
    return {section: sorted(rows, key=_badness) for section, rows in sections.items()}


def confidence_of(results: Sequence[Result]) -> dict[str, Reliability]:
    """By which tracks are judged; the last holds all of them."""
    groups = {
        "undisturbed": (TAKES,),
        "tormented": (TORMENTS,),
        "noisy": (LADDER,),
        "all of these": (TAKES, TORMENTS, LADDER),
    }
    tracks = {
        name: [
            result.track
            for result in results
            if result.trial.section in sections
            and result.trial.variant.name == DEFAULT.name
            and result.track is not None
        ]
        for name, sections in groups.items()
    }
    return {name: reliability(found) for name, found in tracks.items() if found}


def confidence_figures(found: Reliability) -> dict:
    """For JSON."""
    return {
        "good_mm": GOOD_MM,
        "bad_mm": BAD_MM,
        "doubt": DOUBT,
        "doubted_of_bad": found.doubted_of_bad,
        "doubted_of_good": found.doubted_of_good,
        "bins": [
            {
                "from": k / BINS,
                "points": int(found.counts[k]),
                "confidence": float(found.confidence[k]),
                "good": float(found.good[k]),
            }
            for k in range(BINS)
        ],
    }


def _undisturbed(results: Sequence[Result]) -> dict[str, Track]:
    """By take, the default tracker's track without any disturbance."""
    return {
        result.trial.take: result.track
        for result in results
        if result.trial.section == TAKES
        and result.trial.variant.name == DEFAULT.name
        and result.track is not None
    }


def _row(result: Result) -> dict:
    trial = result.trial
    row = {
        "take": trial.take,
        "name": trial.name,
        "amount": trial.amount,
        "level": trial.level,
        "cameras": len(trial.recording.cameras),
        "mm_per_px": trial.recording.mm_per_px,
        "fault": result.fault or None,
    }
    return row if result.track is None else row | _figures(result.track)


def _figures(track: Track) -> dict:
    found = track.score
    return {
        "frames": found.frames,
        "absolute_mm": found.absolute.mean,
        "offset_removed_mm": found.offset_removed.mean,
        "p95_mm": found.absolute.p95,
        "max_mm": found.absolute.max,
        "lost_frames": found.lost_frames,
        "limb_losses": found.limb_losses,
        "frames_with_a_lost_limb": found.frames_with_a_lost_limb,
        "jitter_mm": found.jitter,
        "seconds_per_frame": track.seconds_per_frame,
        "evaluations_per_frame": float(track.evaluations.mean()),
    }


def _recovery(result: Result, undisturbed: Track) -> dict:
    assert result.track is not None and result.trial.frames is not None
    found = recovery(result.track, undisturbed, result.trial.frames)
    return {
        "tormented_frames": list(result.trial.frames),
        "before_mm": found.before,
        "during_mm": found.during,
        "undisturbed_during_mm": found.undisturbed,
        "after_mm": list(found.after),
        "worst_limb": found.worst_limb,
        "worst_limb_mm": found.worst_mm,
        "back_in_frame": found.back,
        "course": found.course.tolist(),
    }


def _badness(row: dict) -> tuple[float, ...]:
    """Orders rows: what failed, limbs that never come back, then the largest error."""
    if row["fault"]:
        return (-math.inf,)
    late = 0.0
    if "back_in_frame" in row:
        late = -math.inf if row["back_in_frame"] is None else -float(row["back_in_frame"])
    return (late, -row["absolute_mm"])
