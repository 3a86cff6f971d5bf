"""Joints in many poses at once: the convention of body/body.py with few and large array operations.

`body.kinematics.joint_transforms` says the same plainly, and takes 2 ms for a single pose.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from ...body.body import Body, DofKind


class Chain:
    """The joints of a body as products of turns and shifts.

    Args:
        body: the model.
    """

    def __init__(self, body: Body):
        self._parents, self._offsets = body.parents.tolist(), body.offsets
        dofs = body.dofs
        vectors: list[np.ndarray] = []
        self._steps: list[list[tuple[bool, int]]] = [[] for _ in self._parents]
        inside_swing = False
        for row, (joint, kind) in enumerate(zip(dofs.joints.tolist(), dofs.kinds, strict=True)):
            second, inside_swing = inside_swing, kind == DofKind.SWING and not inside_swing
            if not second:
                vectors.append(np.zeros((len(dofs), 3)))
                self._steps[joint].append((kind != DofKind.TRANSLATION, len(vectors) - 1))
            # both rows of a swing add up to one rotation vector
            vectors[-1][row] = dofs.axes[row]
        self._count = len(vectors)
        self._vectors = np.reshape(vectors, (-1, len(dofs), 3)).swapaxes(0, 1)

    def transforms(self, poses: np.ndarray) -> np.ndarray:
        """(N, J, 3, 4) world from joint of poses (N, D), metres."""
        shape = len(poses), self._count, 3
        vectors = (poses @ self._vectors.reshape(poses.shape[1], -1)).reshape(shape)
        turns = np.zeros((*shape, 3))
        if vectors.size:
            rotations = Rotation.from_rotvec(vectors.reshape(-1, 3))
            turns = rotations.as_matrix().reshape(*shape, 3)
        rotations, places = [], []
        for joint, parent in enumerate(self._parents):
            rotation, place = np.eye(3)[None], self._offsets[joint][None, :, None]
            if parent >= 0:
                rotation = rotations[parent]
                place = rotation @ place + places[parent]
            for is_turn, step in self._steps[joint]:
                if is_turn:
                    rotation = rotation @ turns[:, step]
                else:
                    place = place + rotation @ vectors[:, step, :, None]
            rotations.append(rotation)
            places.append(place)
        out = np.empty((len(poses), len(rotations), 3, 4))
        for joint, (rotation, place) in enumerate(zip(rotations, places, strict=True)):
            out[:, joint, :, :3], out[:, joint, :, 3:] = rotation, place
        return out
