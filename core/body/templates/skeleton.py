"""How joints are described before they become a `Body`, and their mirror image.

Only the centre and the left are described. Under the reflection x -> -x a turn by some angle about
an axis (x, y, z) becomes the turn by the same angle about (x, -y, -z): with axes mirrored like
that, one number means the same motion on both sides, and cones are shared.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from ..body import DofKind
from .landmarks import FORWARD, LEFT, UP

FREE = (-np.inf, np.inf)


@dataclass(frozen=True, eq=False)
class Row:
    """One row of the DOF table to be.

    Attributes:
        name: what follows the joint's name, or, with a leading side or joint, the whole name.
        kind: the elementary motion.
        axis: (3,) unit axis.
        limits: lowest and highest value, degrees (metres for a translation).
        spread: of the rest prior, degrees (metres for a translation).
        direction: what the positive direction does.
    """

    name: str
    kind: DofKind
    axis: np.ndarray
    limits: tuple[float, float]
    spread: float
    direction: str


@dataclass(frozen=True, eq=False)
class Joint:
    """One joint to be; its name is also the landmark where it is.

    Attributes:
        name: the joint's name.
        parent: the parent's name; empty for the root.
        tail: the landmark at the end of its bone.
        rows: its degrees of freedom.
        cone: (K, 2) polygon of its swing in rad, anticlockwise, or None.
    """

    name: str
    parent: str
    tail: str
    rows: tuple[Row, ...] = ()
    cone: np.ndarray | None = None


def on_the_right(name: str) -> str:
    """A left name's counterpart; names of the centre stay."""
    return name.replace("left_", "right_")


def mirrored(joint: Joint) -> Joint:
    """The right joint of a left one."""
    flip = np.array([1.0, -1.0, -1.0])
    rows = tuple(replace(r, name=on_the_right(r.name), axis=r.axis * flip) for r in joint.rows)
    name, parent, tail = (on_the_right(text) for text in (joint.name, joint.parent, joint.tail))
    return Joint(name, parent, tail, rows, joint.cone)


def turning(bone: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """(3,) unit axis whose positive turn moves ``bone`` towards a direction, both (3,)."""
    axis = np.cross(bone, towards)
    return axis / np.linalg.norm(axis)


def swing_axes(bone: np.ndarray, first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, ...]:
    """Two perpendicular unit axes across ``bone``.

    The first turns the bone towards ``first``, the second, as nearly as that allows, towards
    ``second``.
    """
    axis = turning(bone, first)
    return axis, turning(bone, axis * np.sign(axis @ second))


def ellipse_cone(first: tuple[float, float], second: tuple[float, float]) -> np.ndarray:
    """(24, 2) rad polygon of four quarter ellipses through the limits (degrees) of two axes."""
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    a, b = np.cos(angles), np.sin(angles)
    return np.radians(
        np.stack(
            [a * np.where(a > 0, first[1], -first[0]), b * np.where(b > 0, second[1], -second[0])],
            axis=-1,
        )
    )


def hanging_cone(
    bone: np.ndarray,
    axes: tuple[np.ndarray, ...],
    flexion: tuple[float, float],
    abduction: tuple[float, float],
) -> np.ndarray:
    """(K, 2) rad convex polygon of swings about ``axes`` from a left limb's rest direction.

    The limits are anatomical: flexion and abduction (degrees) are the components, about -X and
    -Y, of the turn that brings the hanging limb to its direction, taken together up to half a
    turn. Each direction on the outline of that range becomes the swing from ``bone``; the polygon
    is their convex hull.
    """
    share = np.linspace(0, 1, 40)
    low, high = np.array([flexion, abduction], float).T
    corners = np.array([low, [high[0], low[1]], high, [low[0], high[1]], low])
    outline = np.concatenate([a + share[:, None] * (b - a) for a, b in pairwise(corners)])
    outline *= np.minimum(1, 180 / np.linalg.norm(outline, axis=1).clip(1e-9))[:, None]
    turns = np.radians(outline[:, :1] * -LEFT + outline[:, 1:] * FORWARD)
    directions = Rotation.from_rotvec(turns).apply(-UP)
    across = np.cross(bone, directions)
    sines = np.linalg.norm(across, axis=1)
    angles = np.arctan2(sines, directions @ bone)
    swings = across * (angles / sines.clip(1e-9))[:, None] @ np.stack(axes, axis=1)
    return swings[ConvexHull(swings).vertices]
