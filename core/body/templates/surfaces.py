"""Which surface pieces there are, and how they become the meshes of the segments."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from ...geometry.loft import Axis, chosen_samples, lofted
from ..body import Surface
from .landmarks import FORWARD, UP, landmarks
from .profiles import default_profiles
from .proportions import Proportions


@dataclass(frozen=True)
class Level:
    """One level of detail: each piece's own sides and rings times these factors."""

    sides: float
    rings: float


LEVELS = (Level(1, 1), Level(3, 3.4))
"""About 2,000 triangles, and more than the 21,422 of Theobalt et al. 2003."""


@dataclass(frozen=True, eq=False)
class Loft:
    """One closed surface piece.

    Attributes:
        start: landmark at station 0.
        end: landmark at station 1.
        front: (3,) the way the profile's front looks.
        detail: (sides, rings) of the coarse level; sides even, so that halves mirror.
    """

    start: str
    end: str
    front: np.ndarray
    detail: tuple[int, int]


LOFTS = {
    "pelvis": Loft("root", "waist", FORWARD, (14, 5)),
    "abdomen": Loft("waist", "chest", FORWARD, (14, 5)),
    "chest": Loft("chest", "neck", FORWARD, (14, 6)),
    "neck": Loft("neck", "head", FORWARD, (10, 3)),
    "skull": Loft("head", "head_end", FORWARD, (12, 6)),
    "jaw": Loft("skull", "chin", FORWARD, (10, 3)),
    "clavicle": Loft("left_clavicle_root", "left_shoulder", FORWARD, (8, 4)),
    "upper_arm": Loft("left_shoulder", "left_elbow", FORWARD, (8, 6)),
    "forearm": Loft("left_elbow", "left_wrist", FORWARD, (8, 5)),
    "hand": Loft("left_wrist", "left_fingertip", FORWARD, (8, 5)),
    "thumb": Loft("left_thumb", "left_thumb_tip", FORWARD, (6, 2)),
    "thigh": Loft("left_hip", "left_knee", FORWARD, (10, 6)),
    "shank": Loft("left_knee", "left_ankle", FORWARD, (10, 7)),
    "foot": Loft("left_heel_sole", "left_ball_sole", UP, (10, 5)),
    "toes": Loft("left_ball_sole", "left_toe_sole", UP, (8, 4)),
}
"""Name of the profile -> its piece; pieces that start on the left exist on both sides."""

MIRROR = np.array([-1.0, 1.0, 1.0])


def surface(
    proportions: Proportions, segments: tuple[tuple[str, str, tuple[str, ...]], ...], level: Level
) -> Surface:
    """The surface of segments given as (name, joint, pieces); right ones mirror the left pieces."""
    places = landmarks(proportions)
    vertices, triangles, vertex_starts, triangle_starts = [], [], [0], [0]
    for name, joint, pieces in segments:
        for piece in pieces:
            points, faces = _piece(proportions, places, piece, level)
            points = points - places[joint.replace("right_", "left_")]
            if name.startswith("right_"):
                points, faces = points * MIRROR, faces[:, ::-1]
            triangles.append(faces + sum(map(len, vertices)))
            vertices.append(points)
        vertex_starts.append(sum(map(len, vertices)))
        triangle_starts.append(sum(map(len, triangles)))
    return Surface(
        np.concatenate(vertices),
        np.concatenate(triangles),
        np.array(vertex_starts),
        np.array(triangle_starts),
    )


def _piece(
    proportions: Proportions, places: dict[str, np.ndarray], piece: str, level: Level
) -> tuple[np.ndarray, np.ndarray]:
    """Vertices in rest-pose world metres and triangles of one piece, left or central."""
    loft = LOFTS[piece]
    sides, rings = loft.detail
    axis = Axis(places[loft.start], places[loft.end], loft.front)
    picked = _picked(piece, round(rings * level.rings))
    return lofted(proportions.profiles[piece], axis, 2 * round(sides * level.sides / 2), picked)


@cache
def _picked(piece: str, rings: int) -> np.ndarray:
    """Where the rings stand: chosen for the average adult, so that shapes change smoothly."""
    return chosen_samples(*default_profiles()[piece].sampled(), rings + 2)
