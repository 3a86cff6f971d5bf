"""The limbs that a fit is judged by, their segments and their points."""

from functools import lru_cache

from ..body.body import POINT_NAMES, Body

LIMB_NAMES = ("torso", "left_arm", "right_arm", "left_leg", "right_leg")


@lru_cache(maxsize=16)
def limb_segments(body: Body) -> tuple[tuple[int, ...], ...]:
    """The segments of each of `LIMB_NAMES`; the torso holds all that no limb moves.

    Where a body has no such part, as the legs of ``nine_joint``, it is what carries their points.
    """
    limbs = {name: _carriers(body, name) for name in LIMB_NAMES[1:]}
    limbs |= {part.name: part.segments for part in body.parts if part.role == "limb"}
    moved = {segment for segments in limbs.values() for segment in segments}
    torso = tuple(s for s in range(len(body.segment_names)) if s not in moved)
    return (torso, *(limbs[name] for name in LIMB_NAMES[1:]))


def _carriers(body: Body, limb: str) -> tuple[int, ...]:
    """The segments whose joints carry the limb's points."""
    joints = {int(body.point_joints[point]) for point in points_of(limb)}
    return tuple(s for s, joint in enumerate(body.segment_joints) if int(joint) in joints)


def limb_of(point: str) -> int:
    """Index in `LIMB_NAMES` of the limb that moves a point of `POINT_NAMES`."""
    side, _, joint = point.partition("_")
    if joint in ("elbow", "wrist"):
        return LIMB_NAMES.index(f"{side}_arm")
    if joint in ("knee", "ankle"):
        return LIMB_NAMES.index(f"{side}_leg")
    return 0


def points_of(limb: str) -> list[int]:
    """Indices in `POINT_NAMES` of the points that one of `LIMB_NAMES` moves."""
    index = LIMB_NAMES.index(limb)
    return [k for k, name in enumerate(POINT_NAMES) if limb_of(name) == index]
