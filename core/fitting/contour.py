"""Tracker ``contour``: outlines drawn to the observed contours, judged by the exact energy.

Each frame descends from the predicted pose; views that disagree while the others agree count less.
Then each limb, and the head, is compared with others near by. What the pose leaves unexplained
(`lumps`) tells whether something is amiss: then the last pose is a second start, and limbs are
sought over all their range, drawn to foreground that nothing covers. Where views have dropped a
limb they are taken to show nothing; a body that lies beside them begins anew (`recovery`), and one
that stays unexplained is turned where it stands (`turns`). The exact energy of the whole body has
the last word.
"""

from collections.abc import Sequence
from dataclasses import replace
from operator import itemgetter

import numpy as np

from ..body.body import Body, Part
from ..body.kinematics import clamped
from ..cameras.camera import Camera
from ..silhouettes.silhouette import Silhouette
from .contour_descent import Descent
from .contour_search import ContourSearch, ContourSettings
from .lumps import dropped, unexplained
from .recovery import restarts
from .tracker import EvaluatorFactory, Past, PoseFit
from .turns import ARMS, turned

_TRUST_CHANGED = 0.3
"""Of a view, so that the pose is worth another descent."""
_USUAL = 1.4
"""Times what lumps there usually are, that are nothing to worry about."""
_LITTLE_M2 = 0.006
"""Lumps in all views together that raise no doubt about a limb."""
_BESIDE = 0.45
"""Px that differ, as a share of silhouettes and model together, where the body is lost."""
_RESTARTS = 4
"""Descents from the visual hull."""
_LEAP_M = 0.2
"""From what is expected, by which a joint of a limb has hardly moved."""
_ELSEWHERE = 0.4
"""Foreground that is unexplained where a limb has been dropped, as a share of what is gone."""
_WATCHED = 4
"""Frames in a row that are not explained, after which other headings are tried; then after twice
as many, and so on."""
_HEADINGS = 2
"""Of them that are gone on with."""
_CLEARLY, _MOSTLY = 0.97, 0.6
"""Times the cost of a pose, and its lumps, below which another heading is taken for it."""


class ContourTracker:
    """Fits one frame after another; keeps no state between frames.

    Args:
        body: whose pose is searched.
        cameras: V pinhole cameras.
        make_evaluator: of the body in cameras.
        settings: how to search.
    """

    def __init__(
        self,
        body: Body,
        cameras: tuple[Camera, ...],
        make_evaluator: EvaluatorFactory,
        settings: ContourSettings | None = None,
    ):
        self.settings = settings or ContourSettings()
        self.evaluator = make_evaluator(body, cameras)
        self.descent = Descent(body, self.evaluator, self.settings.descent)

    def fit(self, silhouettes: tuple[Silhouette, ...], past: Past) -> PoseFit:
        """The pose that explains the V silhouettes best.

        Where the views show nobody, it is the last one.
        """
        search = ContourSearch(self.descent, self.settings, silhouettes, past)
        if not search.shown:
            search.take(search.last[None])
            return search.fit
        search.take(np.stack([search.predicted, search.last]))
        search.trust_views()
        search.take(search.descended(search.predicted, search.trusted, 1.0)[None])
        if search.trust_views() > _TRUST_CHANGED:
            search.go_on_from([search.pose])
        if self.settings.limbs is not None:
            _recover_body(search)
            _recover_limbs(search)
            _recover_heading(search)
        return search.fit


def _recover_body(search: ContourSearch) -> None:
    """Begins anew from the visual hull where the body lies beside most silhouettes."""
    apart = float(search.apart_px @ search.trust)
    if apart < _BESIDE * max(float(search.shown_px @ search.trust), 1.0):
        return
    where = (search.body, search.evaluator.cameras, search.silhouettes)
    starts = clamped(search.body, restarts(*where, search.pose))
    if not len(starts):
        return
    search.trust_views(np.ones(len(search.trust)))
    own = search.pose
    chosen = starts[np.argsort(search.costs(starts), kind="stable")[:_RESTARTS]]
    ends = [search.descended(start, start, 2.0) for start in chosen]
    ends = [search.descended(end, end, 1.0) for end in ends]
    search.take(np.stack([own, *ends]))
    search.trust_views()
    search.expect(search.pose)


def _recover_limbs(search: ContourSearch) -> None:
    """The other start where lumps tell that something is amiss, then each limb by itself."""
    doubts = _doubts(search)
    if _disregard(search, doubts):
        search.take(search.descended(search.trusted, search.trusted, 1.0)[None])
        doubts = _doubts(search)
    if doubts.any():
        end = search.descended(search.last, search.trusted, 1.0)
        search.take(np.stack([search.pose, end]))
        doubts = _doubts(search)
    for limb, part in search.sought:
        search.seek(part, bool(doubts[limb]))


def _doubts(search: ContourSearch) -> np.ndarray:
    """(L,) bool, whether there is more than usual that each of `limb_names` may explain."""
    return search.lumps(search.pose).sum(axis=0) > _USUAL * search.past.usual + _LITTLE_M2


def _disregard(search: ContourSearch, doubts: np.ndarray) -> bool:
    """Takes as unobserved where views have dropped a limb; returns whether any has.

    It is gone from where it is expected, and nothing is there that it could have become. Hidden
    before the body it would explain such silhouettes best, and be lost.
    """
    odd = _odd_limbs(search, doubts)
    if not odd:
        return False
    pose = search.pose.copy()
    for _, part in odd:
        pose[list(part.dofs)] = search.trusted[list(part.dofs)]
    missing, surplus = search.lumps(pose)
    silhouettes = list(search.silhouettes)
    for limb, part in odd:
        if missing[limb] < _ELSEWHERE * surplus[limb]:
            where = (part.segments, search.silhouettes, search.metres)
            for view, picture in enumerate(dropped(search.evaluator, pose, *where)):
                if picture is not None:
                    seen = silhouettes[view]
                    silhouettes[view] = replace(seen, observed=seen.observed & ~picture)
    changed = any(a is not b for a, b in zip(silhouettes, search.silhouettes, strict=True))
    if changed:
        search.look_at(silhouettes)
    return changed


def _odd_limbs(search: ContourSearch, doubts: np.ndarray) -> Sequence[tuple[int, Part]]:
    """Limbs that are doubted or far from where they are expected, while there is patience."""
    both = np.stack([search.pose, search.trusted])
    places = search.evaluator.transforms(both)[..., 3]
    leaps = np.linalg.norm(places[0] - places[1], axis=1)
    joints = search.body.segment_joints
    waited = search.past.patient & np.isfinite(search.past.usual)
    waited = np.broadcast_to(waited, doubts.shape)
    return [
        (limb, part)
        for limb, part in search.sought
        if part.role == "limb" and waited[limb]
        if doubts[limb] or leaps[joints[list(part.segments)]].max() > _LEAP_M
    ]


def _recover_heading(search: ContourSearch) -> None:
    """Turns the trunk, while frames stay unexplained, where limbs sought anew explain much more.

    What was expected counts for nothing then.
    """
    own, expected = search.pose, search.trusted
    frames = search.past.amiss + 1
    if frames < _WATCHED or frames & (frames - 1):
        return
    lumps = search.lumps(own).sum(axis=0)
    if not unexplained(lumps, search.past.usual):
        return
    arms = [(limb, part) for limb, part in search.sought if part.name in ARMS]
    starts = turned(search.evaluator, own)
    found = sorted((_sought_from(search, start, arms) for start in starts), key=itemgetter(0))
    found += [_sought_from(search, pose, search.sought) for _, pose in found[:_HEADINGS]]
    cost, pose = min(found, key=itemgetter(0))
    better = cost < _CLEARLY * search.costs(own[None])[0]
    better = better and search.lumps(pose).sum(axis=0).max() < _MOSTLY * lumps.max()
    search.expect(pose if better else expected)
    search.take((pose if better else own)[None])


def _sought_from(
    search: ContourSearch, start: np.ndarray, sought: Sequence[tuple[int, Part]]
) -> tuple[float, np.ndarray]:
    """Cost and pose (D,) where a start (D,) leads to, some parts sought, the arms everywhere."""
    search.expect(start)
    search.take(search.descended(start, start, 1.0)[None])
    for _, part in sought:
        search.seek(part, part.name in ARMS)
    return float(search.costs(search.pose[None])[0]), search.pose
