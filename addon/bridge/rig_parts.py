"""Trunk, limbs and ends of any tree of joints, and the points that it is scored by.

The trunk is the root and every joint on which two long branches hang, with all that lies between.
A limb is a long branch that hangs on the trunk, with whatever short ones hang on it: an arm, a
tail, a neck with its head. A person's limbs get a person's names.
"""

from dataclasses import dataclass

import numpy as np

from ...core.body.body import POINT_NAMES, DofKind, Part
from ...core.fitting.limbs import LIMB_NAMES, limb_of

_LONG = 0.1
"""Of the body's size, that a branch reaches at least to be a limb."""
_MOST_LIMBS = 12
_GRID = 4
"""DOFs of a limb's grid search at most."""


@dataclass(frozen=True, eq=False)
class Tree:
    """J joints, the root first, parents before their children.

    Attributes:
        names: their bones.
        parents: (J,) -1 for the root.
        heads: (J, 3) rest places, metres.
        tips: (J, 3) the farthest end of what each carries that moves with no other joint.
        solid: (J,) bool, whether any triangle follows it.
        size: metres, the body's diagonal.
    """

    names: tuple[str, ...]
    parents: np.ndarray
    heads: np.ndarray
    tips: np.ndarray
    solid: np.ndarray
    size: float

    def children(self, joint: int) -> list[int]:
        """The joints that hang on it."""
        return [int(child) for child in np.flatnonzero(self.parents == joint)]

    def below(self, joint: int) -> tuple[int, ...]:
        """It and all that hangs on it, in order."""
        found = [joint]
        for child in range(joint + 1, len(self.parents)):
            if self.parents[child] in found:
                found.append(child)
        return tuple(found)

    def reaches(self) -> np.ndarray:
        """(J,) metres along the bones from each joint to its farthest end."""
        reaches = np.linalg.norm(self.tips - self.heads, axis=1)
        for joint in range(len(self.parents) - 1, 0, -1):
            above = int(self.parents[joint])
            step = float(np.linalg.norm(self.heads[joint] - self.heads[above]))
            reaches[above] = max(reaches[above], step + reaches[joint])
        return reaches


@dataclass(frozen=True)
class Limb:
    """A branch of the tree.

    Attributes:
        name: one of a person's `LIMB_NAMES`, ``head``, or its first bone's.
        joints: all of them, in order.
        chain: those on the way to the farthest end.
    """

    name: str
    joints: tuple[int, ...]
    chain: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Points:
    """P points.

    Attributes:
        names: theirs.
        joints: (P,) that carry them.
        offsets: (P, 3) metres from the joints.
    """

    names: tuple[str, ...]
    joints: np.ndarray
    offsets: np.ndarray


def limbs_of(tree: Tree) -> list[Limb]:
    """The limbs, the longest first, named by their first bones; the trunk is what is left.

    Where nothing would be left to see of the trunk, the longest limb belongs to it.
    """
    reaches = tree.reaches()
    long = reaches >= _LONG * tree.size
    trunk = {0}
    for joint in range(len(tree.names)):
        if sum(long[child] for child in tree.children(joint)) >= 2:
            while joint not in trunk:
                trunk.add(joint)
                joint = int(tree.parents[joint])
    tops = [
        joint
        for joint in np.argsort(-reaches, kind="stable").tolist()
        if joint not in trunk and int(tree.parents[joint]) in trunk and long[joint]
    ]
    tops = [joint for joint in tops if tree.solid[list(tree.below(joint))].any()][:_MOST_LIMBS]
    while tops and not _left(tree, tops):
        tops.pop(0)
    return [Limb(tree.names[top], tree.below(top), _chain(tree, top, reaches)) for top in tops]


def _left(tree: Tree, tops: list[int]) -> bool:
    """Whether any of the body is seen that no limb moves."""
    moved = [joint for top in tops for joint in tree.below(top)]
    return bool(np.delete(tree.solid, moved).any())


def _chain(tree: Tree, top: int, reaches: np.ndarray) -> tuple[int, ...]:
    chain = [top]
    while children := tree.children(chain[-1]):
        chain.append(max(children, key=lambda child: reaches[child]))
    return tuple(chain)


def person_limbs(limbs: list[Limb], points: dict[str, int]) -> list[Limb] | None:
    """The limbs with a person's names in a person's order, then the rest; None where nobody is.

    ``points`` are the joints that carry the known ones of `POINT_NAMES`.
    """
    if set(points) != set(POINT_NAMES):
        return None
    named = {}
    for point in ("left_wrist", "right_wrist", "left_ankle", "right_ankle", "head"):
        holders = [limb for limb in limbs if points[point] in limb.joints]
        if len(holders) != 1:
            return None
        named["head" if point == "head" else LIMB_NAMES[limb_of(point)]] = holders[0]
    if len({limb.joints for limb in named.values()}) != len(named):
        return None
    order = (*LIMB_NAMES[1:], "head")
    own = [Limb(name, named[name].joints, named[name].chain) for name in order]
    return own + [limb for limb in limbs if limb not in named.values()]


def places_of(tree: Tree, limbs: list[Limb], points: dict[str, int]) -> list[str]:
    """J names of `rig_dofs.PLACES`; ``points`` are known ones and their joints."""
    places = ["spine"] * len(tree.names)
    for limb in limbs:
        for joint in limb.joints:
            places[joint] = "neck" if limb.name == "head" else "limb"
    for point, joint in points.items():
        kind = point.rpartition("_")[2]
        if places[joint] != "spine" and kind not in ("neck", "head"):
            places[joint] = kind
        if kind == "shoulder":
            for limb in limbs:
                if joint in limb.chain:
                    for above in limb.chain[: limb.chain.index(joint)]:
                        places[above] = "clavicle"
    head = points.get("head")
    if head is not None and places[head] == "neck":
        places[head] = "head"
    return places


def parts_of(
    tree: Tree, limbs: list[Limb], person: bool, dofs: tuple[np.ndarray, ...], places: list[str]
) -> tuple[Part, ...]:
    """Torso, spine, limbs, then ends: head, hands, feet, or a limb's last joint.

    ``dofs`` are the joint and the kind of each DOF, (D,) both.
    """
    joints, _ = dofs
    segments = [joint for joint in range(len(tree.names)) if tree.solid[joint]]

    def part(name: str, role: str, own: tuple[int, ...], grid: tuple[int, ...] = ()) -> Part:
        rows = tuple(int(row) for row in np.flatnonzero(np.isin(joints, own)))
        moved = {below for joint in own for below in tree.below(joint)}
        seen = tuple(k for k, joint in enumerate(segments) if joint in moved)
        return Part(name, role, rows, grid, seen)

    held = {joint for limb in limbs for joint in limb.joints}
    spine = tuple(joint for joint in range(1, len(tree.names)) if joint not in held)
    found = [part("torso", "torso", (0,))]
    found += [part("spine", "spine", spine)] if spine else []
    ends = []
    for limb in limbs:
        if person and limb.name not in LIMB_NAMES:
            ends.append(part(limb.name, "end", limb.joints))
            continue
        last = tree.below(limb.chain[-1]) if len(limb.chain) > 2 else ()
        last = last if tree.solid[list(last)].any() else ()
        searched = tuple(joint for joint in limb.joints if joint not in last)
        grid = _grid([joint for joint in limb.chain if joint in searched], dofs, places)
        found.append(part(limb.name, "limb", searched, grid))
        if last:
            ends.append(part(f"end of {limb.name}", "end", last))
    return (*found, *(end for end in ends if end.dofs and end.segments))


def _grid(chain: list[int], dofs: tuple[np.ndarray, ...], places: list[str]) -> tuple[int, ...]:
    """DOFs of a limb's first two joints: those that bend before those that twist."""
    joints, kinds = dofs
    first = [joint for joint in chain if places[joint] != "clavicle"][:2]
    rows = np.flatnonzero(np.isin(joints, first)).tolist()
    swings = [row for row in rows if kinds[row] == DofKind.SWING]
    turns = [row for row in rows if kinds[row] != DofKind.SWING]
    hinges = [row for row in turns if not (kinds[joints == joints[row]] == DofKind.SWING).any()]
    twists = [row for row in turns if row not in hinges]
    return tuple(sorted((swings + hinges + twists)[:_GRID]))


def points_of_tree(tree: Tree, known: dict[str, tuple[int, np.ndarray]], person: bool) -> Points:
    """A person's points, or else the joints and the ends of the last ones.

    ``known`` are joints and places (3,) of points of `POINT_NAMES`; joints go by these names.
    """
    if person:
        rows = [(name, *known[name]) for name in POINT_NAMES]
    else:
        called = {joint: name for name, (joint, _) in known.items() if name != "head"}
        rows = [
            (called.get(joint, name), joint, tree.heads[joint])
            for joint, name in enumerate(tree.names)
        ]
        rows += [
            (f"end of {name}", joint, tree.tips[joint])
            for joint, name in enumerate(tree.names)
            if not tree.children(joint)
        ]
    joints = np.array([joint for _, joint, _ in rows])
    offsets = np.array([place for *_, place in rows]) - tree.heads[joints]
    return Points(tuple(name for name, *_ in rows), joints, offsets)
