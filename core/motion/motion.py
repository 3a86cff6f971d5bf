"""The result of tracking: poses, points and scores of every frame, as stored in motion.npz."""

from dataclasses import dataclass, fields
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import MocapError
from ..fitting.limbs import LIMB_NAMES, POINT_LIMBS
from ..geometry.archive import read_archive, write_archive

VERSION = 1


@dataclass(frozen=True, eq=False)
class Motion:
    """A tracked take (SPEC §9, motion.npz).

    Shapes: T frames, D DOFs, J joints, P points, L limbs, V views.

    Attributes:
        fps: frames per second as (numerator, denominator).
        frames: (T,) int frame numbers of the footage.
        pose: (T, D) the poses to use.
        pose_raw: (T, D) the poses as tracked, before any cleaning.
        dof_names: D names.
        joints: (T, J, 3) world metres.
        joint_names: J names.
        points: (T, P, 3) world metres.
        point_names: P names; for people `body.body.POINT_NAMES`.
        xor_px: (T, V) px that differ between observed and rendered silhouette.
        iou: (T, V) intersection over union of the two; NaN where nothing was observed.
        view_weights: (T, V) how far each view was trusted, 0 to 1.
        limb_residual: (T, L) mean contour distance in px of each of ``limb_names``.
        camera_names: V names.
        confidence: (T, P) probability that a point is off by less than 50 mm.
        lost: (T,) bool, the pose is not to be trusted.
        locked: (T,) bool, the pose was given by the user.
        confidence_raw: (T, P) the confidence in ``pose_raw``.
        keyed: (T, J) bool, the frames from which a joint's motion follows in between.
        limb_names: L names, the torso's first.
        point_limbs: (P,) index of the limb that moves each point.
    """

    fps: tuple[int, int]
    frames: np.ndarray
    pose: np.ndarray
    pose_raw: np.ndarray
    dof_names: tuple[str, ...]
    joints: np.ndarray
    joint_names: tuple[str, ...]
    points: np.ndarray
    point_names: tuple[str, ...]
    xor_px: np.ndarray
    iou: np.ndarray
    view_weights: np.ndarray
    limb_residual: np.ndarray
    camera_names: tuple[str, ...]
    confidence: np.ndarray
    lost: np.ndarray
    locked: np.ndarray
    confidence_raw: np.ndarray
    keyed: np.ndarray
    limb_names: tuple[str, ...] = LIMB_NAMES
    point_limbs: tuple[int, ...] = POINT_LIMBS

    @property
    def rate(self) -> Fraction:
        """Frames per second."""
        return Fraction(*self.fps)


def write_motion(path: Path, motion: Motion) -> None:
    """Writes ``motion`` whole or not at all."""
    values = {f.name: np.asarray(getattr(motion, f.name)) for f in fields(Motion)}
    write_archive(path, version=VERSION, **values)


def read_motion(path: Path) -> Motion:
    """The motion stored in ``path``.

    Raises:
        MocapError: no such file, not a motion file, a damaged one, or one of another version.
    """
    stored = read_archive(path, "motion.npz", "give the file that fit wrote")
    stored = {"limb_names": LIMB_NAMES, "point_limbs": POINT_LIMBS} | stored
    stored = {**_before_cleaning(stored), **stored}
    missing = [f.name for f in fields(Motion) if f.name not in stored]
    if missing or not np.array_equal(stored.get("version", 0), VERSION):
        raise MocapError("is no motion file of this version", "run fit again", file=path)
    values: dict[str, Any] = {f.name: stored[f.name] for f in fields(Motion)}
    for name in ("dof_names", "joint_names", "point_names", "camera_names", "limb_names"):
        values[name] = tuple(str(text) for text in values[name])
    for name in ("fps", "point_limbs"):
        values[name] = tuple(int(number) for number in values[name])
    return Motion(**values)


def _before_cleaning(stored: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """What files do not hold that are older than cleaning."""
    if not {"confidence", "joints"} <= stored.keys():
        return {}
    keyed = np.ones(stored["joints"].shape[:2], bool)
    return {"confidence_raw": stored["confidence"], "keyed": keyed}
