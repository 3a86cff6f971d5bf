"""The result: nine joints in every frame of the pose, and the measures of the performer."""

from dataclasses import dataclass

import numpy as np

from ...geometry.arrays import frozen_array

JOINT_NAMES = (
    "back", "neck", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow",
    "left_wrist", "right_wrist", "virtual_foot",
)  # fmt: skip
"""The joints of the seed's model; the virtual foot is the midpoint of the feet."""
MEASURES = {
    "forearm": (("left_elbow", "left_wrist"), ("right_elbow", "right_wrist")),
    "arm": (("left_shoulder", "left_elbow"), ("right_shoulder", "right_elbow")),
    "trunk": (("back", "neck"),),
    "upper_back": (("back", "left_shoulder"), ("back", "right_shoulder")),
    "virtual_leg": (("back", "virtual_foot"),),
}
"""The seed's five measures: distances between joints, the mean of left and right."""
SKIN, HAND_TIP = "skin ellipse", "share of the arm to the fingertips"
"""Where wrists come from."""


@dataclass(frozen=True)
class Measure:
    """One length of the performer.

    Attributes:
        mean: over the frames that show the pose, metres.
        spread: standard deviation over them, metres; 0 for a single frame.
    """

    mean: float
    spread: float


@dataclass(frozen=True, eq=False)
class ContourSkeleton:
    """The skeleton that the contours of F frames show.

    Attributes:
        joint_names: `JOINT_NAMES`.
        joints: (F, 9, 3) world metres; NaN in frames that do not show the pose.
        gaps_mm: (F, 9) how far the views' rays pass each other; NaN likewise.
        hips: (F, 2, 3) hip centres, left and right; NaN likewise.
        ankles: (F, 2, 3) likewise.
        left: (F, 3) unit directions to the performer's left; NaN likewise.
        views: (F, V) bool, which views the joints come from.
        elbow_observed: whether elbows were seen; else they are shares of straight arms.
        wrist_source: (2,) left and right: `SKIN` or `HAND_TIP`, in most frames.
        measures: by the names of `MEASURES`.
        faults: F sentences on why a frame does not show the pose; empty where it does.
        notes: sentences that a user should see.
    """

    joint_names: tuple[str, ...]
    joints: np.ndarray
    gaps_mm: np.ndarray
    hips: np.ndarray
    ankles: np.ndarray
    left: np.ndarray
    views: np.ndarray
    elbow_observed: bool
    wrist_source: tuple[str, str]
    measures: dict[str, Measure]
    faults: tuple[str, ...]
    notes: tuple[str, ...]

    def __post_init__(self):
        count = len(self.faults)
        shapes = {
            "joints": (count, 9, 3), "gaps_mm": (count, 9), "hips": (count, 2, 3),
            "ankles": (count, 2, 3), "left": (count, 3),
        }  # fmt: skip
        for name, shape in shapes.items():
            values = np.array(getattr(self, name), float)
            if values.shape != shape:
                raise ValueError(f"expected {name} of shape {shape}, got {values.shape}")
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        views = frozen_array(self.views, (count, None), "views", bool)
        object.__setattr__(self, "views", views)

    @property
    def shown(self) -> np.ndarray:
        """(F,) bool, the frames that show the pose."""
        return np.array([not fault for fault in self.faults])


def measured(joints: np.ndarray) -> dict[str, Measure]:
    """The five measures of joints (F, 9, 3) in the frames that show the pose, one at least."""
    found = {}
    for name, pairs in MEASURES.items():
        ends = np.array([[JOINT_NAMES.index(end) for end in pair] for pair in pairs])
        lengths = np.linalg.norm(joints[:, ends[:, 0]] - joints[:, ends[:, 1]], axis=2)
        by_frame = lengths.mean(axis=1)
        by_frame = by_frame[np.isfinite(by_frame)]
        found[name] = Measure(float(by_frame.mean()), float(by_frame.std()))
    return found
