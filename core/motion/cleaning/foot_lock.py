"""Feet held where they touch the floor, by the least and smoothest change of the legs.

The change c of root position and leg angles, over the whole take at once, minimises

    sum_t |c_t / s|^2 + penalty * sum_t |(c_(t-1) - 2 c_t + c_(t+1)) / s|^2

under the conditions that a point of a sole which touches the floor in two frames in a row is in the
same place in both, that no point of a sole is below the floor, and that limits hold. As the change
as a whole is smooth, it comes and goes by itself before and after a contact, within about 0.15 s,
and nothing pops at its ends. Where a foot stands is left to the minimum, so heel and ball, which a
rigid foot keeps apart, need no places that would contradict each other; what touches the floor is
drawn to it but gently, as legs that are a centimetre too short would take the whole body along.

The conditions are linearised about the motion so far (Gauss-Newton) and enter as stiff springs, of
inequalities those that are violated. Frames couple with their next two alone: the equations form
a band and are solved for 10,000 frames at once.
"""

from dataclasses import dataclass

import numpy as np

from ...body.body import Body, DofKind
from ...body.kinematics import clamped
from ...body.limits import Limits
from ...fitting.twists import Twists
from ...progress import Progress
from .block_band import BlockBand
from .soles import Soles

_SPREAD_M, _SPREAD_RAD, _FOOT_SPREAD_RAD, _TOES_SPREAD_RAD = 0.01, 0.05, 0.25, 0.6
"""s: of the root's moves, of legs, feet and toes; the last of these silhouettes show least."""
_CUT_OFF_HZ = 3.0
"""Of the change."""
_SLIDE_M, _SINK_M, _LIMIT_RAD, _HOVER_M = 2e-5, 1e-4, 1e-4, 0.1
"""Spreads of the springs."""
_HELD = 1e6
"""Stiffness of frames that must not change, against others."""
_LONGEST = 0.2
"""m or rad, change in a round."""
_ROUNDS, _FREE_ROUNDS = 16, 4
"""In the free ones, what was stopped by floor or limit may leave it again."""
_SHARE = 0.7
"""Of the wanted change that is made in later rounds, lest they swing to and fro."""
_STILL = 1e-4
"""m or rad; a smaller change in a round is the last one."""


@dataclass(frozen=True, eq=False)
class Floor:
    """What is known of the floor.

    Attributes:
        height: metres.
        touched: (T, P) bool, which points of the soles touch it.
    """

    height: float
    touched: np.ndarray


class FootLock:
    """The legs of one motion, and what holds their feet.

    Args:
        body: whose.
        soles: its soles' points.
        poses: (T, D) as they are.
        rate: frames per second.
        locked: (T,) bool, frames that stay as they are.
    """

    def __init__(self, body: Body, soles: Soles, poses: np.ndarray, rate: float, locked):
        self.body, self.soles, self.poses, self.locked = body, soles, poses, locked
        self._twists = Twists(body)
        self.dofs = _leg_dofs(body, self._twists, soles)
        self._stiffness = _spreads(body, self.dofs, soles) ** -2
        self._penalty = (2 * np.sin(np.pi * min(_CUT_OFF_HZ / rate, 0.5))) ** -4
        self._walls = _walls(Limits.of(body, self.dofs.tolist()))

    def solved(self, floor: Floor, progress: Progress) -> np.ndarray:
        """(T, D) the poses with the feet held, within the limits."""
        progress.begin("feet", _ROUNDS)
        count = len(self.soles.feet) + len(self._walls[1])
        change, stopped = np.zeros((len(self.poses), len(self.dofs))), np.zeros((1, count), bool)
        for round_ in range(_ROUNDS):
            before = change
            wanted, against = self._improved(change, floor, stopped)
            progress.advance(None)
            share = 1.0 if round_ < _FREE_ROUNDS else _SHARE
            change = change + share * np.clip(wanted - change, -_LONGEST, _LONGEST)
            if np.abs(change - before).max() < _STILL:
                break
            if round_ >= _FREE_ROUNDS:
                stopped = against
        found = clamped(self.body, self._changed(change))
        found[self.locked] = self.poses[self.locked]
        return found

    def _changed(self, change: np.ndarray) -> np.ndarray:
        poses = self.poses.copy()
        poses[:, self.dofs] += change
        return poses

    def _improved(
        self, change: np.ndarray, floor: Floor, stopped: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """(T, K) the change that the conditions, linearised about ``change``, ask for.

        Also which points and limits (T, P + L) were stopped by the floor or at a limit, those that
        were ``stopped`` before among them.
        """
        places, slopes = self._moved_soles(self._changed(change))
        band = BlockBand.zero(*change.shape)
        band.add_smoothness(self._stiffness, self._penalty)
        held = self.locked[:, None] * _HELD * self._stiffness
        band.add_frames(np.eye(len(self.dofs)), np.zeros_like(change), held)
        _add_standing(band, places, slopes, change, floor.touched)
        heights, ups = places[..., 2] - floor.height, slopes[:, :, 2]
        band.add_frames(ups, _along(ups, change) - heights, floor.touched / _HOVER_M**2)
        normals, bounds = self._walls
        depths = (self.poses[:, self.dofs] + change) @ normals.T - bounds
        against = stopped | (np.column_stack([heights, depths]) < 0)
        against[self.locked] = False
        at_floor, at_limit = np.split(against, [heights.shape[1]], axis=1)
        band.add_frames(ups, _along(ups, change) - heights, at_floor / _SINK_M**2)
        band.add_frames(normals, change @ normals.T - depths, at_limit / _LIMIT_RAD**2)
        return band.solved(), against

    def _moved_soles(self, poses: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places (T, P, 3) of the soles' points, and how they move (T, P, 3, K) with the DOFs."""
        carriers = self.soles.joints
        transforms, velocities, turns = [], [], []
        for pose in poses:
            all_transforms, twists = self._twists.at(pose)
            transforms.append(all_transforms)
            own = twists[carriers][:, self.dofs]
            velocities.append(own[..., :3])
            turns.append(own[..., 3:])
        places = self.soles.places(np.stack(transforms))
        moves = np.stack(velocities) + np.cross(np.stack(turns), places[:, :, None])
        return places, moves.transpose(0, 1, 3, 2)


def _add_standing(band: BlockBand, places, slopes, change, touched) -> None:
    """Points that touch the floor in two frames in a row are in one place in both."""
    both = touched[1:] & touched[:-1]
    for axis in range(3):
        steps = np.diff(places[..., axis], axis=0)
        here, there = slopes[:-1, :, axis], slopes[1:, :, axis]
        linear = _along(there, change[1:]) - _along(here, change[:-1])
        band.add_pairs(here, there, linear - steps, both / _SLIDE_M**2)


def _walls(limits: Limits) -> tuple[np.ndarray, np.ndarray]:
    """Normals (L, K) and bounds (L,): within the limits, normals @ values >= bounds."""
    edges = np.eye(len(limits.low))
    normals = np.concatenate([edges, -edges, limits.normals])
    bounds = np.concatenate([limits.low, -limits.high, limits.distances])
    return normals[np.isfinite(bounds)], bounds[np.isfinite(bounds)]


def _along(slopes: np.ndarray, change: np.ndarray) -> np.ndarray:
    """(T, P) slopes (T, P, K) times changes (T, K)."""
    return np.einsum("tpk,tk->tp", slopes, change)


def _spreads(body: Body, dofs: np.ndarray, soles: Soles) -> np.ndarray:
    """(K,) s of ``dofs``."""
    shifts = body.dofs.kinds[dofs] == DofKind.TRANSLATION
    joints = body.dofs.joints[dofs]
    in_feet, in_toes = np.isin(joints, soles.joints), np.isin(body.parents[joints], soles.joints)
    angles = np.where(in_toes, _TOES_SPREAD_RAD, np.where(in_feet, _FOOT_SPREAD_RAD, _SPREAD_RAD))
    return np.where(shifts, _SPREAD_M, angles)


def _leg_dofs(body: Body, twists: Twists, soles: Soles) -> np.ndarray:
    """(K,) the DOFs that move the feet, but for the root's turns."""
    moving = twists.moved[soles.joints].any(axis=0)
    turns = (body.parents[body.dofs.joints] < 0) & (body.dofs.kinds != DofKind.TRANSLATION)
    return np.flatnonzero(moving & ~turns)
