"""Wrists by colour: where the line from elbow to hand enters the hand.

Skin is found by its chroma (Cr 133 to 173, Cb 77 to 127: Chai and Ngan 1999), the hand is the
ellipse with the second moments of the patch at the end of the arm, and the wrist its intersection
with the line from the elbow to its centre, on the elbow's side (Jaume-i-Capó et al. 2012). Where
the forearm is bare, too, the patch is longer than a hand and tells nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from .heading import joint_px
from .one_frame import FrameJoints, Performer, is_frontal
from .rays import Meeting, Rays, meeting, ray
from .seen_view import SeenView
from .skeleton import JOINT_NAMES

_LOWEST, _HIGHEST = np.array([0, 133, 77]), np.array([255, 173, 127])
_LONGEST_HAND = 0.15
_NEAR_TIP = 0.04
"""Of the performer's height."""
_FEWEST_PX = 6


@dataclass(frozen=True, eq=False)
class Ellipse:
    """The ellipse with the second moments of a patch.

    Attributes:
        centre: (2,) px.
        axes: (2, 2) px, rows: the semi-axes, the longer one last.
    """

    centre: np.ndarray
    axes: np.ndarray

    @classmethod
    def of(cls, px: np.ndarray) -> "Ellipse":
        """Of a filled patch's px (n, 2); each pixel is a square, which keeps lines from being 0."""
        values, vectors = np.linalg.eigh(np.cov(px.T, bias=True) + np.eye(2) / 12)
        return cls(px.mean(axis=0), 2 * np.sqrt(values)[:, None] * vectors.T)

    def entry(self, start: np.ndarray) -> np.ndarray:
        """(2,) where the line from ``start`` (2,), outside, to the centre enters."""
        way = start - self.centre
        squares = (self.axes**2).sum(axis=1)
        reach = np.sqrt((((self.axes @ way) / squares) ** 2).sum())
        return self.centre + way / reach


def skin_of(picture: np.ndarray, foreground: np.ndarray) -> np.ndarray:
    """(H, W) uint8, 1 where a BGR picture (H, W, 3) uint8 shows skin of the performer."""
    chroma = cv2.cvtColor(picture, cv2.COLOR_BGR2YCrCb)
    return cv2.inRange(chroma, _LOWEST, _HIGHEST) // 255 * foreground.astype(np.uint8)


def hand_ellipse(skin: np.ndarray, tip: np.ndarray, height_px: float) -> Ellipse | None:
    """The hand whose fingers end at ``tip`` (2,) px; None where no patch there is a hand."""
    _, labels = cv2.connectedComponents(skin)
    rows, columns = np.nonzero(skin)
    if not len(rows):
        return None
    px = np.stack([columns, rows], axis=1).astype(float)
    distances = np.linalg.norm(px - tip, axis=1)
    nearest = int(distances.argmin())
    patch = px[labels[rows, columns] == labels[rows[nearest], columns[nearest]]]
    if distances[nearest] > _NEAR_TIP * height_px or len(patch) < _FEWEST_PX:
        return None
    ellipse = Ellipse.of(patch)
    longest = 2 * float(np.linalg.norm(ellipse.axes[1]))
    return ellipse if longest <= _LONGEST_HAND * height_px else None


def skin_wrist(
    views: Sequence[SeenView],
    skins: Sequence[np.ndarray],
    frame: FrameJoints,
    performer: Performer,
    side: int,
) -> Meeting | None:
    """The wrist of a side (0 left, 1 right) where two views show its hand by colour.

    Args:
        views: of the frame.
        skins: V pictures (H, W) uint8, `skin_of` each view.
        frame: its joints.
        performer: who is seen.
        side: 0 for the left.
    """
    elbow = frame.points[JOINT_NAMES.index("left_elbow") + side]
    centres, directions, weights = [], [], []
    for view, skin in zip(views, skins, strict=True):
        if not is_frontal(view, frame.heading, performer.centre) or view.upright is None:
            continue
        tip = joint_px(view, frame.heading, "tips", side)
        hand = hand_ellipse(skin, tip, view.upright.height_px)
        if hand is None:
            continue
        entry = hand.entry(view.camera.project(elbow))
        centres.append(view.camera.centre)
        directions.append(ray(view.camera, entry))
        weights.append(frame.heading.frontality(view, performer.centre) ** 2)
    if len(weights) < 2:
        return None
    return meeting(Rays(np.array(centres), np.array(directions), np.array(weights)))
