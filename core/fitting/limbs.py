"""The limbs that a fit is judged by, their segments and their points.

A person has those of `LIMB_NAMES`, whatever the body's parts are; a dog, a spider or a lamp has a
torso and every part whose role is limb.
"""

from functools import lru_cache

from ..body.body import POINT_NAMES, Body

LIMB_NAMES = ("torso", "left_arm", "right_arm", "left_leg", "right_leg")


def limb_names(body: Body) -> tuple[str, ...]:
    """L names, the torso's first."""
    if body.point_names == POINT_NAMES:
        return LIMB_NAMES
    return (LIMB_NAMES[0], *(part.name for part in body.parts if part.role == "limb"))


@lru_cache(maxsize=16)
def limb_segments(body: Body) -> tuple[tuple[int, ...], ...]:
    """The segments of each of `limb_names`; the torso holds all that no limb moves.

    Where a person has no such part, as the legs of ``nine_joint``, it is what carries their points.
    """
    names = limb_names(body)[1:]
    limbs = {part.name: part.segments for part in body.parts if part.role == "limb"}
    limbs = {name: limbs.get(name) or _carriers(body, name) for name in names}
    moved = {segment for segments in limbs.values() for segment in segments}
    torso = tuple(s for s in range(len(body.segment_names)) if s not in moved)
    return (torso, *limbs.values())


def _carriers(body: Body, limb: str) -> tuple[int, ...]:
    """The segments whose joints carry the limb's points."""
    joints = {int(body.point_joints[point]) for point in points_of(body, limb)}
    return tuple(s for s, joint in enumerate(body.segment_joints) if int(joint) in joints)


def limb_of(point: str) -> int:
    """Index in `LIMB_NAMES` of the limb that moves a point of `POINT_NAMES`."""
    side, _, joint = point.partition("_")
    if joint in ("elbow", "wrist"):
        return LIMB_NAMES.index(f"{side}_arm")
    if joint in ("knee", "ankle"):
        return LIMB_NAMES.index(f"{side}_leg")
    return 0


POINT_LIMBS = tuple(map(limb_of, POINT_NAMES))
"""Of each of a person's points."""


@lru_cache(maxsize=16)
def point_limbs(body: Body) -> tuple[int, ...]:
    """(P,) index in `limb_names` of the limb that moves each of the body's points."""
    if body.point_names == POINT_NAMES:
        return POINT_LIMBS
    carried = zip(body.point_joints.tolist(), body.point_offsets, strict=True)
    # where a limb begins, only what lies off its first joint moves
    moving = (joint if offset.any() else int(body.parents[joint]) for joint, offset in carried)
    return tuple(_limb_of_joint(body, joint) for joint in moving)


def _limb_of_joint(body: Body, joint: int) -> int:
    """Index of the limb with a segment that the joint carries; of the torso where there is none."""
    limbs = [part for part in body.parts if part.role == "limb"]
    for index, part in enumerate(limbs, start=1):
        if joint in body.segment_joints[list(part.segments)]:
            return index
    return 0


def points_of(body: Body, limb: str) -> list[int]:
    """Indices of the body's points that one of its `limb_names` moves."""
    index = limb_names(body).index(limb)
    return [k for k, own in enumerate(point_limbs(body)) if own == index]
