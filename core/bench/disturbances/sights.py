"""One camera's picture of one frame, and things of the world drawn into it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np

from ...body.body import POINT_NAMES
from ...cameras.arrangement import millimetres_per_pixel
from ...cameras.camera import Camera
from ...silhouettes.cleaning import Cleaning, cleaned
from ...silhouettes.silhouette import Silhouette
from .recording import Recording, drawn_from

HAND_M = 0.18
"""From the wrist to the finger tips."""
FOOT_M = 0.15


@dataclass(frozen=True, eq=False)
class Sight:
    """What a camera saw, and where the performer's points truly were.

    Attributes:
        camera: which looked.
        silhouette: what it saw.
        points: (14, 3) world metres of `POINT_NAMES`; NaN where nobody knows.
        floor: height of the floor, world metres.
    """

    camera: Camera
    silhouette: Silhouette
    points: np.ndarray
    floor: float

    def point(self, name: str) -> np.ndarray:
        """(3,) world metres."""
        return self.points[POINT_NAMES.index(name)]

    @property
    def px_per_metre(self) -> float:
        """At the performer's middle; NaN where nobody knows where that is."""
        known = self.points[np.isfinite(self.points).all(axis=1)]
        return (
            1000 / millimetres_per_pixel(self.camera, known.mean(axis=0)) if len(known) else np.nan
        )

    def limb(self, side: str, kind: str) -> np.ndarray:
        """(4, 3) from the middle of the upper arm, or of the thigh, to the finger or toe tips."""
        arm = kind == "arm"
        names = ("shoulder", "elbow", "wrist") if arm else ("hip", "knee", "ankle")
        root, middle, end = (self.point(f"{side}_{name}") for name in names)
        along = (end - middle) / max(float(np.linalg.norm(end - middle)), 1e-9)
        tip = end + along * (HAND_M if arm else FOOT_M)
        return np.stack([(root + middle) / 2, middle, end, tip])


def rods(sight: Sight, ends: Sequence[np.ndarray], radius_m: float) -> np.ndarray:
    """(H, W) bool, what a chain of round rods through world points (n, 3) each covers.

    Rods with an end that is unknown or not in front of the camera are left out.
    """
    picture = np.zeros(sight.camera.size[::-1], np.uint8)
    for chain in ends:
        px = sight.camera.project(chain)
        depths = sight.camera.depths(chain)
        for k in range(len(chain) - 1):
            if np.isfinite(px[k : k + 2]).all():
                radius = radius_m * sight.camera.matrix[0, 0] / depths[k : k + 2].mean()
                start, end = np.round(px[k : k + 2]).astype(int).tolist()
                cv2.line(picture, start, end, (1,), max(1, round(2 * radius)))
    return picture.view(bool)


def ball(sight: Sight, centre: np.ndarray, radius_m: float) -> np.ndarray:
    """(H, W) bool, what a ball about a world point (3,) covers."""
    picture = np.zeros(sight.camera.size[::-1], np.uint8)
    px = sight.camera.project(centre)
    if np.isfinite(px).all():
        radius = radius_m * sight.camera.matrix[0, 0] / float(sight.camera.depths(centre))
        cv2.circle(picture, np.round(px).astype(int).tolist(), max(1, round(radius)), (1,), -1)
    return picture.view(bool)


class PictureDisturbance:
    """What changes the silhouettes one by one; cleaned afterwards, as every fit cleans masks."""

    run = 1
    """Frames in a row that share their random numbers."""

    def mask(self, sight: Sight, rng: np.random.Generator) -> np.ndarray:
        """(H, W) bool, the silhouette as it becomes."""
        raise NotImplementedError

    def __call__(self, recording: Recording, seed: int) -> Recording:
        """The recording with other silhouettes."""

        def look(frame: int, view: int) -> Silhouette:
            seen, camera = recording.look(frame, view), recording.cameras[view]
            sight = Sight(camera, seen, recording.points(frame), recording.floor)
            rng = drawn_from(seed, self, frame // self.run, view)
            mask = cleaned(self.mask(sight, rng), Cleaning()).mask
            return Silhouette(mask & seen.observed, seen.observed)

        return replace(recording, look=look)
