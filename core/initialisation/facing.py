"""Which way the performer faces, and so which side is left.

Turned about, with left and right exchanged, a body covers nearly the same silhouettes. What differs
is where toes stick out and which way knees and elbows bend. Both are fitted completely, and the
better one is taken where it is clearly better. Else people walk where they face; and of those that
stand, the feet tell, whose px are few among all the others.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..body.body import DofKind
from ..body.kinematics import points
from ..fitting.scores import metres_at
from ..fitting.tracker import PoseFit
from ..fitting.turns import heading_dof, turned_about
from .hunt import Hunt

CLEARLY = 0.05
"""Share by which the worse of both is worse, where there is no doubt."""
_WALKED_M = 0.3
"""That tell a direction."""
_ALONG = 0.7
"""Cosine to it of whoever walks forwards."""
_FOOT_M = 0.25
"""About an ankle, where its foot is."""

Way = Callable[[], np.ndarray | None]
"""(2,) m that the performer moves about the frame; None where that is unknown."""


@dataclass(frozen=True, eq=False)
class Facing:
    """The side that was decided for.

    Attributes:
        fit: the better fit.
        margin: share by which the other one, turned about, has more px that differ; below 0 where
            something else decided against them.
        told_by: what decided.
    """

    fit: PoseFit
    margin: float
    told_by: str

    @property
    def words(self) -> str:
        """How clear it is, a sentence for the user."""
        if self.margin >= CLEARLY:
            return f"Facing the other way the performer would fit {self.margin:.0%} worse."
        return (
            "Which side is left is in doubt: facing the other way the performer would fit "
            f"{abs(self.margin):.1%} {'worse' if self.margin >= 0 else 'better'}; "
            f"{self.told_by} decided."
        )


def faced(hunt: Hunt, fit: PoseFit, way: Way) -> Facing:
    """Of a fit of the frame and its rival that faces the other way, the one that faces right."""
    rival = hunt.complete(_about(hunt, fit.pose))
    better, worse = sorted((fit, rival), key=lambda found: found.energy)
    margin = worse.energy / max(better.energy, 1) - 1.0
    if margin >= CLEARLY:
        return Facing(better, margin, "the silhouettes")
    along = _along(hunt, better.pose, way())
    if abs(along) > _ALONG:
        told_by, right = "the way they walk", along > 0
    else:
        own, other = (_feet_px(hunt, (better.pose, worse.pose), k) for k in (0, 1))
        told_by, right = (
            f"the feet, {min(own, other)} px against {max(own, other)} px,",
            own <= other,
        )
    return Facing(better, margin, told_by) if right else Facing(worse, -margin, told_by)


def _about(hunt: Hunt, pose: np.ndarray) -> np.ndarray:
    """(D,) the pose turned about, leaning where it leans."""
    about, dofs = turned_about(hunt.body, pose), hunt.body.dofs
    tilts = np.flatnonzero((dofs.joints == 0) & (dofs.kinds != DofKind.TRANSLATION))
    tilts = tilts[tilts != heading_dof(hunt.body)]
    about[tilts] = -pose[tilts]
    return about


def _along(hunt: Hunt, pose: np.ndarray, way: np.ndarray | None) -> float:
    """Cosine between a pose's front and where the performer walks; 0 where they hardly do."""
    if way is None or np.linalg.norm(way) < _WALKED_M:
        return 0.0
    front = -hunt.evaluator.transforms(pose[None])[0, 0, :2, 1]
    return float(front @ way / (np.linalg.norm(front) * np.linalg.norm(way)))


def _feet_px(hunt: Hunt, poses: tuple[np.ndarray, ...], chosen: int) -> int:
    """Px that differ about the ankles of all ``poses``, where the ``chosen`` one is drawn."""
    names = hunt.body.point_names
    ankles = [index for index, name in enumerate(names) if name.endswith("_ankle")]
    places = points(hunt.body, np.stack(poses))[:, ankles].reshape(-1, 3)
    radii = _FOOT_M / metres_at(hunt.evaluator, poses[chosen])
    count = 0
    views = zip(
        hunt.evaluator.cameras,
        hunt.silhouettes,
        hunt.evaluator.silhouettes(poses[chosen]),
        radii.tolist(),
        strict=True,
    )
    for camera, silhouette, drawn, radius in views:
        rows, columns = np.nonzero((drawn ^ silhouette.foreground) & silhouette.observed)
        gaps = np.column_stack([columns, rows])[:, None] - camera.project(places)
        count += int((np.hypot(*np.moveaxis(gaps, -1, 0)) < radius).any(axis=1).sum())
    return count
