"""Any armature with its meshes as a body to be tracked.

Deforming bones become joints, in their rest pose (`rig_joints`); their locks and limits become DOFs
(`rig_dofs`); the tree that they make becomes parts (`rig_parts`); vertex groups become skin.

The body stands on z = 0, a person with the root over the origin. A body that is nobody's has its
middle there, and so has its first joint, lest it be carried away when its heading is sought.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...core.body.body import Body, Dofs, Skin, Surface
from ...core.body.kinematics import rest_joints
from ...core.errors import MocapError
from .rig_dofs import PLACES, Row, bone_rows, root_rows
from .rig_joints import RigJoints, rig_joints
from .rig_mesh import RestMesh, at_rest, followers, rest_mesh
from .rig_names import point_bones
from .rig_parts import Tree, limbs_of, parts_of, person_limbs, places_of, points_of_tree

_SMALL = 0.03
"""Of the body's size: ends of bones that reach less far are held."""
_SAME_M = 1e-4
_EVEN = 1e-3
"""By which an armature's scales may differ."""


@dataclass(frozen=True, eq=False)
class Rig:
    """A body and the bones it came from.

    Attributes:
        body: its joints are named like their bones.
        metres_from_armature: (4, 4) from the armature's space to the body's, rest poses both.
        carriers: bone's name -> its joint, of all bones that go with the body.
    """

    body: Body
    metres_from_armature: np.ndarray
    carriers: dict[str, int]

    def resized(self, body: Body) -> "Rig":
        """The rig whose body is ``body``, which was read of it and scaled as a whole.

        Raises:
            MocapError: it was read of something else.
        """
        if body.dofs.names != self.body.dofs.names or body.joint_names != self.body.joint_names:
            raise MocapError(
                f"the rig {self.body.name!r} has other bones now than when the take was fitted",
                "fit the take anew",
            )
        rest, own = rest_joints(body), rest_joints(self.body)
        size = float(np.linalg.norm(rest) / np.linalg.norm(own))
        if np.abs(rest - size * own).max() > _SAME_M:
            raise MocapError(
                f"the rig {self.body.name!r} has another rest pose now than when the take was "
                "fitted",
                "fit the take anew",
            )
        scale = np.diag([size, size, size, 1.0])
        return Rig(body, scale @ self.metres_from_armature, self.carriers)


@dataclass(frozen=True, eq=False)
class _Skeleton:
    """What is known of the bones, in metres of the scene's world.

    Attributes:
        armature: the object.
        matrix: (4, 4) from its space.
        joints: the chosen ones.
        tree: theirs.
        points: points of a person -> joint and place (3,), as far as they are known.
    """

    armature: bpy.types.Object
    matrix: np.ndarray
    joints: RigJoints
    tree: Tree
    points: dict[str, tuple[int, np.ndarray]]


def read_rig(
    armature: bpy.types.Object, objects: Iterable[bpy.types.Object], metres_per_unit: float
) -> Rig:
    """The ``armature`` with those of the ``objects`` that follow it; all of them stay as they are.

    Args:
        armature: an armature object.
        objects: where its meshes are among.
        metres_per_unit: the scale of its scene.

    Raises:
        MocapError: no mesh follows it, or it is stretched or mirrored as an object.
    """
    meshes = followers(armature, objects)
    with at_rest(armature, meshes) as depsgraph:
        mesh = rest_mesh(armature, meshes, depsgraph)
        world = np.array(armature.evaluated_get(depsgraph).matrix_world)
    metres = np.diag([*[metres_per_unit] * 3, 1.0])
    mesh = replace(mesh, vertices=mesh.vertices * metres_per_unit)
    size = float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))
    matrix = metres @ world
    joints = rig_joints(armature, mesh.weights, _SMALL * size / _scale(armature, matrix))
    weights = _joint_weights(mesh, joints)
    owners = weights[mesh.triangles].sum(axis=1).argmax(axis=1)
    tree = _tree(armature, matrix, joints, np.unique(owners), size)
    points = _known_points(armature, matrix, joints)
    skeleton = _Skeleton(armature, matrix, joints, tree, points)
    return _assembled(skeleton, mesh, weights, owners)


def _scale(armature: bpy.types.Object, matrix: np.ndarray) -> float:
    """Metres that a unit of the armature's space is long."""
    axes = matrix[:3, :3]
    scale = float(np.cbrt(max(np.linalg.det(axes), 0.0)))
    if not scale or np.abs(axes.T @ axes / scale**2 - np.eye(3)).max() > _EVEN:
        raise MocapError(
            f"the armature {armature.name!r} is stretched or mirrored as an object",
            "apply its scale (Ctrl A)",
        )
    return scale


def _joint_weights(mesh: RestMesh, joints: RigJoints) -> np.ndarray:
    """(n, J) weights of the vertices; what follows no bone follows the root."""
    weights = np.zeros((len(mesh.vertices), len(joints.names)))
    for bone, own in mesh.weights.items():
        weights[:, joints.carriers[bone]] += own
    weights[weights.sum(axis=1) == 0, 0] = 1.0
    return weights


def _placed(matrix: np.ndarray, places: Iterable) -> np.ndarray:
    """(n, 3) places in the armature's space, in metres of the world."""
    return np.array([tuple(place) for place in places]) @ matrix[:3, :3].T + matrix[:3, 3]


def _tree(
    armature: bpy.types.Object,
    matrix: np.ndarray,
    joints: RigJoints,
    solid: np.ndarray,
    size: float,
) -> Tree:
    bones = armature.data.bones
    own = [bones[name] for name in joints.names]
    parents = [joints.carriers.get(bone.parent.name, -1) if bone.parent else -1 for bone in own]
    heads, tips = _placed(matrix, [bone.head_local for bone in own]), []
    for joint, head in enumerate(heads):
        carried = [name for name, carrier in joints.carriers.items() if carrier == joint]
        tails = _placed(matrix, [bones[name].tail_local for name in carried])
        tips.append(tails[np.linalg.norm(tails - head, axis=1).argmax()])
    seen = np.isin(np.arange(len(own)), solid)
    return Tree(joints.names, np.array([-1, *parents[1:]]), heads, np.array(tips), seen, size)


def _known_points(
    armature: bpy.types.Object, matrix: np.ndarray, joints: RigJoints
) -> dict[str, tuple[int, np.ndarray]]:
    """Points begin with their bones; that of the head is the middle of its bone."""
    found = {}
    for point, name in point_bones(joints.carriers).items():
        bone = armature.data.bones[name]
        tail = bone.tail_local if point == "head" else bone.head_local
        place = (bone.head_local + tail) / 2
        found[point] = joints.carriers[name], _placed(matrix, [place])[0]
    return found


def _assembled(skeleton: _Skeleton, mesh: RestMesh, weights: np.ndarray, owners: np.ndarray) -> Rig:
    tree, known = skeleton.tree, skeleton.points
    limbs = limbs_of(tree)
    carriers = {point: joint for point, (joint, _) in known.items()}
    person = person_limbs(limbs, carriers)
    limbs = limbs if person is None else person
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    heads = tree.heads.copy()
    if person is None:
        heads[0, :2] = (low + high)[:2] / 2
    tree = replace(tree, heads=heads)
    places = places_of(tree, limbs, carriers)
    dofs = _dofs(skeleton, places)
    points = points_of_tree(tree, known, person is not None)
    segments = np.flatnonzero(tree.solid)
    origin = np.array([*heads[0, :2], low[2]])
    above = np.where(tree.parents[:, None] < 0, origin, heads[tree.parents])
    body = Body(
        name=skeleton.armature.name,
        joint_names=tree.names,
        parents=tree.parents,
        offsets=heads - above,
        tails=tree.tips - heads,
        dofs=dofs,
        cones={},
        segment_names=tuple(tree.names[joint] for joint in segments),
        segment_joints=segments,
        surfaces=(_surface(mesh, weights, owners, heads),),
        point_joints=points.joints,
        point_offsets=points.offsets,
        parts=parts_of(tree, limbs, person is not None, (dofs.joints, dofs.kinds), places),
        point_names=points.names,
    )
    shift = np.eye(4)
    shift[:3, 3] = -origin
    return Rig(body, shift @ skeleton.matrix, skeleton.joints.carriers)


def _dofs(skeleton: _Skeleton, places: list[str]) -> Dofs:
    armature, names = skeleton.armature, skeleton.tree.names
    rows: list[tuple[int, Row]] = [(0, row) for row in root_rows()]
    turn = skeleton.matrix[:3, :3] / np.linalg.norm(skeleton.matrix[:3, :3], axis=0)
    for joint, name in enumerate(names[1:], start=1):
        bone = armature.pose.bones[name]
        axes = turn @ np.array(bone.bone.matrix_local)[:3, :3]
        rows += [(joint, row) for row in bone_rows(bone, axes, PLACES[places[joint]])]
    return Dofs(
        names=tuple(f"{names[joint]}_{row.name}" for joint, row in rows),
        joints=np.array([joint for joint, _ in rows]),
        kinds=np.array([row.kind for _, row in rows]),
        axes=np.array([row.axis / np.linalg.norm(row.axis) for _, row in rows]),
        limits=np.array([row.limits for _, row in rows]),
        rest_spread=np.array([row.spread for _, row in rows]),
        directions=tuple(row.direction for _, row in rows),
    )


def _surface(mesh: RestMesh, weights: np.ndarray, owners: np.ndarray, heads: np.ndarray) -> Surface:
    """The triangles by the joint that each follows most, the vertices with their four best."""
    best = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    best = np.pad(best, ((0, 0), (0, 4 - best.shape[1])))
    shares = np.take_along_axis(weights, best, axis=1)
    shares[:, weights.shape[1] :] = 0.0
    vertices, triangles, rows = [], [], []
    vertex_starts, triangle_starts = [0], [0]
    for joint in np.unique(owners):
        own, corners = np.unique(mesh.triangles[owners == joint], return_inverse=True)
        vertices.append(mesh.vertices[own] - heads[joint])
        triangles.append(corners.reshape(-1, 3) + vertex_starts[-1])
        rows.append(own)
        vertex_starts.append(vertex_starts[-1] + len(own))
        triangle_starts.append(triangle_starts[-1] + len(triangles[-1]))
    taken = np.concatenate(rows)
    return Surface(
        np.concatenate(vertices),
        np.concatenate(triangles),
        np.array(vertex_starts),
        np.array(triangle_starts),
        skin=Skin(best[taken], shares[taken]),
    )
