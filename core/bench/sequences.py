"""Two motions with known truth, in the spirit of the sequences of Theobalt et al. 2003, table 2.

Sequence A shows basic motions at slow speed, sequence B a dancer's at high speed. Theirs are not
published; ours are made of sines, begin in the rest pose, and fill the grids that belong to them:
no limb's DOF moves by more than 12 degrees a frame in A and 35 degrees in B.
"""

from dataclasses import dataclass

import numpy as np

from ..body.body import Body

FPS = 15.0
_EASE_SECONDS = 1.0


@dataclass(frozen=True)
class Wave:
    """What one DOF does: ``centre + amplitude * sin(2 pi (frequency t + phase))``.

    Attributes:
        amplitude: degrees, or m for translations.
        frequency: Hz.
        phase: turns.
        centre: as ``amplitude``.
    """

    amplitude: float
    frequency: float
    phase: float = 0.0
    centre: float = 0.0


def _both(name: str, wave: Wave, other_phase: float) -> dict[str, Wave]:
    """The wave on the left, and on the right at another phase."""
    right = Wave(wave.amplitude, wave.frequency, wave.phase + other_phase, wave.centre)
    return {f"left_{name}": wave, f"right_{name}": right}


SLOW = {
    "root_x": Wave(0.15, 0.2),
    "root_y": Wave(0.2, 0.15),
    "root_z": Wave(0.02, 0.6, 0.25, -0.03),
    "root_yaw": Wave(30, 0.15),
    "root_pitch": Wave(6, 0.3),
    "neck_flexion": Wave(12, 0.3),
    "neck_twist": Wave(25, 0.25),
    **_both("shoulder_flexion", Wave(25, 0.5, 0.0, 15), 0.5),
    **_both("shoulder_abduction", Wave(20, 0.3, 0.2, 12), 0.15),
    **_both("shoulder_twist", Wave(12, 0.3, 0.6), 0.4),
    **_both("elbow_flexion", Wave(32, 0.45, 0.8, 40), 0.5),
    **_both("wrist_flexion", Wave(15, 0.4), 0.5),
    **_both("hip_flexion", Wave(22, 0.5, 0.5, 14), 0.5),
    **_both("hip_abduction", Wave(5, 0.25, 0.0, 4), 0.5),
    **_both("knee_flexion", Wave(24, 0.5, 0.3, 28), 0.5),
    **_both("ankle_flexion", Wave(10, 0.5), 0.5),
}
FAST = {
    "root_x": Wave(0.3, 0.5),
    "root_y": Wave(0.3, 0.4, 0.2),
    "root_z": Wave(0.07, 0.9, 0.0, 0.03),
    "root_yaw": Wave(60, 0.3),
    "root_roll": Wave(8, 0.6),
    "root_pitch": Wave(10, 0.5),
    "neck_flexion": Wave(15, 0.8),
    "neck_twist": Wave(35, 0.7),
    **_both("shoulder_flexion", Wave(45, 0.9, 0.0, 20), 0.5),
    **_both("shoulder_abduction", Wave(40, 0.8, 0.2, 40), 0.2),
    **_both("shoulder_twist", Wave(25, 0.7, 0.6), 0.4),
    **_both("elbow_flexion", Wave(45, 1.0, 0.8, 55), 0.5),
    **_both("wrist_flexion", Wave(25, 0.9), 0.5),
    **_both("hip_flexion", Wave(38, 0.8, 0.5, 25), 0.5),
    **_both("hip_abduction", Wave(10, 0.6, 0.0, 12), 0.5),
    **_both("hip_twist", Wave(12, 0.6, 0.3), 0.5),
    **_both("knee_flexion", Wave(40, 0.9, 0.3, 45), 0.5),
    **_both("ankle_flexion", Wave(15, 0.8), 0.5),
}
SEQUENCES = {"A": SLOW, "B": FAST}


def sequence(body: Body, name: str, frames: int) -> np.ndarray:
    """(frames, D) poses of sequence A or B at `FPS`; the first is the rest pose."""
    times = np.arange(frames) / FPS
    eased = np.clip(times / _EASE_SECONDS, 0, 1) ** 2
    poses = np.repeat(body.rest_pose[None], frames, axis=0)
    for dof, wave in SEQUENCES[name].items():
        values = wave.amplitude * np.sin(2 * np.pi * (wave.frequency * times + wave.phase))
        values = eased * (values + wave.centre)
        metres = dof in ("root_x", "root_y", "root_z")
        poses[:, body.dofs.names.index(dof)] = values if metres else np.radians(values)
    return poses
