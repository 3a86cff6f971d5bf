"""The pose of one frame, without a past: from many starts, all round.

All starts are compared by the exact energy, which takes microseconds each. From the best of them,
apart from each other, outlines are drawn to the contours; from the best end the frame is fitted as
a tracker does that has lost everything, each limb sought over all its range.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..body.body import Body
from ..body.kinematics import points
from ..energy.weight_maps import xor_weight_maps
from ..fitting.contour import ContourTracker
from ..fitting.contour_search import ContourSearch
from ..fitting.limbs import limb_names
from ..fitting.recovery import moved
from ..fitting.scores import FrameScores, frame_scores
from ..fitting.tracker import Past, PoseFit
from ..fitting.turns import heading_dof
from ..silhouettes.silhouette import Silhouette

_HEADINGS = 24
_ALIKE = np.cos(np.radians(40))
_PER_HEADING = 2
"""Starts of different shapes that may face about the same way."""
_REACH = 2.0
"""Times a tracker's descent, in reach and steps."""


class Descended(NamedTuple):
    """Where a descent has ended: energy in px, and pose (D,)."""

    energy: float
    pose: np.ndarray


class Hunt:
    """The search of one frame.

    Args:
        tracker: of the body in V cameras.
        silhouettes: V of the frame.
    """

    def __init__(self, tracker: ContourTracker, silhouettes: tuple[Silhouette, ...]):
        self.tracker, self.silhouettes = tracker, silhouettes
        self.evaluator, self.body = tracker.evaluator, tracker.evaluator.body
        maps = xor_weight_maps(silhouettes)
        self.observed_px = int(maps.constants.sum())
        self._weights = self.evaluator.prepared(maps)

    def energies(self, poses: np.ndarray) -> np.ndarray:
        """(N,) px that differ in all views, of poses (N, D)."""
        return self.evaluator.energies(self._weights, poses).sum(axis=1)

    def ends(self, starts: np.ndarray, most: int) -> list[Descended]:
        """Where descents from the best of the starts (N, D) end, ``most`` of them, best first."""
        search = None
        found = []
        for start in starts[self._chosen(starts, most)]:
            if search is None:
                settings = (self.tracker.descent, self.tracker.settings)
                search = ContourSearch(*settings, self.silhouettes, Past.still(start))
            found.append(search.descended(start, start, _REACH))
        energies = self.energies(np.stack(found))
        return [Descended(float(energies[i]), found[i]) for i in energies.argsort(kind="stable")]

    def complete(self, start: np.ndarray) -> PoseFit:
        """The fit from a start (D,), every limb sought wherever it can be."""
        return self.tracker.fit(self.silhouettes, replace(Past.still(start), usual=self._nothing))

    def scores(self, pose: np.ndarray) -> FrameScores:
        """Of a pose (D,); whatever it leaves unexplained speaks against it."""
        return frame_scores(self.evaluator, pose, self.silhouettes, self._nothing)

    @property
    def _nothing(self) -> np.ndarray:
        """(L,) lumps that are usual."""
        return np.zeros(len(limb_names(self.body)))

    def _chosen(self, starts: np.ndarray, most: int) -> list[int]:
        """Indices of the best starts, a few of them in each direction."""
        turn, chosen = heading_dof(self.body), []
        shapes = np.delete(starts, self._root_dofs, axis=1)
        for index in self.energies(starts).argsort(kind="stable").tolist():
            alike = np.cos(starts[chosen, turn] - starts[index, turn]) > _ALIKE
            near = np.array(chosen, int)[alike]
            known = (shapes[near] == shapes[index]).all(axis=1).any()
            if len(near) < _PER_HEADING and not known:
                chosen.append(index)
            if len(chosen) == most:
                break
        return chosen

    @property
    def _root_dofs(self) -> np.ndarray:
        return np.flatnonzero(self.body.dofs.joints == 0)


def all_round(body: Body, shapes: np.ndarray) -> np.ndarray:
    """(n, D) the poses (N, D) turned about the vertical, one after the other."""
    turns = np.linspace(-np.pi, np.pi, _HEADINGS, endpoint=False)
    poses = np.repeat(shapes, _HEADINGS, axis=0)
    poses[:, heading_dof(body)] += np.tile(turns, len(shapes))
    return poses


def stood(body: Body, poses: np.ndarray, centre: np.ndarray, floor: float) -> np.ndarray:
    """Poses (N, D) moved over ``centre`` (3,), the lowest points above the floor as at rest."""
    places = points(body, poses)
    lowest = places[..., 2].min(axis=1)
    rest = points(body, body.rest_pose[None])[0, :, 2].min()
    wanted = np.column_stack([np.tile(centre[:2], (len(poses), 1)), floor + rest - lowest])
    middles = np.column_stack([places[..., :2].mean(axis=1), np.zeros(len(poses))])
    return moved(body, poses, wanted - middles)


def hung(body: Body, poses: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """Poses (N, D) moved so that the middle of their points is at ``centre`` (3,)."""
    return moved(body, poses, centre - points(body, poses).mean(axis=1))
