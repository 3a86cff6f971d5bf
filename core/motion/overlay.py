"""Pictures that show how a motion fits the footage: observed and rendered silhouettes over it.

Green is where both are, red where only the model is, blue where only the performer was observed.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import cv2
import numpy as np

from ..geometry.boxes import box_round
from ..silhouettes.silhouette import Silhouette

BOTH, MODEL_ONLY, OBSERVED_ONLY = (60, 200, 60), (40, 40, 240), (255, 120, 30)
"""Colours, BGR."""
JPEG_QUALITY = (cv2.IMWRITE_JPEG_QUALITY, 90)
"""With which overlay pictures are kept."""
_LEGEND = ((BOTH, "both"), (MODEL_ONLY, "model only"), (OBSERVED_ONLY, "performer only"))
_LINE = (70, 70, 70)
_STRIP_HEIGHT = 24
_WIDEST_TILE, _NARROWEST_TILE = 480, 240
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
    widest = max(tile.footage.shape[1] for tile in tiles)
    tile_width = min(max(widest, _NARROWEST_TILE), _WIDEST_TILE)
    heights = [round(tile_width * t.footage.shape[0] / t.footage.shape[1]) for t in tiles]
    height, width = max(heights), columns * tile_width
    whole = _STRIP_HEIGHT + math.ceil(len(tiles) / columns) * height
    canvas = np.zeros((whole + whole % 2, width + width % 2, 3), np.uint8)
    canvas[:_STRIP_HEIGHT, :width] = _titled_strip(title, width)
    for index, tile in enumerate(tiles):
        top, left = _STRIP_HEIGHT + index // columns * height, index % columns * tile_width
        _draw(tile, canvas[top : top + heights[index], left : left + tile_width])
    return canvas


def coloured(tile: Tile) -> np.ndarray:
    """(H, W, 3) uint8 BGR footage, grey, with the two silhouettes over it; unobserved px darker."""
    grey = cv2.cvtColor(tile.footage, cv2.COLOR_BGR2GRAY).astype(np.uint8, copy=False)
    grey[~tile.silhouette.observed] //= 3
    picture = cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR)
    box = box_round(tile.silhouette.foreground | tile.rendered)
    shades = 256 * tile.silhouette.foreground[box] + 512 * tile.rendered[box] + grey[box]
    picture[box] = _shades().take(shades, axis=0)
    return picture


@cache
def _shades() -> np.ndarray:
    """(1024, 3) uint8 BGR of each grey, 256 on for the performer and 512 on for the model."""
    greys = np.arange(256)[:, None]
    shades = [
        (1 - opacity) * greys + opacity * np.array(colour)
        for colour, opacity in ((OBSERVED_ONLY, 0.9), (MODEL_ONLY, 0.9), (BOTH, 0.6))
    ]
    return np.concatenate([np.repeat(greys, 3, axis=1), *shades]).astype(np.uint8)


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


def _draw(tile: Tile, canvas: np.ndarray) -> None:
    """Fills the canvas (H, W, 3) with the tile, scaled and labelled."""
    picture, (height, width) = coloured(tile), canvas.shape[:2]
    method = cv2.INTER_AREA if picture.shape[1] > width else cv2.INTER_NEAREST
    canvas[:] = cv2.resize(picture, (width, height), interpolation=method)
    _written(canvas, tile.label, 8)
    canvas[0], canvas[:, 0] = _LINE, _LINE
