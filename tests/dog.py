"""A body that is nobody's: a dog of boxes with four legs, a tail and a head on a neck."""

from functools import cache

import numpy as np
from silhouette_mocap.core.body.body import Body, DofKind, Dofs, Part, Surface

_X, _Y, _Z = np.eye(3)
# name, parent, place of the joint, end of its bone, thickness
_BONES = (
    ("trunk", "", (0, 0.35, 0.6), (0, -0.35, 0.62), 0.1),
    ("neck", "trunk", (0, -0.37, 0.66), (0, -0.55, 0.85), 0.05),
    ("head", "neck", (0, -0.55, 0.85), (0, -0.8, 0.82), 0.06),
    ("tail", "trunk", (0, 0.38, 0.64), (0, 0.75, 0.75), 0.02),
    *(
        (f"{end}_{bone}_{side}", (parent and f"{end}_{parent}_{side}") or "trunk", *places, 0.04)
        for end, y in (("fore", -0.28), ("hind", 0.28))
        for side, x in (("l", 0.12), ("r", -0.12))
        for bone, parent, places in (
            ("thigh", "", ((x, y, 0.55), (x, y + 0.03, 0.3))),
            ("shank", "thigh", ((x, y + 0.03, 0.3), (x, y, 0.04))),
        )
    ),
)
_CORNERS = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (0, 1)], float)
_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
     [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)  # fmt: skip


@cache
def dog() -> Body:
    """0.9 m tall; its points are the ends of its bones."""
    names = tuple(bone[0] for bone in _BONES)
    parents = [names.index(bone[1]) if bone[1] else -1 for bone in _BONES]
    heads, tails = (np.array([bone[k] for bone in _BONES], float) for k in (2, 3))
    offsets = heads - np.where(np.array(parents)[:, None] < 0, 0, heads[parents])
    count = len(names)
    return Body(
        name="dog",
        joint_names=names,
        parents=parents,
        offsets=offsets,
        tails=tails - heads,
        dofs=_dofs(names),
        cones={},
        segment_names=names,
        segment_joints=range(count),
        surfaces=(_boxes(tails - heads),),
        point_joints=range(count),
        point_offsets=tails - heads,
        parts=_parts(names),
        point_names=tuple(f"end of {name}" for name in names),
    )


def _dofs(names: tuple[str, ...]) -> Dofs:
    rows = [("trunk", DofKind.TRANSLATION, axis) for axis in (_X, _Y, _Z)]
    rows += [("trunk", DofKind.HINGE, axis) for axis in (_Z, _Y, _X)]
    for name in names[1:]:
        if "shank" in name:
            rows.append((name, DofKind.HINGE, _X))
        else:
            rows += [(name, DofKind.SWING, axis) for axis in (_X, _Z if name == "tail" else _Y)]
    free = np.array([name == "trunk" for name, *_ in rows])
    return Dofs(
        names=[f"{name} {k}" for k, (name, *_) in enumerate(rows)],
        joints=[names.index(name) for name, *_ in rows],
        kinds=[kind for _, kind, _ in rows],
        axes=[axis for *_, axis in rows],
        limits=np.where(free[:, None], [-np.inf, np.inf], [-1.5, 1.5]),
        rest_spread=np.where(free, np.inf, 1.0),
        directions=("turns",) * len(rows),
    )


def _boxes(tails: np.ndarray) -> Surface:
    vertices = []
    for bone, tail in zip(_BONES, tails, strict=True):
        along = tail / np.linalg.norm(tail)
        across = np.cross(along, _X if abs(along[0]) < 0.9 else _Z)
        across /= np.linalg.norm(across)
        axes = np.stack([bone[4] * across, bone[4] * np.cross(along, across), tail])
        vertices.append(_CORNERS @ axes)
    return Surface(
        np.concatenate(vertices),
        np.concatenate([_FACES + 8 * k for k in range(len(_BONES))]),
        8 * np.arange(len(_BONES) + 1),
        12 * np.arange(len(_BONES) + 1),
    )


def _parts(names: tuple[str, ...]) -> tuple[Part, ...]:
    joints = np.array([names.index(name) for name in _row_joints(names)])
    limbs = [
        [f"{end}_{b}_{s}" for b in ("thigh", "shank")] for end in ("fore", "hind") for s in "lr"
    ]
    parts = [("torso", "torso", ["trunk"]), *((limb[0], "limb", limb) for limb in limbs)]
    parts += [("tail", "limb", ["tail"]), ("neck", "limb", ["neck", "head"])]
    found = []
    for name, role, moving in parts:
        own = [names.index(joint) for joint in moving]
        dofs = tuple(int(row) for row in np.flatnonzero(np.isin(joints, own)))
        segments = tuple(range(len(names))) if role == "torso" else tuple(own)
        found.append(Part(name, role, dofs, dofs if role == "limb" else (), segments))
    return tuple(found)


def _row_joints(names: tuple[str, ...]) -> list[str]:
    return [names[joint] for joint in _dofs(names).joints]
