"""The points of a body's soles that may touch the floor.

They come from the finest surface as it stands in the rest pose: the heel and the tip of the foot
and, where the toes have a joint of their own, the ball below it. In between a sole is flat, and
what lies above it can wait.
"""

from dataclasses import dataclass

import numpy as np

from ...body.body import Body
from ...body.kinematics import joint_transforms, posed_segment
from ...errors import MocapError

_FRONT = np.array([0.0, -1.0, 0.0])
_THICK_M = 0.015
"""Of the layer above a foot's lowest vertex that counts as its sole."""
_END_M = 0.01
"""Length of sole whose middle stands for its end."""


@dataclass(frozen=True, eq=False)
class Soles:
    """P points of the feet.

    Attributes:
        feet: (P,) 0 for the left foot, 1 for the right.
        joints: (P,) that carry them.
        offsets: (P, 3) metres in the joints' spaces.
    """

    feet: np.ndarray
    joints: np.ndarray
    offsets: np.ndarray

    @classmethod
    def of(cls, body: Body) -> "Soles":
        """Those of ``body``; its feet are what moves with the ankles.

        Raises:
            MocapError: nothing of the body's surface does.
        """
        transforms = joint_transforms(body, body.rest_pose[None])[0]
        rows = []
        for foot, side in enumerate(("left", "right")):
            name = f"{side}_ankle"
            if name not in body.point_names:
                raise _no_feet(body)
            ankle = int(body.point_joints[body.point_names.index(name)])
            ends = _foot_ends(body, ankle, transforms)
            rows += [(foot, joint, place - transforms[joint, :, 3]) for joint, place in ends]
        feet, joints, offsets = zip(*rows, strict=True)
        return cls(np.array(feet), np.array(joints), np.array(offsets))

    def places(self, transforms: np.ndarray) -> np.ndarray:
        """(T, P, 3) in the world, of transforms (T, J, 3, 4)."""
        carried = transforms[:, self.joints]
        return (carried[..., :3] @ self.offsets[..., None])[..., 0] + carried[..., 3]


def _no_feet(body: Body) -> MocapError:
    return MocapError(f"the body {body.name} has no feet", "clean with --no-contacts")


def _foot_ends(body: Body, ankle: int, transforms: np.ndarray) -> list[tuple[int, np.ndarray]]:
    """Joints and places (3,) of heel, ball and tip in the rest pose."""
    chain = [ankle]
    for joint, parent in enumerate(body.parents.tolist()):
        if parent in chain:
            chain.append(joint)
    vertices = {joint: _vertices(body, joint, transforms) for joint in chain}
    vertices = {joint: own for joint, own in vertices.items() if len(own)}
    if not vertices:
        raise _no_feet(body)
    level = min(own[:, 2].min() for own in vertices.values())
    soles = {joint: own[own[:, 2] <= level + _THICK_M] for joint, own in vertices.items()}
    soles = {joint: sole for joint, sole in soles.items() if len(sole)}
    ends = [(min(soles), _end(soles[min(soles)], -_FRONT))]
    for joint in list(soles)[1:]:
        under = transforms[joint, :, 3]
        ends.append((joint, np.array([under[0], under[1], level])))
    ends.append((max(soles), _end(soles[max(soles)], _FRONT)))
    return ends


def _vertices(body: Body, joint: int, transforms: np.ndarray) -> np.ndarray:
    """(n, 3) of the joint's segments."""
    found = [np.zeros((0, 3))]
    for segment in np.flatnonzero(body.segment_joints == joint).tolist():
        vertices, carried = posed_segment(body, body.surfaces[-1], transforms, segment)
        found.append(vertices @ carried[:, :3].T + carried[:, 3])
    return np.concatenate(found)


def _end(sole: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """(3,) the middle of the end of a sole (n, 3), at its lowest."""
    along = sole @ towards
    end = sole[along >= along.max() - _END_M]
    return np.array([*end[:, :2].mean(axis=0), sole[:, 2].min()])
