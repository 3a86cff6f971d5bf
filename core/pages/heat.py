"""Many series over frames as rows of shades: legible where lines would cover each other."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from .axis import Axis, frame_axis
from .chart import caption, frame_marks
from .document import png_picture
from .markup import Html, element
from .wording import decimal

_MOST_COLUMNS = 1000
_ROW_REM = 1.3


@dataclass(frozen=True, eq=False)
class Heat:
    """Rows over the same frames.

    Attributes:
        title: what is shown.
        unit: of the values, in words.
        frames: (T,) frame numbers, rising, at least one.
        names: of the rows.
        values: (T, rows), NaN where there is none.
        scale: values of the darkest and the brightest shade.
    """

    title: str
    unit: str
    frames: np.ndarray
    names: Sequence[str]
    values: np.ndarray
    scale: Axis


def heat_figure(heat: Heat) -> Html:
    """The rows with names, frame numbers and the scale of shades."""
    first, last = int(heat.frames[0]), int(heat.frames[-1])
    x = Axis(first - 0.5, last + 0.5, frame_axis(heat.frames).pieces)
    image = png_picture(shaded(lowest_in_columns(heat), heat.scale), heat.title)
    high = f"height:{_ROW_REM * len(heat.names):.1f}rem"
    rows = element("div", image, class_="rows", style=high)
    names = (
        element("span", name, class_="y", style=f"top:{100 * (k + 0.5) / len(heat.names):.2f}%")
        for k, name in enumerate(heat.names)
    )
    plot = element("div", rows, *names, *frame_marks(x), class_="plot")
    return element(
        "figure", caption(heat.title, heat.unit), plot, _shades(heat.scale), class_="heat"
    )


def lowest_in_columns(heat: Heat) -> np.ndarray:
    """(rows, columns) the lowest value of each column's frames; NaN where there is none."""
    first, last = int(heat.frames[0]), int(heat.frames[-1])
    count = min(last - first + 1, _MOST_COLUMNS)
    columns = (heat.frames - first) * count // (last - first + 1)
    lowest = np.full((count, heat.values.shape[1]), np.inf)
    np.minimum.at(lowest, columns, np.where(np.isnan(heat.values), np.inf, heat.values))
    return np.where(np.isinf(lowest), np.nan, lowest).T


def shaded(values: np.ndarray, scale: Axis) -> np.ndarray:
    """(H, W, 4) uint8 BGRA of values (H, W); what is NaN is transparent."""
    levels = np.clip(scale.shares(np.nan_to_num(values, nan=scale.low)), 0, 1) * 255
    # of OpenCV's maps the one made for colour-blind eyes
    colours = cv2.applyColorMap(levels.round().astype(np.uint8), cv2.COLORMAP_CIVIDIS)
    opaque = np.where(np.isnan(values), 0, 255).astype(np.uint8)
    return np.dstack([colours, opaque])


def _shades(scale: Axis) -> Html:
    ramp = shaded(np.linspace(scale.low, scale.high, 64)[None], scale)
    low, high = (decimal(value) for value in (scale.low, scale.high))
    parts = (
        element("span", f"{low} or less"),
        png_picture(ramp, "scale of shades"),
        element("span", high),
        element("span", "blank: nobody observed"),
    )
    return element("div", *parts, class_="shades")
