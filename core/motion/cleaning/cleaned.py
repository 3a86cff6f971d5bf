"""A motion cleaned: smoothed, gaps filled, feet held on the floor, keys thinned out.

Everything starts from the raw poses, so that cleaning again is cleaning once, and undoing it gives
back what the fit wrote, to the bit.
"""

from dataclasses import asdict, dataclass, replace

import numpy as np

from ...body.body import Body
from ...body.kinematics import in_blocks, joint_positions, points
from ...errors import MocapError
from ...progress import Progress
from ..motion import Motion
from .feet import Feet, mean_and_max, with_feet_held
from .key_reduction import Keys, reduced_keys
from .settings import CleanSettings
from .smoothing import smoothed

FILLED_CONFIDENCE = 0.25
"""The most that is said of a pose which no picture has confirmed."""


@dataclass(frozen=True, eq=False)
class Cleaned:
    """What came of a cleaning.

    Attributes:
        raw: the motion before.
        motion: the motion after.
        settings: with the cut-off that was used.
        filled: (T,) bool, frames that were lost and are filled from both sides.
        feet: None where feet were left alone.
        keys: None where every frame is a key.
    """

    raw: Motion
    motion: Motion
    settings: CleanSettings
    filled: np.ndarray
    feet: Feet | None
    keys: Keys | None

    def as_dict(self) -> dict:
        """For report.json: what was asked for, and what it did."""
        moved = np.linalg.norm(self.motion.points - self.raw.points, axis=2)
        return {
            "settings": asdict(self.settings),
            "moved_mm": mean_and_max(1000 * moved),
            "acceleration": {"raw": acceleration(self.raw), "clean": acceleration(self.motion)},
            "filled_frames": self.motion.frames[self.filled].tolist(),
            "feet": None if self.feet is None else self.feet.as_dict(),
            "keys": None if self.keys is None else self.keys.as_dict(),
        }


def cleaned(
    body: Body, motion: Motion, settings: CleanSettings, floor: float, progress: Progress
) -> Cleaned:
    """The ``motion`` of ``body``, cleaned before or not, cleaned as ``settings`` say.

    Args:
        body: the performer.
        motion: the motion.
        settings: what to do.
        floor: its height, m.
        progress: is told how far it is.

    Raises:
        MocapError: all frames are lost, or the cut-off is too high for the motion's rate.
    """
    settings = replace(settings, smooth_hz=settings.cut_off(motion.rate))
    raw, filled, feet, keys = undone(body, motion), motion.lost & ~motion.locked, None, None
    if filled.all():
        raise MocapError("all frames are lost, so nothing can be filled in", "fit the take again")
    confidence = np.where(
        filled[:, None], np.minimum(raw.confidence, FILLED_CONFIDENCE), raw.confidence
    )
    found = replace(raw, pose=smoothed(body, raw, settings, progress), confidence=confidence)
    if settings.contacts:
        found, feet = with_feet_held(body, found, floor, progress)
    if settings.keys_mm is not None:
        keys = reduced_keys(body, found, settings.keys_mm, progress)
        found = replace(found, keyed=keys.keyed)
    return Cleaned(raw, _placed(body, found), settings, filled, feet, keys)


def undone(body: Body, motion: Motion) -> Motion:
    """The ``motion`` of ``body`` as it was before any cleaning."""
    return _placed(
        body,
        replace(
            motion,
            pose=motion.pose_raw.copy(),
            confidence=motion.confidence_raw.copy(),
            keyed=np.ones_like(motion.keyed),
        ),
    )


def acceleration(motion: Motion) -> float:
    """Root mean square acceleration of the points, m/s²; NaN for fewer than three frames."""
    second = np.diff(motion.points, 2, axis=0) * float(motion.rate) ** 2
    return float(np.sqrt((second**2).sum(axis=2).mean())) if len(second) else float("nan")


def _placed(body: Body, motion: Motion) -> Motion:
    """The motion with joints and points where ``body`` has them in its poses."""
    return replace(
        motion,
        joints=in_blocks(joint_positions, body, motion.pose),
        points=in_blocks(points, body, motion.pose),
    )
