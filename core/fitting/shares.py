"""Which parts of a body can be searched beside each other (Theobalt et al. 2003, section 5)."""

from dataclasses import dataclass

from ..body.body import Body, Part


@dataclass(frozen=True)
class Shares:
    """A body's parts, shared out.

    Attributes:
        trunk: what is searched first, in order: the torso and the spine.
        limbs: one share for each limb: the limb, then the hand or foot that it carries.
        rest: what remains for whoever searched the trunk: the head.
    """

    trunk: tuple[Part, ...]
    limbs: tuple[tuple[Part, ...], ...]
    rest: tuple[Part, ...]


def shares_of(body: Body) -> Shares:
    """The shares of ``body``."""
    limbs = [part for part in body.parts if part.role == "limb"]
    ends = [part for part in body.parts if part.role == "end"]
    carried = {limb.name: [end for end in ends if _carries(limb, end)] for limb in limbs}
    held = {end.name for group in carried.values() for end in group}
    return Shares(
        trunk=tuple(part for part in body.parts if part.role not in ("limb", "end")),
        limbs=tuple((limb, *carried[limb.name]) for limb in limbs),
        rest=tuple(end for end in ends if end.name not in held),
    )


def _carries(limb: Part, end: Part) -> bool:
    return set(end.segments) <= set(limb.segments)
