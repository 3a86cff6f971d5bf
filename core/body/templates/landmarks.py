"""Where the joints and the axes of the surface pieces are in the rest pose.

Spine bones lean a little, as the body's outline does in a standing adult; limbs are straight.
Points of the left side stand for both.
"""

import numpy as np

from .proportions import Proportions

LEG_SPREAD = np.radians(4.0)
"""Abduction of the legs in the rest pose."""
TOE_OUT = np.radians(6.0)
"""Outward turn of the feet in the rest pose."""
ARM_SPREAD = np.radians(45.0)
"""Angle between hanging and the arms of the rest pose."""

UP = np.array([0.0, 0.0, 1.0])
FORWARD = np.array([0.0, -1.0, 0.0])
LEFT = np.array([1.0, 0.0, 0.0])
FLAT = np.array([1.0, 1.0, 0.0])

ARM = np.array([np.sin(ARM_SPREAD), 0.0, -np.cos(ARM_SPREAD)])
LEG = np.array([np.sin(LEG_SPREAD), 0.0, -np.cos(LEG_SPREAD)])
FOOT = np.array([np.sin(TOE_OUT), -np.cos(TOE_OUT), 0.0])
PALM = np.cross(ARM, FORWARD)
"""The way the left palm looks: inwards and down."""
THUMB = (ARM + 0.55 * FORWARD + 0.15 * PALM) / np.linalg.norm(ARM + 0.55 * FORWARD + 0.15 * PALM)
CHIN = np.array([0.0, -0.38, -0.925])

BALL_HEIGHT = 0.3
"""Height of the toe joint as a share of the ankle's."""


def _leaning(back: float) -> np.ndarray:
    """Unit vector upwards that gains ``back`` m towards the back per metre of height."""
    return np.array([0.0, back, 1.0]) / np.hypot(back, 1.0)


def landmarks(p: Proportions) -> dict[str, np.ndarray]:
    """Name -> (3,) world metres in the rest pose."""
    leg = (p.thigh + p.shank) * LEG
    root = (p.ankle_height - leg[2]) * UP
    waist = root + p.lower_spine * _leaning(0.10)
    chest = waist + p.middle_spine * _leaning(0.06)
    neck = chest + p.upper_spine * _leaning(-0.06)
    head = neck + p.neck * _leaning(-0.20)
    skull = head + p.skull * _leaning(-0.30)
    return {
        "root": root,
        "back": root,
        "virtual_foot": np.zeros(3),
        "waist": waist,
        "chest": chest,
        "neck": neck,
        "head": head,
        "skull": skull,
        "head_end": skull + p.crown * UP,
        "chin": skull + 1.40 * p.crown * CHIN,
        **_leg(p, root),
        **_arm(p, neck),
    }


def _leg(p: Proportions, root: np.ndarray) -> dict[str, np.ndarray]:
    hip = root + p.hip_half_width * LEFT
    knee = hip + p.thigh * LEG
    ankle = knee + p.shank * LEG
    under = ankle * FLAT
    ball = under + p.instep * FOOT
    toe_tip = ball + p.toes * FOOT
    lift = BALL_HEIGHT * p.ankle_height * UP
    return {
        "left_hip": hip,
        "left_knee": knee,
        "left_ankle": ankle,
        "left_toes": ball + lift,
        "left_toe_tip": toe_tip + lift,
        "left_heel_sole": under - p.heel * FOOT,
        "left_ball_sole": ball,
        "left_toe_sole": toe_tip,
    }


def _arm(p: Proportions, neck: np.ndarray) -> dict[str, np.ndarray]:
    clavicle = np.array([p.sternum_half_width, -p.sternum_depth, -p.sternum_drop])
    shoulder = np.array([p.shoulder_half_width, -p.shoulder_depth, -p.shoulder_drop])
    elbow = neck + shoulder + p.upper_arm * ARM
    wrist = elbow + p.forearm * ARM
    thumb = wrist + p.hand * (0.28 * ARM + 0.15 * FORWARD + 0.03 * PALM)
    return {
        "left_clavicle": neck + clavicle,
        "left_clavicle_root": neck + np.array([clavicle[0], shoulder[1], clavicle[2]]),
        "left_shoulder": neck + shoulder,
        "left_elbow": elbow,
        "left_wrist": wrist,
        "left_fingertip": wrist + p.hand * ARM,
        "left_thumb": thumb,
        "left_thumb_tip": thumb + p.thumb * THUMB,
    }
