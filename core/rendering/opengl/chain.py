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
        self._steps: list[list[tuple[bool, int]]] = [[] for _ in self._parents]
        firsts, seconds, swings = [], [], []
        inside_swing = False
        for row, (joint, kind) in enumerate(zip(dofs.joints.tolist(), dofs.kinds, strict=True)):
            second, inside_swing = inside_swing, kind == DofKind.SWING and not inside_swing
            if second:
                # both rows of a swing add up to one rotation vector
                seconds.append(row)
                swings.append(len(firsts) - 1)
                continue
            self._steps[joint].append((kind != DofKind.TRANSLATION, len(firsts)))
            firsts.append(row)
        self._firsts, self._seconds, self._swings = firsts, seconds, swings
        self._axes = dofs.axes

    def transforms(self, poses: np.ndarray) -> np.ndarray:
        """(N, J, 3, 4) world from joint of poses (N, D), metres."""
        # DOF by DOF, so that one which is not finite spoils no joint but those it moves
        vectors = poses[:, self._firsts, None] * self._axes[self._firsts]
        vectors[:, self._swings] += poses[:, self._seconds, None] * self._axes[self._seconds]
        turns = np.zeros((*vectors.shape, 3))
        if vectors.size:
            rotations = Rotation.from_rotvec(vectors.reshape(-1, 3))
            turns = rotations.as_matrix().reshape(turns.shape)
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
