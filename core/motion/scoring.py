"""The error of a motion against a reference, in millimetres.

Systems define joint centres differently. Beside the absolute error there is therefore one after
removing a constant offset per point in the space of the bone that carries it, learnt as the median
over every second block of one second and judged on the other blocks alone. Where the reference has
no bone rotations, the space of its pelvis stands in: origin at the middle of the hips, x from the
right to the left hip, z towards the neck.
"""

import warnings
from dataclasses import asdict, dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ..errors import MocapError
from .point_track import PointTrack

LOST_MM = 150.0
"""Mean error of a frame, or error of a wrist or ankle, from which it counts as lost."""
_ENDS = ("wrist", "ankle")
_BLOCKS_WITHOUT_FPS = 8


@dataclass(frozen=True)
class Spread:
    """Statistics of distances in mm; NaN where there are none."""

    mean: float
    median: float
    p95: float
    max: float

    @classmethod
    def of(cls, distances: np.ndarray) -> "Spread":
        """The statistics of the finite ones among ``distances`` of any shape."""
        finite = distances[np.isfinite(distances)]
        if not len(finite):
            return cls(*[float("nan")] * 4)
        return cls(
            float(finite.mean()),
            float(np.median(finite)),
            float(np.percentile(finite, 95)),
            float(finite.max()),
        )


@dataclass(frozen=True)
class PointScore:
    """One point's error.

    Attributes:
        error: absolute.
        offset_removed: mean after removing its constant offset.
        offset: that offset, mm in the carrying bone's axes.
    """

    error: Spread
    offset_removed: float
    offset: tuple[float, float, float]


@dataclass(frozen=True)
class Score:
    """How far a motion is from a reference.

    Attributes:
        frames: frames of the reference.
        missing_frames: those without any predicted point.
        lost_frames: those missing, or with a mean error above `LOST_MM`.
        worst_frame: number of the frame with the largest mean error, a missing one first.
        absolute: over all points and frames.
        root: the same after moving the middle of the hips onto the reference's; NaN without hips.
        offset_removed: see the module's head.
        offset_frames_absolute: mean absolute error on the frames that ``offset_removed`` judges.
        offset_space: ``bone`` or ``pelvis``; ``none`` where the reference has neither.
        limb_losses: runs of two frames or more with a wrist or ankle off by more than `LOST_MM`.
        frames_with_a_lost_limb: frames that are the second or later of such a run.
        jitter: root mean square of the error's second difference, mm per frame².
        points: by name.
    """

    frames: int
    missing_frames: int
    lost_frames: int
    worst_frame: int
    absolute: Spread
    root: Spread
    offset_removed: Spread
    offset_frames_absolute: float
    offset_space: str
    limb_losses: int
    frames_with_a_lost_limb: int
    jitter: float
    points: dict[str, PointScore]

    def as_dict(self) -> dict:
        """Plain numbers and texts, for JSON."""
        return asdict(self)


def score(reference: PointTrack, prediction: PointTrack) -> Score:
    """The error of ``prediction`` at the points and frames of ``reference``.

    Raises:
        MocapError: a point of the reference is not in the prediction, or no frame is in both.
    """
    predicted = _on_frames_of(reference, prediction) * 1000.0
    truth = reference.points * 1000.0
    difference = predicted - truth
    error = np.linalg.norm(difference, axis=2)
    per_frame = _frame_errors(error)
    far = _far_ends(error, reference.names)
    axes, space = _carrying_axes(reference)
    offsets, removed, judged = _without_offsets(difference, axes, reference.fps)
    return Score(
        frames=len(truth),
        missing_frames=int(np.isinf(per_frame).sum()),
        lost_frames=int((per_frame > LOST_MM).sum()),
        worst_frame=int(reference.frames[np.argmax(per_frame)]),
        absolute=Spread.of(error),
        root=Spread.of(_root_errors(difference, reference.names)),
        offset_removed=Spread.of(removed),
        offset_frames_absolute=Spread.of(error[judged]).mean,
        offset_space=space,
        limb_losses=int(_run_starts(far).sum()),
        frames_with_a_lost_limb=int((far[1:] & far[:-1]).any(axis=1).sum()),
        jitter=_jitter(difference),
        points={
            name: PointScore(
                Spread.of(error[:, k]), Spread.of(removed[:, k]).mean, tuple(offsets[k].tolist())
            )
            for k, name in enumerate(reference.names)
        },
    )


def aligned_in_time(reference: PointTrack, prediction: PointTrack, rigid: bool) -> PointTrack:
    """``prediction`` with its frames renumbered to fit best, by up to one second either way.

    Args:
        reference: the frames to fit.
        prediction: what is renumbered.
        rigid: whether the fit is judged after `aligned_rigidly`.
    """
    reach = round(reference.fps or len(reference.frames) / _BLOCKS_WITHOUT_FPS)

    def shifted(shift: int) -> PointTrack:
        frames = prediction.frames + shift
        return PointTrack(prediction.names, frames, prediction.points, fps=prediction.fps)

    def mean_error(shift: int) -> float:
        moved = shifted(shift)
        if np.intersect1d(moved.frames, reference.frames).size * 2 < len(reference.frames):
            return np.inf
        if rigid:
            moved = aligned_rigidly(reference, moved)
        distance = np.linalg.norm(_on_frames_of(reference, moved) - reference.points, axis=2)
        return float(np.nanmean(distance))

    return shifted(min(sorted(range(-reach, reach + 1), key=abs), key=mean_error))


def aligned_rigidly(reference: PointTrack, prediction: PointTrack) -> PointTrack:
    """``prediction`` turned and moved as a whole onto the reference, least squares (Kabsch)."""
    moved, fixed = (
        _on_frames_of(reference, prediction).reshape(-1, 3),
        reference.points.reshape(-1, 3),
    )
    both = np.isfinite(moved).all(axis=1) & np.isfinite(fixed).all(axis=1)
    from_centre, to_centre = moved[both].mean(axis=0), fixed[both].mean(axis=0)
    turn = Rotation.align_vectors(fixed[both] - to_centre, moved[both] - from_centre)[0]
    points = (prediction.points - from_centre) @ turn.as_matrix().T + to_centre
    return PointTrack(prediction.names, prediction.frames, points, fps=prediction.fps)


def _on_frames_of(reference: PointTrack, prediction: PointTrack) -> np.ndarray:
    """(T, P, 3) predicted points in the reference's order; NaN where frames are missing."""
    missing = [name for name in reference.names if name not in prediction.names]
    if missing:
        raise MocapError(
            f"the prediction lacks the points {', '.join(missing)}",
            "name its points as the reference does",
        )
    columns = [prediction.names.index(name) for name in reference.names]
    common, ours, theirs = np.intersect1d(reference.frames, prediction.frames, return_indices=True)
    if not len(common):
        raise MocapError(
            f"the prediction (frames {_range(prediction)}) and the reference (frames "
            f"{_range(reference)}) have no frame in common",
            "score motions of the same frames",
        )
    points = np.full_like(reference.points, np.nan)
    points[ours] = prediction.points[theirs][:, columns]
    return points


def _range(track: PointTrack) -> str:
    return f"{track.frames.min()} to {track.frames.max()}" if len(track.frames) else "none"


def _quiet_nan(function, values: np.ndarray, axis: int) -> np.ndarray:
    """NaN-ignoring ``function``; slices without any number give NaN without a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        return function(values, axis=axis)


def _frame_errors(error: np.ndarray) -> np.ndarray:
    """(T,) mean error in mm; infinite where a frame is missing."""
    return np.nan_to_num(_quiet_nan(np.nanmean, error, 1), nan=np.inf)


def _far_ends(error: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """(T, E) whether each wrist and ankle is lost."""
    return error[:, [k for k, name in enumerate(names) if name.endswith(_ENDS)]] > LOST_MM


def _run_starts(far: np.ndarray) -> np.ndarray:
    """(T, E) whether a run of two frames or more begins here."""
    before = np.zeros_like(far)
    before[1:] = far[:-1]
    after = np.zeros_like(far)
    after[:-1] = far[1:]
    return far & after & ~before


def _root_errors(difference: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    if not {"left_hip", "right_hip"} <= set(names):
        return np.full(difference.shape[:2], np.nan)
    hips = difference[:, [names.index("left_hip"), names.index("right_hip")]].mean(axis=1)
    return np.linalg.norm(difference - hips[:, None], axis=2)


def _carrying_axes(reference: PointTrack) -> tuple[np.ndarray, str]:
    """(T, P, 3, 3) axes in columns of the bones that carry the points, and what they are."""
    if reference.rotations is not None:
        return reference.rotations, "bone"
    shape = (*reference.points.shape, 3)
    if not {"left_hip", "right_hip", "neck"} <= set(reference.names):
        return np.full(shape, np.nan), "none"
    left, right, neck = (
        reference.points[:, reference.names.index(name)]
        for name in ("left_hip", "right_hip", "neck")
    )
    x = _unit(left - right)
    y = _unit(np.cross(neck - (left + right) / 2, x))
    pelvis = np.stack([x, y, np.cross(x, y)], axis=-1)
    return np.broadcast_to(pelvis[:, None], shape), "pelvis"


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def _without_offsets(
    difference: np.ndarray, axes: np.ndarray, fps: float | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offsets (P, 3), errors (F, P) of the judged frames, and which frames (T,) are judged."""
    count = len(difference)
    block = max(1, round(fps) if fps else count // _BLOCKS_WITHOUT_FPS)
    judged = np.arange(count) // block % 2 == 1
    local = np.einsum("tpji,tpj->tpi", axes, difference)
    offsets = _quiet_nan(np.nanmedian, local[~judged], 0)
    return offsets, np.linalg.norm(local[judged] - offsets, axis=2), judged


def _jitter(difference: np.ndarray) -> float:
    second = np.diff(difference, 2, axis=0)
    second = second[np.isfinite(second).all(axis=2)]
    return float(np.sqrt((second**2).sum(axis=1).mean())) if len(second) else float("nan")
