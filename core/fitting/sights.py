"""What a model's limbs cover in a frame beside what the footage shows, view by view."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from ..energy.evaluator import Evaluator
from ..geometry.boxes import box_round
from ..silhouettes.silhouette import Silhouette
from .limbs import limb_segments

BACKGROUND, FOREGROUND = 0, 1


@dataclass(frozen=True, eq=False)
class Sight:
    """One view round all that the performer and the model cover in it.

    Attributes:
        silhouette: what was observed.
        box: rows and columns of what follows; beyond is nothing.
        drawn: (H, W) unsigned, a bit for each of the L limbs that the model shows there.
        kinds: 2^L, of sets of limbs that can cover a pixel, each a number of L bits.
    """

    silhouette: Silhouette
    box: tuple[slice, slice]
    drawn: np.ndarray
    kinds: int

    def counts(self) -> np.ndarray:
        """(2, 2^L) observed px of background and foreground by the set of limbs that cover them."""
        foreground = self.silhouette.foreground[self.box].view(np.uint8)
        places = self.drawn.dtype.type(self.kinds) * foreground + self.drawn
        observed = self.silhouette.observed[self.box]
        return np.bincount(places[observed], minlength=2 * self.kinds).reshape(2, self.kinds)

    def contour(self) -> tuple[np.ndarray, np.ndarray]:
        """(n,) px between the model's contour and the silhouette, and the sets of limbs beside it.

        Empty where the silhouette is.
        """
        if not self.silhouette.foreground.any():
            return np.zeros(0, np.float32), np.zeros(0, np.uint8)
        pairs = contour_pairs(self.drawn > 0, self.silhouette.observed[self.box])
        beside = self.drawn.ravel()[pairs]
        distances = self.silhouette.distances[self.box].ravel()[pairs]
        return np.abs(distances.sum(axis=0)) / 2, beside[0] | beside[1]


def sights_of(
    evaluator: Evaluator,
    pose: np.ndarray,
    rendered: Sequence[np.ndarray],
    silhouettes: Sequence[Silhouette],
) -> list[Sight]:
    """V sights of a pose (D,), ``rendered`` being V pictures (H, W) of all that it covers."""
    limbs = limb_segments(evaluator.body)
    sights, kinds = [], 1 << len(limbs)
    number = np.min_scalar_type(2 * kinds - 1)
    for silhouette, model in zip(silhouettes, rendered, strict=True):
        # with the pixels beyond the contour
        box = box_round(silhouette.foreground | model, margin_px=1)
        sights.append(Sight(silhouette, box, np.zeros(model[box].shape, number), kinds))
    for limb, segments in enumerate(limbs):
        for sight, part in zip(sights, evaluator.silhouettes(pose, segments), strict=True):
            np.bitwise_or(sight.drawn, 1 << limb, out=sight.drawn, where=part[sight.box])
    return sights


@cache
def sets_with_limbs(limbs: int) -> np.ndarray:
    """(2^L, L) bool, which of L limbs belong to each set."""
    return (np.arange(1 << limbs)[:, None] >> np.arange(limbs) & 1).astype(bool)


def contour_pairs(model: np.ndarray, observed: np.ndarray) -> np.ndarray:
    """(2, n) flat indices of neighbouring pixels between which the model's contour runs.

    One of them lies inside, one outside, both are observed. The picture's edge is no contour.
    """
    width, found = model.shape[1], []
    for one, other, step in (np.s_[:, :-1], np.s_[:, 1:], 1), (np.s_[:-1], np.s_[1:], width):
        crossing = np.zeros(model.shape, bool)
        crossing[one] = (model[one] != model[other]) & observed[one] & observed[other]
        found.append(np.flatnonzero(crossing) + np.array([[0], [step]]))
    return np.concatenate(found, axis=1)
