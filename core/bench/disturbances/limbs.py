"""What happens where a limb is: it is missing, it carries something, it throws a shadow."""

from dataclasses import dataclass

import numpy as np

from .sights import PictureDisturbance, Sight, ball, rods

SIDES, KINDS = ("left", "right"), ("arm", "leg")
_RADII_M = {"arm": 0.09, "leg": 0.12}
_SHADOW_RADIUS_M = 0.06
_LIGHT = np.array([0.6, 0.35, -1.0])
"""Where it shines: from above at some 55° over the floor."""
_SHANKS = (("left_ankle", "left_knee"), ("right_ankle", "right_knee"))
_THIGHS = (("left_knee", "left_hip"), ("right_knee", "right_hip"))
_UPPER = (
    ("left_hip", "right_hip", "neck", "left_hip"),
    ("left_shoulder", "right_shoulder"),
    ("neck", "head"),
    ("left_shoulder", "left_elbow", "left_wrist"),
    ("right_shoulder", "right_elbow", "right_wrist"),
)
SHADOWS = {"shanks": _SHANKS, "legs": _SHANKS + _THIGHS, "body": _SHANKS + _THIGHS + _UPPER}


@dataclass(frozen=True)
class LimbBitten(PictureDisturbance):
    """One limb is missing from the middle of its upper half on, with whatever lies behind it.

    Attributes:
        side: "left" or "right".
        kind: "arm" or "leg".
    """

    side: str
    kind: str = "arm"

    def __post_init__(self):
        if self.side not in SIDES or self.kind not in KINDS:
            raise ValueError(f"expected a limb of {SIDES} and {KINDS}, got {self}")

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the silhouette without the limb."""
        return _without(sight, self.side, self.kind)


@dataclass(frozen=True)
class LimbDropout(PictureDisturbance):
    """Now and then a camera loses one limb or another for five frames.

    Attributes:
        chance: that it does, for each five frames and camera.
    """

    chance: float
    run = 5

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the silhouette, perhaps without a limb."""
        side, kind = SIDES[rng.integers(2)], KINDS[rng.integers(2)]
        if rng.random() >= self.chance:
            return sight.silhouette.foreground
        return _without(sight, side, kind)


@dataclass(frozen=True)
class BlobOnHand(PictureDisturbance):
    """A ball about one wrist belongs to the silhouette, too.

    Attributes:
        side: "left" or "right".
        radius_m: of the ball.
    """

    side: str
    radius_m: float = 0.15

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the silhouette with the blob."""
        held = ball(sight, sight.point(f"{self.side}_wrist"), self.radius_m)
        return sight.silhouette.foreground | held


@dataclass(frozen=True)
class FloorShadow(PictureDisturbance):
    """The shadow on the floor is taken for the performer.

    Attributes:
        of: whose shadow, one of `SHADOWS`.
    """

    of: str

    def __post_init__(self):
        if self.of not in SHADOWS:
            raise ValueError(f"expected one of {tuple(SHADOWS)}, got {self.of}")

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the silhouette with the shadow."""
        chains = [np.stack([sight.point(name) for name in names]) for names in SHADOWS[self.of]]
        fallen = [
            chain - (chain[:, 2:] - sight.floor) / _LIGHT[2] * _LIGHT[None] for chain in chains
        ]
        return sight.silhouette.foreground | rods(sight, fallen, _SHADOW_RADIUS_M)


def _without(sight: Sight, side: str, kind: str) -> np.ndarray:
    lost = rods(sight, [sight.limb(side, kind)], _RADII_M[kind])
    return sight.silhouette.foreground & ~lost
