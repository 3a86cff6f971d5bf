"""The contour of an observed silhouette: how far every pixel is from it, and points along it."""

from dataclasses import dataclass

import cv2
import numpy as np

from ..geometry.boxes import box_round

BLUR_PX = 0.7
"""Standard deviation that takes the pixels' steps out of the distances."""
_MOST_AT_ONCE = 30_000
"""Points that OpenCV looks up; it counts them in 16 bits."""


@dataclass(frozen=True, eq=False)
class ObservedContour:
    """Where one view's silhouette ends; no points where it shows nobody, or nothing else.

    Attributes:
        field: (H, W) float32 px from the pixel's centre to the contour, negative inside; NaN where
            nothing was observed.
        px: (n, 2) float32 points on the contour.
        normals: (n, 2) float32 unit vectors away from the performer.
    """

    field: np.ndarray
    px: np.ndarray
    normals: np.ndarray

    @classmethod
    def of(
        cls, foreground: np.ndarray, observed: np.ndarray, distances: np.ndarray
    ) -> "ObservedContour":
        """The contour of a `Silhouette`'s pictures, a point for each pair of its pixels."""
        nowhere = np.zeros((0, 2), np.float32)
        if not foreground.any() or foreground.all():
            return cls(np.full(foreground.shape, np.nan, np.float32), nowhere, nowhere)
        field = cv2.GaussianBlur(distances, (0, 0), BLUR_PX)
        # with what slopes beside the contour are made of
        box = box_round(foreground, margin_px=2)
        corner = np.array([box[1].start, box[0].start], np.float32)
        places = _crossings(foreground[box], observed[box])
        steps, normals = _to_zero(field[box], places)
        px = places + corner - steps
        if not observed.all():
            field[~observed] = np.nan
        return cls(field, px, normals)

    def at(self, px: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n,) px from places px (n, 2) to the contour, and (n, 2) how that grows with them."""
        px = px.astype(np.float32)
        steps = np.array([[0, 0], [0.5, 0], [-0.5, 0], [0, 0.5], [0, -0.5]], np.float32)
        middle, right, left, down, up = (_sampled(self.field, px + step) for step in steps)
        return middle, np.stack([right - left, down - up], axis=1)

    def thinned(self, spacing_px: float) -> "ObservedContour":
        """The same with one point per square of ``spacing_px``."""
        squares = np.floor(self.px / spacing_px).astype(np.int64)
        kept = np.sort(np.unique(squares @ [1, 1 << 32], return_index=True)[1])
        return ObservedContour(self.field, self.px[kept], self.normals[kept])


def _crossings(foreground: np.ndarray, observed: np.ndarray) -> np.ndarray:
    """(n, 2) float32 px midway between neighbours of which one is foreground, both observed."""
    found = []
    for one, other, shift in (
        (np.s_[:, :-1], np.s_[:, 1:], (0.5, 0.0)),
        (np.s_[:-1], np.s_[1:], (0.0, 0.5)),
    ):
        crossing = foreground[one] != foreground[other]
        crossing &= observed[one] & observed[other]
        places = np.flatnonzero(crossing)
        rows, columns = np.divmod(places, crossing.shape[1])
        found.append(np.stack([columns + shift[0], rows + shift[1]], axis=1))
    return np.concatenate(found).astype(np.float32)


def _to_zero(field: np.ndarray, px: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Px (n, 2) from the field's zero level to points (n, 2) along its gradient, and that."""
    if not len(px):
        return px, px
    slopes = cv2.Sobel(field, -1, 1, 0, scale=1 / 8), cv2.Sobel(field, -1, 0, 1, scale=1 / 8)
    value, x, y = (_sampled(picture, px) for picture in (field, *slopes))
    length = np.maximum(np.hypot(x, y), 1e-6)
    normals = np.stack([x, y], axis=1) / length[:, None]
    return normals * (value / length)[:, None], normals


def _sampled(picture: np.ndarray, px: np.ndarray) -> np.ndarray:
    """(n,) values of a picture at px (n, 2) float32."""
    blocks = np.array_split(px, len(px) // _MOST_AT_ONCE + 1)
    found = [
        cv2.remap(picture, b[:, 0], b[:, 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        for b in blocks
    ]
    return np.concatenate(found)[:, 0]
