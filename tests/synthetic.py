"""Takes with known truth: a body of ours, filmed by a ring of pinhole cameras."""

from functools import cache

import numpy as np
from silhouette_mocap.core.body.body import POINT_NAMES, Body
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.body.scaling import scaled
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.cameras.camera import Camera
from silhouette_mocap.core.cameras.presets import Ring, ring
from silhouette_mocap.core.rendering.native import NativeEvaluator
from silhouette_mocap.core.silhouettes.silhouette import Silhouette


@cache
def small_body(name: str, scale: float = 1.0) -> Body:
    """A template; the same object for the same arguments."""
    return scaled(template(name), scale)


@cache
def small_studio(count: int = 6) -> tuple[Camera, ...]:
    """Cameras of 160 x 120 px, about 33 mm per px at the performer."""
    return ring(
        Ring(count, heights=(0.9, 1.9), first_angle_deg=10.0, size=(160, 120), focal_px=125.0)
    )


def evaluator(body: Body, cameras: tuple[Camera, ...]) -> NativeEvaluator:
    """What the trackers are given in tests."""
    return NativeEvaluator(body, cameras)


def filmed(body: Body, cameras: tuple[Camera, ...], pose: np.ndarray) -> tuple[Silhouette, ...]:
    """Perfect silhouettes of the body in ``pose`` (D,)."""
    pictures = NativeEvaluator(body, cameras).silhouettes(pose)
    return tuple(Silhouette(picture, np.ones(picture.shape, bool)) for picture in pictures)


def dof_values(body: Body, **values: float) -> np.ndarray:
    """(D,) the rest pose but for the named DOFs."""
    pose = body.rest_pose.copy()
    for name, value in values.items():
        pose[body.dofs.names.index(name)] = value
    return pose


def point_errors(body: Body, pose: np.ndarray, truth: np.ndarray) -> dict[str, float]:
    """Distance in metres between the 14 points of two poses, by name."""
    both = points(body, np.stack([pose, truth]))
    return dict(zip(POINT_NAMES, np.linalg.norm(both[0] - both[1], axis=1), strict=True))
