"""From the rules' points to the joints' centres: fixed shifts, in heights of the performer.

The rules name points of the outline's cuts. The crotch lies below the hip centres, the middle of a
shoulder's cut nearer to the neck than the joint, the middle of an elbow's cut below and inside it.
The shifts are those of the template `performer`, filmed without noise; but for the back's: it is
0.07 for the template, and 0.065 to 0.085 for other bodies, up to 0.115 for clothed thighs in coarse
pictures, where a narrow gap between the legs does not show.

Hair over a neck moves the upper end of the shoulders' cuts outwards, and their middles by half of
that, which the shoulders' shift then need not do.
"""

from dataclasses import dataclass

import numpy as np

HIP_HALF_WIDTH = 0.0515
"""Hip centres from the median plane (Seidel et al. 1995)."""
_BARE_NECK = 0.037
"""Half of the cut through a neck without hair."""


@dataclass(frozen=True)
class Shift:
    """How far a joint's centre lies from its rule's point.

    Attributes:
        out: away from the median plane, heights.
        up: heights.
    """

    out: float
    up: float


SHIFTS = {
    "back": Shift(0.0, 0.078),
    "neck": Shift(0.0, -0.007),
    "shoulders": Shift(0.027, -0.008),
    "elbows": Shift(0.007, 0.008),
    "wrists": Shift(0.0, 0.0),
    "ankles": Shift(0.0, -0.005),
}
"""By joint; that of the elbows is for bent ones, whose crease and bulge were seen."""


def shift(name: str, outwards: np.ndarray, height: float, neck_half_width: float) -> np.ndarray:
    """(3,) metres from a rule's point to the joint's centre.

    Args:
        name: of the joint, one of `SHIFTS`.
        outwards: (3,) horizontal unit vector; zeros for a joint of the median plane.
        height: the performer's, metres.
        neck_half_width: half of the cut through the neck, in heights.
    """
    fixed = SHIFTS[name]
    out = fixed.out
    if name == "shoulders":
        out = max(0.0, out - max(0.0, neck_half_width - _BARE_NECK) / 2)
    return height * (out * outwards + np.array([0.0, 0.0, fixed.up]))
