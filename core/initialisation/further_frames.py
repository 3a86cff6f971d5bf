"""Which frames of a track tell most about the performer's shape.

Where a joint lies in a limb shows when the limb bends. So the frames are those whose poses are most
different from each other, of those that are well explained.
"""

from collections.abc import Sequence

import numpy as np

from ..body.body import Body, unsided

BENT_DEG = 30.0
"""An elbow or knee that bends so far shows where it is (SPEC §7)."""


def most_different(
    body: Body, poses: np.ndarray, usable: np.ndarray, begin: Sequence[int], count: int
) -> list[int]:
    """Rising indices of up to ``count`` of poses (T, D), ``begin`` among them.

    One after the other, it is the ``usable`` (T,) pose whose joints are bent most differently from
    those of all chosen before.
    """
    bends = poses[:, body.dofs.joints > 0]
    chosen = list(begin)
    nearest = np.where(usable, np.inf, 0.0)
    for index in chosen:
        nearest = np.minimum(nearest, np.linalg.norm(bends - bends[index], axis=1))
    while len(chosen) < count and nearest.max() > 0:
        chosen.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, np.linalg.norm(bends - bends[chosen[-1]], axis=1))
    return sorted(chosen)


def straight_joints(body: Body, poses: np.ndarray) -> tuple[str, ...]:
    """Hinges of limbs, without their sides, that bend by 30 degrees in none of poses (N, D)."""
    bent: dict[str, bool] = {}
    dofs = {dof for part in body.parts if part.role == "limb" for dof in part.grid}
    for dof in dofs:
        joint = int(body.dofs.joints[dof])
        if np.count_nonzero(body.dofs.joints == joint) == 1:
            name = unsided(body.joint_names[joint])
            furthest = np.degrees(np.abs(poses[:, dof]).max())
            bent[name] = bent.get(name, False) or furthest >= BENT_DEG
    return tuple(sorted(name for name, shown in bent.items() if not shown))
