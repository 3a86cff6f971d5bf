"""Where to begin anew once the whole body is lost: from the visual hull.

After the performer left the pictures, or footage failed for a while, the last pose tells nothing of
the place. The hull tells where the body is; which way it faces is tried all round, with the limbs
as they were last, and at rest.
"""

from collections.abc import Sequence

import numpy as np

from ..body.body import Body, DofKind
from ..body.kinematics import points
from ..cameras.camera import Camera
from ..silhouettes.place import performer_centre, visual_hull
from ..silhouettes.silhouette import Silhouette
from .turns import heading_dof

_HALF_M, _STEP_M = 1.2, 0.06
_HEADINGS = 12


def restarts(
    body: Body, cameras: Sequence[Camera], silhouettes: Sequence[Silhouette], pose: np.ndarray
) -> np.ndarray:
    """(n, D) poses to begin anew from, all in the middle of the visual hull; maybe none.

    They have the limbs of ``pose`` (D,), or at rest, and headings all round.
    """
    centre = hull_centre(cameras, silhouettes)
    if centre is None:
        return np.zeros((0, len(pose)))
    tilts = np.flatnonzero((body.dofs.joints == 0) & (body.dofs.kinds != DofKind.TRANSLATION))
    upright = body.rest_pose.copy()
    upright[tilts] = pose[tilts]
    shapes = np.repeat(np.stack([pose, upright]), _HEADINGS, axis=0)
    # either way round, so that no angle grows with every restart
    turns = np.linspace(-np.pi, np.pi, _HEADINGS, endpoint=False)
    shapes[:, heading_dof(body)] += np.tile(turns, 2)
    return moved(body, shapes, centre - points(body, shapes).mean(axis=1))


def hull_centre(cameras: Sequence[Camera], silhouettes: Sequence[Silhouette]) -> np.ndarray | None:
    """(3,) the middle of the visual hull; None where fewer than two views show anything."""
    centre = performer_centre(cameras, silhouettes)
    if centre is None:
        return None
    hull = visual_hull(cameras, silhouettes, centre, _HALF_M, _STEP_M)
    return hull.mean(axis=0) if len(hull) else centre


def moved(body: Body, poses: np.ndarray, shifts_m: np.ndarray) -> np.ndarray:
    """Poses (N, D) moved by (N, 3) m."""
    dofs = np.flatnonzero((body.dofs.joints == 0) & (body.dofs.kinds == DofKind.TRANSLATION))
    out = poses.copy()
    out[:, dofs] += shifts_m @ body.dofs.axes[dofs].T
    return out
