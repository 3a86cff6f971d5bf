"""From descriptions of joints, segments and parts to a `Body`."""

from dataclasses import dataclass, field

import numpy as np

from ..body import POINT_NAMES, Body, DofKind, Dofs, Part
from .landmarks import landmarks
from .proportions import Proportions
from .skeleton import Joint, mirrored, on_the_right
from .surfaces import MIRROR, Level, surface


@dataclass(frozen=True)
class Segment:
    """A segment to be: its name, the joint that carries it, its surface pieces."""

    name: str
    joint: str
    pieces: tuple[str, ...]


@dataclass(frozen=True)
class Search:
    """A part to be, by the joints whose DOFs it searches; ``grid`` names joints or DOFs of them."""

    name: str
    role: str
    joints: tuple[str, ...]
    grid: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Plan:
    """A template: centre and left; what is left is built on the right as well.

    ``carriers`` names the joints of points that have none of their own.
    """

    name: str
    joints: tuple[Joint, ...]
    segments: tuple[Segment, ...]
    searches: tuple[Search, ...]
    carriers: dict[str, str] = field(default_factory=dict)


def assembled(plan: Plan, proportions: Proportions, levels: tuple[Level, ...]) -> Body:
    """The body of a plan with given proportions and levels of detail, coarse first."""
    joints = _both_sides(plan.joints, mirrored)
    segments = _both_sides(plan.segments, _mirrored_segment)
    searches = _in_turn(plan.searches)
    names = tuple(joint.name for joint in joints)
    places = _both_places(landmarks(proportions))
    parents = [names.index(joint.parent) if joint.parent else -1 for joint in joints]
    origins = np.array([places[name] for name in names])
    offsets = origins - np.where(np.array(parents)[:, None] < 0, 0, origins[parents])
    dofs = _dofs(joints)
    segment_joints = np.array([names.index(segment.joint) for segment in segments])
    carriers = plan.carriers | {on_the_right(p): on_the_right(j) for p, j in plan.carriers.items()}
    point_joints = [names.index(carriers.get(point, point)) for point in POINT_NAMES]
    point_places = np.array([places["skull" if p == "head" else p] for p in POINT_NAMES])
    return Body(
        name=plan.name,
        joint_names=names,
        parents=np.array(parents),
        offsets=offsets,
        tails=np.array([places[joint.tail] for joint in joints]) - origins,
        dofs=dofs,
        cones={
            i: np.round(joint.cone, 9) for i, joint in enumerate(joints) if joint.cone is not None
        },
        segment_names=tuple(segment.name for segment in segments),
        segment_joints=segment_joints,
        surfaces=tuple(
            surface(proportions, tuple((s.name, s.joint, s.pieces) for s in segments), level)
            for level in levels
        ),
        point_joints=np.array(point_joints),
        point_offsets=point_places - origins[point_joints],
        parts=tuple(_part(search, names, parents, dofs, segment_joints) for search in searches),
    )


def _both_sides(items: tuple, mirror) -> tuple:
    """Every item, and behind the left ones their mirror images as a second group."""
    rights = [mirror(item) for item in items if item.name.startswith("left_")]
    return (*items, *rights)


def _mirrored_segment(segment: Segment) -> Segment:
    return Segment(on_the_right(segment.name), on_the_right(segment.joint), segment.pieces)


def _in_turn(searches: tuple[Search, ...]) -> list[Search]:
    """Both sides of every search, the right one straight behind the left one."""
    out = []
    for search in searches:
        out.append(search)
        if search.name.startswith("left_"):
            rights = (tuple(map(on_the_right, names)) for names in (search.joints, search.grid))
            out.append(Search(on_the_right(search.name), search.role, *rights))
    return out


def _both_places(places: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    return places | {
        on_the_right(n): p * MIRROR for n, p in places.items() if n.startswith("left_")
    }


def _dofs(joints: tuple[Joint, ...]) -> Dofs:
    rows = [(index, row) for index, joint in enumerate(joints) for row in joint.rows]
    units = [1.0 if row.kind == DofKind.TRANSLATION else np.pi / 180 for _, row in rows]
    return Dofs(
        names=tuple(row.name for _, row in rows),
        joints=np.array([index for index, _ in rows]),
        kinds=np.array([row.kind for _, row in rows]),
        axes=np.array([row.axis for _, row in rows]),
        limits=np.round(
            [np.multiply(row.limits, unit) for (_, row), unit in zip(rows, units, strict=True)], 9
        ),
        rest_spread=np.array(
            [row.spread * unit for (_, row), unit in zip(rows, units, strict=True)]
        ),
        directions=tuple(row.direction for _, row in rows),
    )


def _part(
    search: Search,
    names: tuple[str, ...],
    parents: list[int],
    dofs: Dofs,
    segment_joints: np.ndarray,
) -> Part:
    searched = [names.index(name) for name in search.joints]
    named = zip((names[joint] for joint in dofs.joints), dofs.names, strict=True)
    gridded = [not set(search.grid).isdisjoint(either) for either in named]
    moving = set(searched)
    for joint, parent in enumerate(parents):
        if parent in moving:
            moving.add(joint)
    return Part(
        search.name,
        search.role,
        dofs=tuple(int(row) for row in np.flatnonzero(np.isin(dofs.joints, searched))),
        grid=tuple(int(row) for row in np.flatnonzero(gridded)),
        segments=tuple(int(s) for s in np.flatnonzero(np.isin(segment_joints, list(moving)))),
    )
