"""Motions of a body of ours with known truth, for cleaning them."""

import numpy as np
from motion_made_up import motion_of
from silhouette_mocap.core.body.body import Body
from silhouette_mocap.core.body.kinematics import joint_positions, points
from silhouette_mocap.core.motion.motion import Motion


def motion_with(body: Body, poses: np.ndarray, **changes) -> Motion:
    """The motion of ``body`` in raw poses (T, D), without any fault, at 30 frames per second."""
    count = len(poses)
    values = {
        "fps": (30, 1),
        "pose": poses,
        "pose_raw": poses,
        "dof_names": body.dofs.names,
        "joints": joint_positions(body, poses),
        "joint_names": body.joint_names,
        "points": points(body, poses),
        "keyed": np.ones((count, len(body.joint_names)), bool),
    }
    return motion_of(np.ones((count, 2)), **{**values, **changes})


def swaying(body: Body, seconds: float, rate: float, hz: float = 0.7) -> np.ndarray:
    """(T, D) poses that sway smoothly about a pose well within the limits, turning on the spot."""
    time = np.arange(round(seconds * rate))[:, None] / rate
    rng = np.random.default_rng(4)
    low, high = body.dofs.limits.clip(-1.0, 1.0).T
    middle, reach = (low + high) / 2, (high - low) / 8
    phases = rng.uniform(0, 2 * np.pi, len(body.dofs))
    poses = middle + reach * np.sin(2 * np.pi * hz * time + phases)
    poses[:, body.dofs.names.index("root_yaw")] = 3.0 * time[:, 0]
    return poses


def stepping(body: Body, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """(T, D) poses of 3 s in which the left foot is lifted once, and (T,) whether it stands.

    Both knees are bent a little, so that legs can give way.
    """
    time = np.arange(round(3 * rate)) / rate
    lift = np.clip((time - 1.0) / 0.8, 0, 1)
    lift = 0.5 - 0.5 * np.cos(2 * np.pi * lift)
    poses = np.zeros((len(time), len(body.dofs)))
    index = body.dofs.names.index
    for side, raised in (("left", lift), ("right", 0 * lift)):
        poses[:, index(f"{side}_hip_flexion")] = 0.3 + 0.7 * raised
        poses[:, index(f"{side}_knee_flexion")] = 0.6 + 0.9 * raised
        poses[:, index(f"{side}_ankle_flexion")] = 0.3 - 0.2 * raised
    soles = (time < 1.0) | (time > 1.8)
    return poses, soles


def rms(values: np.ndarray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))
