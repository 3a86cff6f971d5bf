"""The performer's proportions: bone lengths, joint widths and cross-sections.

The defaults describe an adult of 1.75 m midway between man and woman. Lengths between joint centres
follow de Leva 1996 (J. Biomech. 29, means of both sexes), heights of knee and hip Drillis and
Contini 1966 (as in Winter, Biomechanics and Motor Control of Human Movement, fig. 4.1), the
distance of the hip centres Seidel et al. 1995. The cross-sections are drawn by hand around
breadths, depths and circumferences of such an adult (NASA-STD-3000 vol. I, section 3; ANSUR II
medians).
"""

from dataclasses import dataclass, field, fields, replace

from ...geometry.loft import Profile
from .profiles import default_profiles

STATURE = 1.75


@dataclass(frozen=True, eq=False)
class Proportions:
    """All lengths and girths of a template, in metres.

    Attributes:
        ankle_height: ankle centre above the floor.
        shank: knee to ankle.
        thigh: hip to knee.
        hip_half_width: hip centre from the median plane.
        lower_spine: root (between the hips) to waist.
        middle_spine: waist to chest joint.
        upper_spine: chest joint to neck, its base.
        neck: base of the neck to the head joint (skull on spine).
        skull: head joint to the centre of the skull.
        crown: centre of the skull to the top of the head.
        sternum_half_width: clavicle joint from the median plane.
        sternum_drop: clavicle joint below the base of the neck.
        sternum_depth: clavicle joint in front of the base of the neck.
        shoulder_half_width: shoulder centre from the median plane.
        shoulder_drop: shoulder centre below the base of the neck.
        shoulder_depth: shoulder centre in front of the base of the neck.
        upper_arm: shoulder to elbow.
        forearm: elbow to wrist.
        hand: wrist to tip of the middle finger.
        thumb: its free length.
        heel: heel behind the ankle.
        instep: ankle to the ball of the foot, along the floor.
        toes: ball of the foot to tip of the toes.
        profiles: name of a surface piece -> its cross-sections.
    """

    ankle_height: float = 0.043 * STATURE
    shank: float = 0.2475 * STATURE
    thigh: float = 0.2425 * STATURE
    hip_half_width: float = 0.0515 * STATURE
    lower_spine: float = 0.067 * STATURE
    middle_spine: float = 0.095 * STATURE
    upper_spine: float = 0.165 * STATURE
    neck: float = 0.064 * STATURE
    skull: float = 0.030 * STATURE
    crown: float = 0.0503 * STATURE
    sternum_half_width: float = 0.014 * STATURE
    sternum_drop: float = 0.038 * STATURE
    sternum_depth: float = 0.034 * STATURE
    shoulder_half_width: float = 0.100 * STATURE
    shoulder_drop: float = 0.0515 * STATURE
    shoulder_depth: float = 0.010 * STATURE
    upper_arm: float = 0.162 * STATURE
    forearm: float = 0.150 * STATURE
    hand: float = 0.106 * STATURE
    thumb: float = 0.036 * STATURE
    heel: float = 0.038 * STATURE
    instep: float = 0.072 * STATURE
    toes: float = 0.040 * STATURE
    profiles: dict[str, Profile] = field(default_factory=default_profiles)

    def __post_init__(self):
        for name in self.length_names():
            if not getattr(self, name) > 0:
                raise ValueError(f"expected {name} above 0 m, got {getattr(self, name)}")

    @classmethod
    def length_names(cls) -> tuple[str, ...]:
        """The names of all lengths and widths, without the profiles."""
        return tuple(f.name for f in fields(cls) if f.name != "profiles")

    def scaled(self, factor: float) -> "Proportions":
        """Every length and girth times ``factor``."""
        lengths = {name: getattr(self, name) * factor for name in self.length_names()}
        profiles = {name: p.scaled(factor, factor) for name, p in self.profiles.items()}
        return Proportions(**lengths, profiles=profiles)

    def with_girth(self, name: str, width: float = 1.0, depth: float = 1.0) -> "Proportions":
        """The profile ``name`` made ``width`` times as wide and ``depth`` times as deep.

        Raises:
            KeyError: no such profile.
        """
        return replace(
            self, profiles={**self.profiles, name: self.profiles[name].scaled(width, depth)}
        )
