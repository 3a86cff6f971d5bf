"""A joint's rotation against its parent: from its DOFs, and back to the DOFs nearest to given ones.

Angles of several DOFs of one joint cannot be averaged: yaw runs over whole turns and means nothing
at a roll of 90 degrees, and a swing's two values shrink distances far from rest. Rotations can. The
way back is a few Gauss-Newton steps from DOFs that are near, so that whole turns stay whole turns;
where a joint has fewer than three DOFs, the nearest rotation that it can make is taken.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...body.body import Body, DofKind

_STEPS = 8
_DAMPING = 1e-9
_CLOSE = 1e-13


@dataclass(frozen=True, eq=False)
class JointRotation:
    """The rotation of one joint of a body.

    Attributes:
        rows: (k,) indices of its DOFs that turn, in their order.
        kinds: (k,) values of `DofKind`.
        axes: (k, 3) in the joint's space.
    """

    rows: np.ndarray
    kinds: np.ndarray
    axes: np.ndarray

    @classmethod
    def of(cls, body: Body, joint: int) -> "JointRotation":
        """That of ``joint``; without rows where it cannot turn."""
        dofs = body.dofs
        rows = np.flatnonzero((dofs.joints == joint) & (dofs.kinds != DofKind.TRANSLATION))
        return cls(rows, dofs.kinds[rows], dofs.axes[rows])

    def rotations(self, values: np.ndarray) -> np.ndarray:
        """(T, 3, 3) of values (T, k)."""
        return self._turned(values)[0]

    def nearest(self, rotations: np.ndarray, values: np.ndarray) -> np.ndarray:
        """(T, k) values that come nearest to rotations (T, 3, 3), sought from values (T, k)."""
        for _ in range(_STEPS):
            turned, axes = self._turned(values)
            off = logarithms(rotations @ turned.transpose(0, 2, 1))
            squares = axes.transpose(0, 2, 1) @ axes + _DAMPING * np.eye(len(self.rows))
            slopes = (axes.transpose(0, 2, 1) @ off[..., None])[..., 0]
            steps = np.linalg.solve(squares, slopes[..., None])[..., 0]
            values = values + steps
            if (np.abs(steps) < _CLOSE).all():
                break
        return values

    def _turned(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(T, 3, 3) rotations, and (T, 3, k) how they turn per rad of each value."""
        turned = np.broadcast_to(np.eye(3), (len(values), 3, 3))
        columns, row = [], 0
        while row < len(self.rows):
            count = 2 if self.kinds[row] == DofKind.SWING else 1
            own = self.axes[row : row + count].T
            vectors = values[:, row : row + count] @ own.T
            columns.append(turned @ (_left_jacobians(vectors) @ own if count == 2 else own))
            turned = turned @ Rotation.from_rotvec(vectors).as_matrix()
            row += count
        return turned, np.concatenate(columns, axis=2)


def logarithms(rotations: np.ndarray) -> np.ndarray:
    """(T, 3) rotation vectors of (T, 3, 3)."""
    return Rotation.from_matrix(rotations).as_rotvec()


def exponentials(vectors: np.ndarray) -> np.ndarray:
    """(T, 3, 3) rotations of rotation vectors (T, 3)."""
    return Rotation.from_rotvec(vectors).as_matrix()


def _left_jacobians(vectors: np.ndarray) -> np.ndarray:
    """(T, 3, 3) how fast the rotation turns, in the space around it, per change of its vector.

    With angle a, unit axis u: sin(a)/a I + (1 - sin(a)/a) u u^T + (1 - cos(a))/a [u]x.
    """
    angles = np.linalg.norm(vectors, axis=1)[:, None, None]
    units = vectors / np.maximum(angles[:, 0], 1e-12)
    straight = np.sinc(angles / np.pi)
    sideways = np.sin(angles / 2) * np.sinc(angles / (2 * np.pi))
    outer = units[:, :, None] * units[:, None]
    crosses = np.cross(units[:, None], np.eye(3)).transpose(0, 2, 1)
    return straight * np.eye(3) + (1 - straight) * outer + sideways * crosses
