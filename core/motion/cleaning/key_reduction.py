"""Few keys instead of one per frame, and what that costs.

Each joint gets the shortest chain of curves (`key_chains`) of which none displaces the far end of
what hangs on it by more than an allowance. Errors of joints add up along the body, so the allowance
is adapted until no one of the 14 points is further off than was asked for. Locked frames stay keys.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...body.body import Body
from ...body.kinematics import carried_points, chained, joint_motions
from ...progress import Progress
from ..curves import followed
from ..motion import Motion
from .key_chains import Chains, Track, curve_lengths

_FIRST_SHARE, _ADAPTATIONS = 0.5, 8
"""Of the tolerance, that a joint may use up; and how often that is adapted."""
_LEAST_REACH_M = 0.2
"""Of hands and toes, whose turns show more than the points tell."""


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
    lengths = curve_lengths(float(motion.rate), len(motions))
    chains = Chains.of(_tracks(body, motions, progress), fixed, lengths)
    share, kept, broken = _FIRST_SHARE, 0.0, np.inf
    for _ in range(_ADAPTATIONS):
        found = key_errors(body, motion.pose, chains.fewest(share * tolerance_mm / 1000))
        worst = float(found.points_mm.max())
        if worst > tolerance_mm:
            broken = min(broken, share)
        else:
            kept = max(kept, share)
            best = min(best, found, key=lambda keys: keys.keyed.sum())
        between = kept > 0 and broken < np.inf
        share = np.sqrt(kept * broken) if between else share * tolerance_mm / max(worst, 1e-9)
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


def _tracks(body: Body, motions: np.ndarray, progress: Progress) -> Iterator[Track]:
    """Of every joint of motions (T, J, 3, 4)."""
    reaches = np.maximum(_reaches(body), _LEAST_REACH_M)
    progress.begin("keys", len(reaches))
    for joint, reach in enumerate(reaches.tolist()):
        yield Track.of(motions[:, joint], reach)
        progress.advance(None)


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
