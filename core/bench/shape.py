"""The benchmark of shape: the performer's own lengths and girths against uniform scaling.

Each take is tracked three times: with the template scaled as a whole, with the shape that the
initial pose gives, and with the one that further frames with bent limbs give.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..beginning import initial_frames
from ..body.body import POINT_NAMES, Body
from ..body.kinematics import points, rest_height
from ..initialisation.first_pose import initialised
from ..initialisation.further_frames import most_different
from ..initialisation.own_shape import in_own_shape
from ..motion.scoring import Score
from ..progress import Progress
from ..take.performer import performer_body, pose_request
from .machine import machine
from .rows import opengl_renderer
from .tracking_runs import Track, tracked
from .tracking_takes import Beginning, KnownTake, known_take, native_choice
from .tracking_variants import DEFAULT

SCALED, INITIAL, BENT = "scaled as a whole", "own shape, initial pose", "own shape, bent limbs"
LENGTHS: dict[str, tuple[tuple[str, str], ...]] = {
    "upper arm": (("left_shoulder", "left_elbow"), ("right_shoulder", "right_elbow")),
    "forearm": (("left_elbow", "left_wrist"), ("right_elbow", "right_wrist")),
    "thigh": (("left_hip", "left_knee"), ("right_hip", "right_knee")),
    "shank": (("left_knee", "left_ankle"), ("right_knee", "right_ankle")),
}
"""The limbs' lengths, between `POINT_NAMES`, means of left and right."""
FURTHER_FRAMES = 12


@dataclass(frozen=True, eq=False)
class ShapeRow:
    """One take, tracked with one body.

    Attributes:
        take: its name.
        body: `SCALED`, `INITIAL` or `BENT`.
        height_m: of the body.
        off: by the names of `LENGTHS`, how much too long, as a share of the true length.
        initial_mm: mean error in the initial pose, absolute.
        score: of the whole take.
    """

    take: str
    body: str
    height_m: float
    off: Mapping[str, float]
    initial_mm: float
    score: Score


@dataclass(frozen=True, eq=False)
class ShapeFigures:
    """Everything that was measured.

    Attributes:
        machine: what on.
        rows: of all takes and bodies.
    """

    machine: dict
    rows: tuple[ShapeRow, ...]


class _Candidate(NamedTuple):
    """A body, and its pose in the first initial frame."""

    name: str
    body: Body
    pose: np.ndarray


def shape_figures(takes: Sequence[Path], progress: Progress) -> ShapeFigures:
    """Tracks all takes with all bodies.

    Raises:
        MocapError: a take is at fault, has no truth beside it, or its performer is not found.
    """
    rows: list[ShapeRow] = []
    for path in takes:
        rows += _rows(known_take(path, None, progress), progress)
    return ShapeFigures(machine(opengl_renderer()), tuple(rows))


def _rows(known: KnownTake, progress: Progress) -> list[ShapeRow]:
    recording, choice = known.recording, native_choice()
    frames = initial_frames(known.take, (recording.frames[0], recording.frames[-1]))
    template = performer_body(known.take.performer)
    request = pose_request(known.take, template)
    plain, height = replace(request, own_shape=False), request.height_m
    seen = [recording.silhouettes(frame) for frame in frames]
    first = initialised(template, recording.cameras, tuple(seen), plain, choice)
    rows: list[ShapeRow] = []

    def judge(candidate: _Candidate) -> Track:
        progress.begin(f"{known.take.name}, {candidate.name}", len(recording.frames))
        start = Beginning(candidate.body, candidate.pose, frames[0])
        track = tracked(recording, start, DEFAULT, progress.advance)
        rows.append(_row(known, candidate, track, len(frames)))
        return track

    judge(_Candidate(SCALED, first.body, first.pose))
    poses = np.tile(first.pose, (len(seen), 1))
    own = in_own_shape(first.body, recording.cameras, seen, poses, choice, height)
    motion = judge(_Candidate(INITIAL, own.body, own.pose)).motion
    chosen = most_different(own.body, motion.pose, ~motion.lost, [0], FURTHER_FRAMES)
    seen = [recording.silhouettes(int(motion.frames[k])) for k in chosen]
    poses = motion.pose[chosen]
    own = in_own_shape(first.body, recording.cameras, seen, poses, choice, height)
    judge(_Candidate(BENT, own.body, own.pose))
    return rows


def _row(known: KnownTake, candidate: _Candidate, track: Track, initial: int) -> ShapeRow:
    true = _lengths(known.recording.points(int(track.motion.frames[0])))
    ours = _lengths(points(candidate.body, candidate.pose[None])[0])
    return ShapeRow(
        take=known.take.name,
        body=candidate.name,
        height_m=rest_height(candidate.body),
        off={name: ours[name] / true[name] - 1 for name in LENGTHS},
        initial_mm=float(np.nanmean(track.errors[:initial])),
        score=track.score,
    )


def _lengths(places: np.ndarray) -> dict[str, float]:
    """Metres of `LENGTHS` between `POINT_NAMES` at places (14, 3)."""
    found = {}
    for name, pairs in LENGTHS.items():
        ends = np.array([[POINT_NAMES.index(end) for end in pair] for pair in pairs])
        apart = places[ends[:, 0]] - places[ends[:, 1]]
        found[name] = float(np.linalg.norm(apart, axis=1).mean())
    return found
