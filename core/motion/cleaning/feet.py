"""The feet of a motion: when they touch the floor, and how they are held there."""

from dataclasses import asdict, dataclass, replace

import numpy as np

from ...body.body import Body
from ...body.kinematics import in_blocks, joint_transforms
from ...progress import Progress
from ..motion import Motion
from .contacts import FEET, Contact, contacts, slides, touching
from .foot_lock import Floor, FootLock
from .soles import Soles


@dataclass(frozen=True, eq=False)
class Feet:
    """What is known of a motion's feet.

    Attributes:
        floor: its height, m.
        contacts: in order of their beginning.
        touched: (T, P) bool, which points of the soles touch the floor.
        before: (T, P, 3) where these points were before they were held, world metres.
        after: (T, P, 3) where they are.
        sides: (P,) the foot of each point, an index of `FEET`.
    """

    floor: float
    contacts: list[Contact]
    touched: np.ndarray
    before: np.ndarray
    after: np.ndarray
    sides: np.ndarray

    def heights(self, foot: str, held: bool) -> np.ndarray:
        """(T,) metres from the floor to the lowest point of one of `FEET`, held or before."""
        places = self.after if held else self.before
        return places[:, self.sides == FEET.index(foot), 2].min(axis=1) - self.floor

    def standing(self, foot: str) -> np.ndarray:
        """(T,) bool, whether one of `FEET` touches the floor."""
        return self.touched[:, self.sides == FEET.index(foot)].any(axis=1)

    def as_dict(self) -> dict:
        """For report.json: contacts, how far feet slid in them, and how high they stand, mm."""
        heights = 1000 * (self.after[..., 2][self.touched] - self.floor)
        return {
            "floor": self.floor,
            "contacts": [asdict(contact) for contact in self.contacts],
            "slide_mm": {
                "before": mean_and_max(1000 * slides(self.before, self.touched)),
                "after": mean_and_max(1000 * slides(self.after, self.touched)),
            },
            "above_floor_mm": float(np.median(heights)) if len(heights) else None,
        }


def with_feet_held(
    body: Body, motion: Motion, floor: float, progress: Progress
) -> tuple[Motion, Feet]:
    """The ``motion`` of ``body`` with its poses changed so that no foot slides where it stands.

    Joints and points are left as they are.

    Args:
        body: the performer.
        motion: smoothed.
        floor: its height, m.
        progress: is told how far it is.
    """
    soles = Soles.of(body)
    rate, before = float(motion.rate), _places(body, soles, motion.pose)
    touched = touching(before, floor, rate)
    lock = FootLock(body, soles, motion.pose, rate, motion.locked)
    poses = lock.solved(Floor(floor, touched), progress)
    found = contacts(touched, soles.feet, motion.frames)
    after = _places(body, soles, poses)
    return replace(motion, pose=poses), Feet(floor, found, touched, before, after, soles.feet)


def _places(body: Body, soles: Soles, poses: np.ndarray) -> np.ndarray:
    """(T, P, 3) of the soles' points in poses (T, D), world metres."""

    def in_block(body: Body, block: np.ndarray) -> np.ndarray:
        return soles.places(joint_transforms(body, block))

    return in_blocks(in_block, body, poses)


def mean_and_max(values: np.ndarray) -> dict[str, float | None]:
    """Of values of any shape; None where there are none."""
    if not values.size:
        return {"mean": None, "max": None}
    return {"mean": float(values.mean()), "max": float(values.max())}
