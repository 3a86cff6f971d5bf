"""Pictures that show how a motion fits the footage: observed and rendered silhouettes over it.

Green is where both are, red where only the model is, blue where only the performer was observed.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..silhouettes.silhouette import Silhouette

BOTH, MODEL_ONLY, OBSERVED_ONLY = (60, 200, 60), (40, 40, 240), (255, 120, 30)
"""Colours, BGR."""
JPEG_QUALITY = (cv2.IMWRITE_JPEG_QUALITY, 90)
"""With which overlay pictures are kept."""
_LEGEND = ((BOTH, "both"), (MODEL_ONLY, "model only"), (OBSERVED_ONLY, "performer only"))
_OPACITIES = {BOTH: 0.6, MODEL_ONLY: 0.9, OBSERVED_ONLY: 0.9}
_LINE = (70, 70, 70)
_STRIP_HEIGHT = 24
_TILE_WIDTH = 480
_LABEL = {"fontFace": cv2.FONT_HERSHEY_SIMPLEX, "fontScale": 0.5, "color": (255, 255, 255)}


@dataclass(frozen=True, eq=False)
class Tile:
    """One view of one frame.

    Attributes:
        label: written into its corner.
        footage: (H, W, 3) uint8 BGR.
        silhouette: what was observed.
        rendered: (H, W) bool, where the model is.
    """

    label: str
    footage: np.ndarray
    silhouette: Silhouette
    rendered: np.ndarray


def overlay_picture(tiles: Sequence[Tile], title: str) -> np.ndarray:
    """(H, W, 3) uint8 BGR picture of all views side by side, ``title`` on top; of even sizes."""
    columns = math.ceil(math.sqrt(len(tiles)))
    pictures = [_scaled_and_labelled(tile) for tile in tiles]
    height = max(picture.shape[0] for picture in pictures)
    padded = [_padded(picture, height) for picture in pictures]
    padded += [np.zeros_like(padded[0])] * (-len(padded) % columns)
    rows = [np.hstack(padded[i : i + columns]) for i in range(0, len(padded), columns)]
    return _padded(np.vstack([_titled_strip(title, columns * _TILE_WIDTH), *rows]))


def coloured(tile: Tile) -> np.ndarray:
    """(H, W, 3) uint8 BGR footage, grey, with the two silhouettes over it; unobserved px darker."""
    grey = cv2.cvtColor(tile.footage, cv2.COLOR_BGR2GRAY)
    picture = cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR)
    picture[~tile.silhouette.observed] //= 3
    seen, drawn = tile.silhouette.foreground, tile.rendered
    for where, colour in (
        (seen & drawn, BOTH),
        (drawn & ~seen, MODEL_ONLY),
        (seen & ~drawn, OBSERVED_ONLY),
    ):
        opacity = _OPACITIES[colour]
        picture[where] = (1 - opacity) * picture[where] + opacity * np.array(colour)
    return picture


def _titled_strip(title: str, width: int) -> np.ndarray:
    """The title, then what the colours mean."""
    strip = np.zeros((_STRIP_HEIGHT, width, 3), np.uint8)
    x = 8 + _written(strip, title, 8) + 24
    for colour, meaning in _LEGEND:
        cv2.rectangle(strip, (x, 7), (x + 10, 17), colour, cv2.FILLED)
        x += 16 + _written(strip, meaning, x + 16) + 16
    return strip


def _written(picture: np.ndarray, text: str, x: int) -> int:
    """Writes ``text`` at the top and returns its width."""
    cv2.putText(picture, text, (x, 17), **_LABEL, lineType=cv2.LINE_AA)
    return cv2.getTextSize(text, _LABEL["fontFace"], _LABEL["fontScale"], 1)[0][0]


def _scaled_and_labelled(tile: Tile) -> np.ndarray:
    picture = coloured(tile)
    height = round(picture.shape[0] * _TILE_WIDTH / picture.shape[1])
    shrinks = picture.shape[1] > _TILE_WIDTH
    method = cv2.INTER_AREA if shrinks else cv2.INTER_NEAREST
    picture = cv2.resize(picture, (_TILE_WIDTH, height), interpolation=method)
    _written(picture, tile.label, 8)
    picture[0], picture[:, 0] = _LINE, _LINE
    return picture


def _padded(picture: np.ndarray, height: int | None = None) -> np.ndarray:
    """``picture`` with black below up to ``height``, or to even sizes."""
    rows = picture.shape[0] % 2 if height is None else height - picture.shape[0]
    columns = picture.shape[1] % 2 if height is None else 0
    return np.pad(picture, ((0, rows), (0, columns), (0, 0)))
