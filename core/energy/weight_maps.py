"""Weight maps of the XOR energy (Theobalt et al. 2003, section 4), at full and half resolution."""

from collections.abc import Sequence

import numpy as np

from ..cameras.camera import Camera
from ..silhouettes.silhouette import Silhouette
from .evaluator import WeightMaps


def xor_weight_maps(silhouettes: Sequence[Silhouette]) -> WeightMaps:
    """Maps of +1 on background, -1 on foreground and 0 where nothing was observed.

    With them the energy is the number of observed pixels at which rendered and observed
    silhouettes differ.
    """
    maps, constants = [], []
    for silhouette in silhouettes:
        weights = np.where(silhouette.foreground, -1, 1).astype(np.int16)
        weights[~silhouette.observed] = 0
        maps.append(weights)
        constants.append(np.count_nonzero(silhouette.foreground & silhouette.observed))
    return WeightMaps(tuple(maps), np.array(constants, np.int64))


def halved(maps: WeightMaps) -> WeightMaps:
    """Maps of half the resolution; each weight is the sum of the four it replaces.

    An odd last row or column is paired with weights of 0. The constants stay, so that energies stay
    in full-resolution pixels. The maps belong to `halved_camera`.
    """
    half = []
    for full in maps.maps:
        height, width = full.shape
        even = np.pad(full, ((0, height % 2), (0, width % 2)))
        half.append(even.reshape(even.shape[0] // 2, 2, -1, 2).sum(axis=(1, 3), dtype=np.int16))
    return WeightMaps(tuple(half), maps.constants)


def halved_camera(camera: Camera) -> Camera:
    """The camera of pictures of half the resolution, an odd last row or column kept."""
    width, height = camera.size
    return camera.scaled(0.5, ((width + 1) // 2, (height + 1) // 2))
