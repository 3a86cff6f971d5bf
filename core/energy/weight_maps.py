"""Weight maps of the XOR energy (Theobalt et al. 2003, section 4), at full and half resolution."""

from collections.abc import Sequence

import cv2
import numpy as np

from ..cameras.camera import Camera
from ..silhouettes.silhouette import Silhouette
from .evaluator import WeightMaps

_FAR = 8


def xor_weight_maps(silhouettes: Sequence[Silhouette]) -> WeightMaps:
    """Maps of +1 on background, -1 on foreground and 0 where nothing was observed.

    With them the energy is the number of observed pixels at which rendered and observed
    silhouettes differ.
    """
    maps, constants = [], []
    for silhouette in silhouettes:
        seen = silhouette.foreground & silhouette.observed
        empty = seen ^ silhouette.observed
        maps.append((empty.view(np.int8) - seen.view(np.int8)).astype(np.int16))
        constants.append(np.count_nonzero(seen))
    return WeightMaps(tuple(maps), np.array(constants, np.int64))


def drawing_weight_maps(
    silhouettes: Sequence[Silhouette],
    covered: Sequence[np.ndarray],
    reaches_px: Sequence[float],
) -> WeightMaps:
    """Maps that draw a part from afar to foreground that the rest of the body leaves uncovered.

    That foreground counts -8 per pixel. The background rises from 0 beside it to 8 at the view's
    reach, so that a part that comes near is worth more than one that hides before the body; under
    the XOR energy both are the same until they overlap.

    Args:
        silhouettes: V observed ones.
        covered: V pictures (H, W) of what the rest of the body covers.
        reaches_px: V distances that are far.
    """
    maps = []
    for silhouette, rest, reach in zip(silhouettes, covered, reaches_px, strict=True):
        bare = silhouette.foreground & silhouette.observed & ~rest
        weights = np.full(bare.shape, _FAR, np.int16)
        if bare.any():
            distances = cv2.distanceTransform((~bare).view(np.uint8), cv2.DIST_L2, 3)
            np.minimum(distances * (_FAR / reach), _FAR, out=distances)
            weights = distances.astype(np.int16)
        weights[bare] = -_FAR
        weights[(silhouette.foreground & ~bare) | ~silhouette.observed] = 0
        maps.append(weights)
    return WeightMaps(tuple(maps), np.zeros(len(maps), np.int64))


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
