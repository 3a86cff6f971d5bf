"""What a body is: joints, degrees of freedom, segments and their surfaces.

World and body space: metres, Z up; in the rest pose the performer stands on z = 0 and looks along
-Y, the left hand at +X. The rest pose is the pose of zeros. In it every joint's axes are parallel
to the world's, so a joint is placed by an offset alone:

    world_from_joint[j] = world_from_joint[parent] @ translate(offset[j]) @ motion[j](pose)

and ``motion[j]`` is the product, in the order of the DOF table, of the joint's elementary motions:
a translation along an axis, a hinge about an axis, or a swing, two neighbouring rows whose values
(a, b) form one rotation vector a * axis_1 + b * axis_2. Axes are given in the joint's own space.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from ..geometry.arrays import check_indices, frozen_array

POINT_NAMES = (
    "head", "neck",
    "left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist",
    "left_hip", "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle",
)  # fmt: skip


def unsided(name: str) -> str:
    """The name of a joint, segment or part without its side."""
    return name.removeprefix("left_").removeprefix("right_")


class DofKind(IntEnum):
    """The elementary motion of one row of the DOF table."""

    TRANSLATION = 0
    HINGE = 1
    SWING = 2
    """One half of a swing: the two rows stand next to each other, their axes perpendicular."""


@dataclass(frozen=True, eq=False)
class Dofs:
    """The DOF table, D rows ordered by joint.

    Attributes:
        names: D unique names, such as ``left_elbow_flexion``.
        joints: (D,) int32 index of the joint each row moves.
        kinds: (D,) int32, values of `DofKind`.
        axes: (D, 3) unit axes in the joint's space.
        limits: (D, 2) lowest and highest value, rad or m; infinite where free.
        rest_spread: (D,) spread about zero of the rest prior, rad or m; infinite for none.
        directions: D sentences, what the positive direction does ("bends the forearm up").
    """

    names: tuple[str, ...]
    joints: np.ndarray
    kinds: np.ndarray
    axes: np.ndarray
    limits: np.ndarray
    rest_spread: np.ndarray
    directions: tuple[str, ...]

    def __post_init__(self):
        count = len(self.names)
        set_ = object.__setattr__
        set_(self, "joints", frozen_array(self.joints, (count,), "joints", np.int32))
        set_(self, "kinds", frozen_array(self.kinds, (count,), "kinds", np.int32))
        set_(self, "axes", frozen_array(self.axes, (count, 3), "axes"))
        for name, shape in (("limits", (count, 2)), ("rest_spread", (count,))):
            values = np.array(getattr(self, name), float)
            if values.shape != shape or np.isnan(values).any():
                raise ValueError(f"expected {name} of shape {shape} without NaN")
            values.setflags(write=False)
            set_(self, name, values)
        swings = np.flatnonzero(self.kinds == DofKind.SWING)
        apart = len(swings) % 2 or (swings[1::2] - swings[::2] != 1).any()
        if apart or (self.joints[swings[1::2]] != self.joints[swings[::2]]).any():
            raise ValueError("expected the rows of a swing in neighbouring pairs of one joint")
        if len(set(self.names)) != count or len(self.directions) != count:
            raise ValueError("expected one unique name and one direction for every DOF")

    def __len__(self) -> int:
        return len(self.names)


@dataclass(frozen=True, eq=False)
class Skin:
    """Which joints a surface's vertices follow, and how much (linear blend skinning).

    In a pose, a vertex lies at the sum of its four weights times where each joint would carry it,
    had it been fixed to that joint in the rest pose; rounded to float32.

    Attributes:
        joints: (n, 4) int32.
        weights: (n, 4) float32, not negative, each row made to sum up to 1.
    """

    joints: np.ndarray
    weights: np.ndarray

    def __post_init__(self):
        set_ = object.__setattr__
        joints = frozen_array(self.joints, (None, 4), "skin joints", np.int32)
        weights = frozen_array(self.weights, (len(joints), 4), "skin weights")
        sums = weights.sum(axis=1, keepdims=True)
        if (weights < 0).any() or (sums <= 0).any():
            raise ValueError("expected skin weights of at least 0, and one above 0 in every row")
        set_(self, "joints", joints)
        set_(self, "weights", frozen_array(weights / sums, (None, 4), "skin weights", np.float32))


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangle meshes of all segments at one level of detail; any triangle soup.

    Attributes:
        vertices: (n, 3) float32 metres, in the space of the joint that carries the segment.
        triangles: (m, 3) int32 indices into ``vertices``, grouped by segment.
        vertex_starts: (S + 1,) int32; segment s owns vertices
            vertex_starts[s] to vertex_starts[s + 1].
        triangle_starts: (S + 1,) int32, likewise.
        outline_distance: metres that the outlines of its silhouettes lie beside those of the
            body's finest surface, on average; 0 for that one.
        skin: which joints the vertices follow; None where all are fixed to their segment's joint.
    """

    vertices: np.ndarray
    triangles: np.ndarray
    vertex_starts: np.ndarray
    triangle_starts: np.ndarray
    outline_distance: float = 0.0
    skin: Skin | None = None

    def __post_init__(self):
        set_ = object.__setattr__
        set_(self, "vertices", frozen_array(self.vertices, (None, 3), "vertices", np.float32))
        set_(self, "triangles", frozen_array(self.triangles, (None, 3), "triangles", np.int32))
        check_indices(self.triangles, len(self.vertices), "triangles")
        for name, items in (("vertex_starts", self.vertices), ("triangle_starts", self.triangles)):
            starts = frozen_array(getattr(self, name), (None,), name, np.int32)
            if (np.diff(starts) < 0).any() or [*starts[:1], *starts[-1:]] != [0, len(items)]:
                raise ValueError(f"expected {name} rising from 0 to {len(items)}, got {starts}")
            set_(self, name, starts)
        if not 0 <= self.outline_distance < np.inf:
            raise ValueError(f"expected an outline distance in m, got {self.outline_distance}")
        if self.skin is not None and len(self.skin.joints) != len(self.vertices):
            raise ValueError(f"expected a skin of {len(self.vertices)} rows")


@dataclass(frozen=True, eq=False)
class Part:
    """A piece of the body that is searched as one, in the order of the body's ``parts``.

    Attributes:
        name: such as ``left_arm``.
        role: ``torso`` (the root's six), ``spine``, ``limb`` or ``end`` (head, hand, foot).
        dofs: the DOFs searched, indices.
        grid: the DOFs of the grid search, a subset of ``dofs``; empty where there is none.
        segments: the segments that move with ``dofs``, indices.
    """

    name: str
    role: str
    dofs: tuple[int, ...]
    grid: tuple[int, ...]
    segments: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Body:
    """A jointed body, its segments rigid or skinned.

    Attributes:
        name: the template or rig it came from.
        joint_names: J names; ``left_`` and ``right_`` prefixes mark sides.
        parents: (J,) int32, -1 for the root; parents come before their children.
        offsets: (J, 3) rest position relative to the parent (the root's relative to the world).
        tails: (J, 3) end of the joint's bone, in the joint's space.
        dofs: the DOF table.
        cones: joint index -> (K, 2) convex polygon, counter-clockwise, that holds its swing pair.
        segment_names: S names.
        segment_joints: (S,) int32, the joint that carries each segment.
        surfaces: levels of detail, coarse first; all have S segments.
        point_joints: (P,) int32, the joint that carries each of the points.
        point_offsets: (P, 3) metres, in that joint's space.
        parts: pieces for part-wise search.
        point_names: P names; `POINT_NAMES` for people, others for what has other joints.
    """

    name: str
    joint_names: tuple[str, ...]
    parents: np.ndarray
    offsets: np.ndarray
    tails: np.ndarray
    dofs: Dofs
    cones: dict[int, np.ndarray]
    segment_names: tuple[str, ...]
    segment_joints: np.ndarray
    surfaces: tuple[Surface, ...]
    point_joints: np.ndarray
    point_offsets: np.ndarray
    parts: tuple[Part, ...]
    point_names: tuple[str, ...] = POINT_NAMES

    def __post_init__(self):
        joints, segments = len(self.joint_names), len(self.segment_names)
        points = len(self.point_names)
        set_ = object.__setattr__
        set_(self, "parents", frozen_array(self.parents, (joints,), "parents", np.int32))
        for name, count in (("offsets", joints), ("tails", joints), ("point_offsets", points)):
            set_(self, name, frozen_array(getattr(self, name), (count, 3), name))
        for name, count in (("segment_joints", segments), ("point_joints", points)):
            set_(self, name, frozen_array(getattr(self, name), (count,), name, np.int32))
            check_indices(getattr(self, name), joints, name)
        cones = {j: frozen_array(c, (None, 2), "a cone") for j, c in self.cones.items()}
        set_(self, "cones", cones)
        self._check_tables()

    def _check_tables(self):
        joints, segments = len(self.joint_names), len(self.segment_names)
        check_indices(self.dofs.joints, joints, "joints of DOFs")
        check_indices(list(self.cones), joints, "joints of cones")
        for part in self.parts:
            check_indices((*part.dofs, *part.grid), len(self.dofs), f"DOFs of {part.name}")
            check_indices(part.segments, segments, f"segments of {part.name}")
        if (np.diff(self.dofs.joints) < 0).any():
            raise ValueError("expected the DOF table ordered by joint")
        if (self.parents >= np.arange(joints)).any():
            raise ValueError("expected parents before their children")
        for surface in self.surfaces:
            if surface.skin is not None:
                check_indices(surface.skin.joints, joints, "skin joints")
        if any(len(surface.vertex_starts) != segments + 1 for surface in self.surfaces):
            raise ValueError(f"expected {segments} segments in every surface")

    @property
    def rest_pose(self) -> np.ndarray:
        """(D,) zeros."""
        return np.zeros(len(self.dofs))
