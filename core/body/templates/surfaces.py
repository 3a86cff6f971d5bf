"""Which surface pieces there are, and how they become the meshes of the segments."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from ...geometry.loft import Axis, lofted
from ...geometry.ring_choice import chosen_samples
from ..body import Surface
from .landmarks import FORWARD, UP, landmarks
from .profiles import default_profiles
from .proportions import Proportions


@dataclass(frozen=True)
class Level:
    """One level of detail.

    Attributes:
        sides: times each piece's own.
        rings: likewise.
        outline_distance: metres that the average adult's outline lies beside the finest level's,
            measured in silhouettes of moving bodies; that of other adults is nearly the same.
    """

    sides: float
    rings: float
    outline_distance: float = 0.0


LEVELS = (Level(1, 1, 0.00060), Level(1.5, 1.8, 0.00028), Level(3, 3.4))
"""About 2,300 and 6,200 triangles, and more than the 21,422 of Theobalt et al. 2003."""


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
    "pelvis": Loft("root", "waist", FORWARD, (10, 6)),
    "abdomen": Loft("waist", "chest", FORWARD, (16, 5)),
    "chest": Loft("chest", "neck", FORWARD, (12, 8)),
    "neck": Loft("neck", "head", FORWARD, (10, 4)),
    "skull": Loft("head", "head_end", FORWARD, (12, 5)),
    "jaw": Loft("skull", "chin", FORWARD, (8, 4)),
    "clavicle": Loft("left_clavicle_root", "left_shoulder", FORWARD, (6, 3)),
    "upper_arm": Loft("left_shoulder", "left_elbow", FORWARD, (10, 7)),
    "forearm": Loft("left_elbow", "left_wrist", FORWARD, (8, 5)),
    "hand": Loft("left_wrist", "left_fingertip", FORWARD, (8, 4)),
    "thumb": Loft("left_thumb", "left_thumb_tip", FORWARD, (6, 2)),
    "thigh": Loft("left_hip", "left_knee", FORWARD, (12, 7)),
    "shank": Loft("left_knee", "left_ankle", FORWARD, (12, 5)),
    "foot": Loft("left_heel_sole", "left_ball_sole", UP, (8, 6)),
    "toes": Loft("left_ball_sole", "left_toe_sole", UP, (8, 3)),
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
        for piece, mirrored in _sided(name, pieces):
            points, faces = _piece(proportions, places, piece, level)
            points = points - places[joint.replace("right_", "left_")]
            if mirrored:
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
        level.outline_distance,
    )


def _sided(segment: str, pieces: tuple[str, ...]) -> list[tuple[str, bool]]:
    """The pieces and whether to mirror them; central segments hold left ones on both sides."""
    if segment.startswith(("left_", "right_")):
        return [(piece, segment.startswith("right_")) for piece in pieces]
    both = [piece for piece in pieces if LOFTS[piece].start.startswith("left_")]
    return [*((piece, False) for piece in pieces), *((piece, True) for piece in both)]


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
