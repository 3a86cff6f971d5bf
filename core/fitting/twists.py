"""How fast the joints of a body move with its DOFs."""

from ctypes import byref

import numpy as np

from ..body.body import Body
from ..native.library import check, load
from ..rendering.model import body_record


class Twists:
    """Twists of one body's joints.

    A twist (6,) is the velocity of what would be at the world's origin, then the angular velocity:
    a point x fixed to a joint moves with v + w x x (Murray, Li, Sastry: A Mathematical Introduction
    to Robotic Manipulation, 1994, chapter 3).

    Args:
        body: whose.

    Attributes:
        moved: (J, D) bool, whether the joint moves with the DOF.
    """

    def __init__(self, body: Body):
        self._record = body_record(body, 0)
        self._shape = len(body.joint_names), len(body.dofs)
        above = np.eye(len(body.joint_names), dtype=bool)
        for joint, parent in enumerate(body.parents):
            if parent >= 0:
                above[joint] |= above[parent]
        self.moved = above[:, body.dofs.joints]

    def at(self, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Transforms (J, 3, 4), and twists (J, D, 6) per m or rad of each DOF, at a pose (D,).

        Raises:
            ValueError: the pose has another shape.
        """
        pose = np.ascontiguousarray(pose, float)
        joints, dofs = self._shape
        if pose.shape != (dofs,):
            raise ValueError(f"expected a pose of shape ({dofs},), got {pose.shape}")
        transforms, twists = np.empty((joints, 3, 4)), np.empty((dofs, 6))
        arrays = (array.ctypes.data for array in (pose, transforms, twists))
        check(load().sm_twists(byref(self._record), *arrays))
        return transforms, twists * self.moved[..., None]
