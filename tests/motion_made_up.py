"""Motions for tests that look at scores only."""

import numpy as np
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.motion.motion import Motion


def motion_of(iou, **changes) -> Motion:
    """A motion with the IoU (T, V), else without any fault."""
    iou = np.array(iou, float)
    frames, views = iou.shape
    values = {
        "fps": (25, 1),
        "frames": np.arange(frames),
        "pose": np.zeros((frames, 6)),
        "pose_raw": np.zeros((frames, 6)),
        "dof_names": tuple("abcdef"),
        "joints": np.zeros((frames, 1, 3)),
        "joint_names": ("root",),
        "points": np.zeros((frames, 14, 3)),
        "point_names": POINT_NAMES,
        "xor_px": np.nan_to_num(np.round(1000 * (1 - iou))).astype(int),
        "iou": iou,
        "view_weights": np.ones((frames, views)),
        "limb_residual": np.ones((frames, 5)),
        "camera_names": tuple(f"cam_{k + 1}" for k in range(views)),
        "confidence": np.ones((frames, 14)),
        "lost": np.zeros(frames, bool),
        "locked": np.zeros(frames, bool),
        "confidence_raw": np.ones((frames, 14)),
        "keyed": np.ones((frames, 1), bool),
    }
    return Motion(**{**values, **changes})


def report_of(motion: Motion, **changes) -> dict:
    """What report.json would say."""
    names = motion.camera_names
    values = {
        "take": "stage",
        "settings": {
            "take": "/shoot/take.toml",
            "frames": [int(motion.frames[0]), int(motion.frames[-1])],
            "fast_motion": False,
            "without": [],
        },
        "evaluators": {"opengl": 3, "native": len(motion.frames) - 3},
        "versions": {"numpy": "2.0"},
        "cameras": {
            name: {
                "footage_size": [1920, 1080],
                "working_size": [960, 540],
                "reduced_by": 2,
                "mm_per_px": 3.25,
            }
            for name in names
        },
        "camera_findings": [],
        "iou_per_camera": dict.fromkeys(names, 0.8125),
        "contour_px": 1.5,
        "seconds_per_frame": [0.5] * len(motion.frames),
        "error_mm": None,
        "notes": ["The performer is 1.80 m tall."],
    }
    return {**values, **changes}
