"""Whether joints can be those of the pose that the performer was asked for."""

from collections.abc import Iterator

import numpy as np

from .one_frame import FrameJoints
from .skeleton import JOINT_NAMES

_LARGEST_GAP, _LEAST_DEPTH = 0.08, 0.01
_TRUNK, _LEG = (0.22, 0.45), (0.33, 0.62)
_MOST_LEAN_DEG = 30.0
_UPPER_ARM_DEG = {"A": (20.0, 72.0), "T": (65.0, 120.0), "elbows": (40.0, 120.0)}
_MOST_FOREARM_DEG = 50.0
"""From hanging, of a forearm below a lifted elbow."""
_LEAST_SAME = 0.6


def fault_of(frame: FrameJoints, kind: str, height: float) -> str:
    """What is wrong with a frame's joints, in words; empty where nothing is."""
    return next(_faults(frame, kind, height), "")


def _faults(frame: FrameJoints, kind: str, height: float) -> Iterator[str]:
    joints: dict[str, np.ndarray] = dict(zip(JOINT_NAMES, frame.points, strict=True))
    for name, joint in zip(JOINT_NAMES, frame.joints, strict=True):
        if joint.depth < _LEAST_DEPTH:
            yield (
                "the views that show the pose face each other or stand too close together "
                "to tell its depth"
            )
        if joint.gap > _LARGEST_GAP * height:
            yield f"the views disagree about the {_words(name)} by {1000 * joint.gap:.0f} mm"
    trunk, leg = joints["neck"] - joints["back"], joints["back"] - joints["virtual_foot"]
    for name, limb, allowed in (("trunk", trunk, _TRUNK), ("legs", leg, _LEG)):
        length = float(np.linalg.norm(limb)) / height
        if not allowed[0] <= length <= allowed[1]:
            yield f"the {name} would be {length:.2f} of the height long"
        if _from_vertical(limb) > _MOST_LEAN_DEG:
            yield f"the performer is bent over: the {name} lean by {_from_vertical(limb):.0f}°"
    yield from _arm_faults(joints, kind)


def _arm_faults(joints: dict[str, np.ndarray], kind: str) -> Iterator[str]:
    low, high = _UPPER_ARM_DEG[kind]
    lengths = []
    for side in ("left", "right"):
        shoulder, elbow, wrist = (joints[f"{side}_{j}"] for j in ("shoulder", "elbow", "wrist"))
        upper, fore = _from_vertical(shoulder - elbow), _from_vertical(elbow - wrist)
        lengths.append(float(np.linalg.norm(wrist - elbow) + np.linalg.norm(elbow - shoulder)))
        if not low <= upper <= high:
            yield f"the {side} upper arm is {upper:.0f}° from hanging, not {low:.0f} to {high:.0f}°"
        if kind == "elbows" and fore > _MOST_FOREARM_DEG:
            yield f"the {side} forearm is {fore:.0f}° from hanging down"
    if min(lengths) < _LEAST_SAME * max(lengths):
        shorter, longer = (1000 * length for length in sorted(lengths))
        yield f"one arm would be {shorter:.0f} mm long, the other {longer:.0f} mm"


def _from_vertical(up: np.ndarray) -> float:
    """Degrees between a vector and straight up."""
    return float(np.degrees(np.arccos(np.clip(up[2] / np.linalg.norm(up), -1.0, 1.0))))


def _words(name: str) -> str:
    return name.replace("_", " ")
