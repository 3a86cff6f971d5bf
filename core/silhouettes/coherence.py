"""Makes a mask out of evidence per pixel, with neighbours of like colour deciding together.

Single pixels are noisy and mixed at the contour; people are not. The label of a pixel is found by
mean-field iterations of a pairwise Markov random field (Krähenbühl and Koltun 2011, with a small
window instead of all pixels): ``m = tanh((evidence + sum of weight * m of the neighbours) / 2)``,
where a neighbour's weight falls with its distance and with its difference in colour, so that
contours follow edges of the picture. Edges that the empty scene has as well count less (Sun et al.
2006, "Background Cut").
"""

import math
from dataclasses import dataclass

import numpy as np

_REACH = 2
_ROUNDS = 8
_NEIGHBOURS = tuple(
    (down, right)
    for down in range(_REACH + 1)
    for right in range(-_REACH, _REACH + 1)
    if (down, right) > (0, 0)
)


@dataclass(frozen=True)
class Coherence:
    """How neighbours decide together.

    Attributes:
        weight: pull of a direct neighbour of the same colour, in units of evidence.
        colour: grey levels of difference that a neighbour bears.
        scene_edge: grey levels of an edge in the empty scene that halve what it counts.
    """

    weight: float = 2.0
    colour: float = 15.0
    scene_edge: float = 20.0


Region = tuple[slice, slice]


def neighbour_pulls(
    colours: np.ndarray, background: np.ndarray, coherence: Coherence
) -> list[tuple[Region, Region, np.ndarray]]:
    """For each step to a neighbour: the pixels, their neighbours, and the pull between them.

    Args:
        colours: (H, W, 3) float32 picture.
        background: (H, W, 3) float32 empty scene.
        coherence: how strongly neighbours pull.
    """
    return [
        (here, there, _pull(colours, background, here, there, coherence) / math.hypot(*step))
        for step in _NEIGHBOURS
        for here, there in [_slices(step, colours.shape[:2])]
    ]


def coherent(evidence: np.ndarray, pulls: list[tuple[Region, Region, np.ndarray]]) -> np.ndarray:
    """(H, W) bool, True for foreground.

    Args:
        evidence: (H, W) float32, positive for foreground, about -4 to 4 (log odds).
        pulls: as from ``neighbour_pulls``.
    """
    labels = np.tanh(evidence / 2)
    for _ in range(_ROUNDS):
        total = evidence.copy()
        for here, there, pull in pulls:
            total[here] += pull * labels[there]
            total[there] += pull * labels[here]
        labels = np.tanh(total / 2)
    return labels > 0


def _pull(colours, background, here, there, coherence: Coherence) -> np.ndarray:
    edge = _squared(colours[here] - colours[there])
    scene = _squared(background[here] - background[there])
    edge /= 1 + scene / coherence.scene_edge**2
    return coherence.weight * np.exp(-edge / (2 * coherence.colour**2))


def _squared(steps: np.ndarray) -> np.ndarray:
    return np.einsum("ijk,ijk->ij", steps, steps)


def _slices(step: tuple[int, int], shape: tuple[int, ...]):
    (down, right), (height, width) = step, shape
    here = slice(0, height - down), slice(max(-right, 0), width - max(right, 0))
    there = slice(down, height), slice(max(right, 0), width - max(-right, 0))
    return here, there
