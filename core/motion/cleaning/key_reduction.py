"""Few keys instead of one per frame, and what that costs.

A curve (`curves`) may lead from one key of a joint to the next if it nowhere turns or shifts the
joint so much that the far end of what hangs on it is displaced by more than an allowance. Of all
chains of such curves the one with the fewest keys is found by dynamic programming (after Perez and
Vidal: Optimum polygonal approximation of digitized curves, 1994). Errors of joints add up along the
body, so the allowance is adapted until no one of the 14 points is further off than was asked for.
Locked frames stay keys.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...body.body import Body
from ...body.kinematics import carried_points, chained, joint_motions
from ...progress import Progress
from ..curves import components, followed, slopes
from ..motion import Motion

_ADAPTATIONS = 5
_FIRST_SHARE, _AIM = 0.5, 0.9
_LONGEST_S, _LENGTHS, _SAMPLES = 2.0, 40, 12
"""Of a curve: seconds, how many lengths are tried, and where it is compared."""
_LEAST_REACH_M = 0.2
"""Of hands and toes, whose turns show more than the points tell."""
_TIE = 1e-3
"""Of chains with as many keys, the one nearer to the motion."""


@dataclass(frozen=True, eq=False)
class Keys:
    """Which frames are keys, and the error of what follows from them.

    Attributes:
        keyed: (T, J) bool.
        points_mm: (T, 14) how far the points are from where they were.
        turns_deg: (T, J) how far each joint's rotation against its parent is from what it was.
    """

    keyed: np.ndarray
    points_mm: np.ndarray
    turns_deg: np.ndarray

    def as_dict(self) -> dict:
        """For report.json."""
        return {
            "kept": int(self.keyed.sum()),
            "of": self.keyed.size,
            "error_mm": {"mean": float(self.points_mm.mean()), "max": float(self.points_mm.max())},
            "error_deg": {"mean": float(self.turns_deg.mean()), "max": float(self.turns_deg.max())},
        }


def reduced_keys(body: Body, motion: Motion, tolerance_mm: float, progress: Progress) -> Keys:
    """The keys of the poses of ``motion`` that keep its 14 points within ``tolerance_mm``.

    Every frame is a key for all joints where nothing else does.
    """
    motions = joint_motions(body, motion.pose)
    fixed = motion.locked | _ends(len(motion.pose))
    best = key_errors(body, motion.pose, np.ones((len(motions), len(body.parents)), bool))
    progress.begin("keys", len(body.parents))
    reaches, lengths, chains = _reaches(body), _lengths(float(motion.rate), len(motions)), []
    for joint in range(len(body.parents)):
        track = _Track.of(motions[:, joint], max(reaches[joint], _LEAST_REACH_M))
        chains.append(_Chains.of(track, fixed, lengths))
        progress.advance(None)
    share = _FIRST_SHARE
    for _ in range(_ADAPTATIONS):
        keyed = np.column_stack([c.fewest(share * tolerance_mm / 1000) for c in chains])
        found = key_errors(body, motion.pose, keyed)
        worst = float(found.points_mm.max())
        if worst <= tolerance_mm and keyed.sum() < best.keyed.sum():
            best = found
        share *= np.clip(_AIM * tolerance_mm / max(worst, 1e-9), 0.3, 2.0)
    return best


def key_errors(body: Body, poses: np.ndarray, keyed: np.ndarray) -> Keys:
    """What ``keyed`` (T, J) costs against poses (T, D), in mm of the points and degrees."""
    before = joint_motions(body, poses)
    after = before.copy()
    for joint in np.flatnonzero(~keyed.all(axis=0)):
        after[:, joint] = followed(before[:, joint], np.flatnonzero(keyed[:, joint]))
    places = [carried_points(body, chained(body, motions)) for motions in (before, after)]
    turns = np.einsum("tjab,tjac->tjbc", before[..., :3], after[..., :3])
    angles = Rotation.from_matrix(turns.reshape(-1, 3, 3)).magnitude().reshape(keyed.shape)
    moved = np.linalg.norm(places[1] - places[0], axis=2)
    return Keys(keyed, 1000 * moved, np.degrees(angles))


@dataclass(frozen=True, eq=False)
class _Track:
    """One joint's motion as it is keyed.

    Attributes:
        values: (T, 7) see `components`.
        slopes: (T, 7) per frame.
        reach: metres to the end of what hangs on the joint.
    """

    values: np.ndarray
    slopes: np.ndarray
    reach: float

    @classmethod
    def of(cls, motions: np.ndarray, reach: float) -> "_Track":
        """Of a joint's own motions (T, 3, 4)."""
        values = components(motions)
        return cls(values, slopes(values, np.arange(len(values))), reach)

    def displacements(self, length: int) -> np.ndarray:
        """(T - length,) metres that curves over so many frames displace at most in between."""
        inside = np.unique(np.linspace(1, length - 1, _SAMPLES).round().astype(int))
        ends = (self.values[:-length], self.values[length:])
        slopes_ = (self.slopes[:-length] * length, self.slopes[length:] * length)
        worst = np.zeros(len(ends[0]))
        for frame in inside[(inside > 0) & (inside < length)].tolist():
            curve = _hermite(ends, slopes_, frame / length)
            there = self.values[frame : frame + len(worst)]
            turns = curve[:, :4] / np.linalg.norm(curve[:, :4], axis=1, keepdims=True)
            chords = np.linalg.norm(turns - there[:, :4], axis=1)
            angles = 4 * np.arcsin(np.minimum(chords / 2, 1.0))
            shifts = np.linalg.norm(curve[:, 4:] - there[:, 4:], axis=1)
            worst = np.maximum(worst, self.reach * angles + shifts)
        return worst


@dataclass(frozen=True, eq=False)
class _Chains:
    """All curves between keys of one joint.

    Attributes:
        lengths: (N,) frames that curves span, rising from 1.
        displacements: (T, N) metres, of the curve of each length that ends at a frame; infinite
            where it would begin before the motion or lead over a frame that must be a key.
    """

    lengths: np.ndarray
    displacements: np.ndarray

    @classmethod
    def of(cls, track: _Track, fixed: np.ndarray, lengths: np.ndarray) -> "_Chains":
        """Those of ``track``, with the frames ``fixed`` (T,) as keys."""
        displacements = np.full((len(fixed), len(lengths)), np.inf)
        for column, length in enumerate(lengths.tolist()):
            displacements[length:, column] = track.displacements(length)
        frames = np.arange(len(fixed))
        last_fixed = np.maximum.accumulate(np.where(np.r_[False, fixed[:-1]], frames - 1, 0))
        displacements[frames[:, None] - lengths < last_fixed[:, None]] = np.inf
        return cls(lengths, displacements)

    def fewest(self, allowance: float) -> np.ndarray:
        """(T,) bool, the keys of the shortest chain of curves that displace by ``allowance`` m."""
        share = self.displacements / allowance
        costs = np.where(share <= 1, 1 + _TIE * share, np.inf)
        costs[1:, 0] = np.minimum(costs[1:, 0], 1 + _TIE)
        best, via = np.zeros(len(costs)), np.zeros(len(costs), int)
        for frame in range(1, len(costs)):
            reachable = int(np.searchsorted(self.lengths, frame, "right"))
            totals = best[frame - self.lengths[:reachable]] + costs[frame, :reachable]
            via[frame] = self.lengths[int(np.argmin(totals))]
            best[frame] = totals.min()
        keyed, frame = np.zeros(len(costs), bool), len(costs) - 1
        while frame > 0:
            keyed[frame], frame = True, frame - via[frame]
        keyed[0] = True
        return keyed


def _lengths(rate: float, frames: int) -> np.ndarray:
    longest = min(max(2.0, _LONGEST_S * rate), max(frames - 1, 1))
    return np.unique(np.geomspace(1, longest, _LENGTHS).round().astype(int))


def _hermite(ends: tuple, slopes: tuple, share: float) -> np.ndarray:
    """Cubics between two ends with slopes over the whole way, at a share of it."""
    u = share
    return (
        (1 + 2 * u) * (1 - u) ** 2 * ends[0] + u**2 * (3 - 2 * u) * ends[1]
        + u * (1 - u) ** 2 * slopes[0] - u**2 * (1 - u) * slopes[1]
    )  # fmt: skip


def _reaches(body: Body) -> np.ndarray:
    """(J,) metres from each joint to the furthest end of what hangs on it, stretched out."""
    reaches = np.linalg.norm(body.tails, axis=1)
    for point, joint in enumerate(body.point_joints.tolist()):
        reaches[joint] = max(reaches[joint], np.linalg.norm(body.point_offsets[point]))
    for joint in range(len(body.parents) - 1, 0, -1):
        parent = body.parents[joint]
        hanging = np.linalg.norm(body.offsets[joint]) + reaches[joint]
        reaches[parent] = max(reaches[parent], hanging)
    return reaches


def _ends(count: int) -> np.ndarray:
    """(T,) bool, the first and the last frame."""
    return np.isin(np.arange(count), (0, count - 1))
