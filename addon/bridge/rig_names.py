"""What the names of a user's bones tell: side, place in a person's body, whether they are held.

Names are compared without namespace, side, case and separators: ``mixamorig:LeftForeArm``,
``forearm.L`` and ``DEF-forearm.L`` are all ``forearm`` on the left. The tables hold the names of
Rigify's metarigs and deform bones, MPFB and MakeHuman (default and game engine), Mixamo, Unreal's
mannequin, Biped, Character Creator, and of our own export.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass

from ...core.body.body import POINT_NAMES

POINT_BONES = {
    "head": ("head", "spine006"),
    "neck": ("neck", "neck01", "spine004"),
    "shoulder": ("upperarm", "upperarm01", "arm", "shoulder"),
    "elbow": ("forearm", "lowerarm", "lowerarm01", "elbow"),
    "wrist": ("hand", "wrist"),
    "hip": ("thigh", "upperleg", "upperleg01", "upleg", "hip"),
    "knee": ("shin", "calf", "lowerleg", "lowerleg01", "leg", "knee"),
    "ankle": ("foot", "ankle"),
}
"""Point -> the bones that begin there; where a rig has several, the first named counts."""

_HELD = frozenset(("twist", "roll"))
_HELD_SEGMENTS = frozenset(("upperarm02", "lowerarm02", "upperleg02", "lowerleg02", "pelvis"))
"""On one side: in line with a limb, or between the trunk and a limb; what hangs on them moves."""
_ENDS = frozenset(
    ("thumb", "finger", "fingers", "pinky", "palm", "metacarpal", "toe", "toes", "heel", "breast",
     "eye", "eyes", "eyelid", "lid", "eyebrow", "brow", "jaw", "chin", "cheek", "lip", "lips",
     "tongue", "teeth", "nose", "ear", "forehead", "temple", "face", "facial",
     "orbicularis", "oculi", "oris", "levator", "risorius", "temporalis", "special")
)  # fmt: skip
"""Fingers, toes and face: they are held with all that hangs on them."""
_SIDED_ENDS = frozenset(("index", "middle", "ring", "little", "ball"))
"""The same, on one side only: elsewhere the words mean other things."""

_NAMESPACE = re.compile(r"^(?:.*:)?(?:DEF-|ORG-|CC_Base_|Bip\d*[ _])?")
_SIDE = re.compile(r"(?:^|[ _.\-])(l|r|left|right)(?=$|[ _.\-])", re.IGNORECASE)
_SIDE_IN_FRONT = re.compile(r"^([Ll]eft|[Rr]ight)(?=[A-Z])")
_NUMBERED = re.compile(r"\.\d{3}$")
_WORD_STARTS = re.compile(r"(?<=[a-z])(?=[A-Z])")


@dataclass(frozen=True)
class BoneName:
    """A bone's name taken apart.

    Attributes:
        base: what is left of it, small letters and digits.
        words: its words, without digits.
        side: ``left``, ``right``, or empty.
        numbered: whether it ends like ``.L.001``, as further segments of a limb do.
    """

    base: str
    words: frozenset[str]
    side: str
    numbered: bool

    @classmethod
    def of(cls, name: str) -> "BoneName":
        """Of a bone called ``name``."""
        bare = _NAMESPACE.sub("", name)
        found = _SIDE.search(bare) or _SIDE_IN_FRONT.match(bare)
        side, numbered = "", False
        if found:
            side = "left" if found[1][0].lower() == "l" else "right"
            bare = f"{bare[: found.start()]} {bare[found.end() :]}"
            numbered = bool(_NUMBERED.search(name))
            bare = _NUMBERED.sub("", bare)
        words = re.findall("[a-z]+", _WORD_STARTS.sub(" ", bare).lower())
        return cls(re.sub("[^a-z0-9]", "", bare.lower()), frozenset(words), side, numbered)

    @property
    def held(self) -> bool:
        """Whether the bone only twists or carries others: it keeps its place on its parent."""
        segment = self.side and (self.base in _HELD_SEGMENTS or (self.numbered and self._of_limb))
        return bool(_HELD & self.words or segment)

    @property
    def ends(self) -> bool:
        """Whether the bone is held with all that hangs on it."""
        return bool(_ENDS & self.words or (self.side and _SIDED_ENDS & self.words))

    @property
    def _of_limb(self) -> bool:
        return any(self.base in bones for bones in POINT_BONES.values())


def point_bones(names: Iterable[str]) -> dict[str, str]:
    """Points of `POINT_NAMES` -> names of bones that begin there, as far as there are such."""
    bones: dict[tuple[str, str], str] = {}
    for name in names:
        known = BoneName.of(name)
        if not known.numbered:
            bones.setdefault((known.base, known.side), name)
    found = {}
    for point in POINT_NAMES:
        side, _, joint = point.rpartition("_")
        taken = [bones[base, side] for base in POINT_BONES[joint] if (base, side) in bones]
        if taken:
            found[point] = taken[0]
    return found
