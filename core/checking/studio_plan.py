"""The cameras of a take drawn from above and from the side.

Both are the same drawing through another projection: what a camera sees up to the performer's
distance is a pyramid, and its projection is the hull of five points.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..cameras.camera import Camera
from ..pages.chart import Series
from ..pages.markup import Html, element
from .camera_facts import CameraFacts, Performer

_SIDE = 560.0
_LEAST_HEIGHT = 220.0
_LEAST_MARGIN_M, _MARGIN_SHARE = 0.9, 0.16
_DEPTH_M, _SHOULDERS_M = 2.5, 0.25
_LETTER_PX, _LINE_PX = 8.3, 15.0


@dataclass(frozen=True, eq=False)
class Studio:
    """What is drawn.

    Attributes:
        cameras: at least one.
        opposite: pairs of names that face each other.
        performer: None where unknown.
        floor: its height, world metres.
    """

    cameras: Sequence[CameraFacts]
    opposite: Sequence[tuple[str, str]]
    performer: Performer | None
    floor: float

    @property
    def centres(self) -> np.ndarray:
        """(V, 3) of the cameras."""
        return np.array([facts.camera.centre for facts in self.cameras])


@dataclass(frozen=True, eq=False)
class Sheet:
    """A projection onto paper.

    Attributes:
        axes: (2, 3) world directions that run right and up.
        low: (2,) the lower left corner, metres along the axes.
        scale: px per metre.
        size: (2,) width and height in px.
    """

    axes: np.ndarray
    low: np.ndarray
    scale: float
    size: np.ndarray

    @classmethod
    def around(cls, points: np.ndarray, axes: np.ndarray) -> "Sheet":
        """The sheet that holds world points (N, 3) with a margin."""
        flat = points @ axes.T
        low, high = flat.min(axis=0), flat.max(axis=0)
        # names stand to the left and right of cameras, not above
        side = max(_LEAST_MARGIN_M, _MARGIN_SHARE * float((high - low).max()))
        margin = np.array([side, _LEAST_MARGIN_M])
        low, high = low - margin, high + margin
        scale = _SIDE / float((high - low).max())
        size = np.array([_SIDE, max(_LEAST_HEIGHT, scale * (high[1] - low[1]))])
        low = (low + high) / 2 - size / scale / 2
        return cls(axes, low, scale, size)

    def px(self, points: np.ndarray) -> np.ndarray:
        """(…, 2) px of world points (…, 3)."""
        flat = (np.asarray(points) @ self.axes.T - self.low) * self.scale
        return np.stack([flat[..., 0], self.size[1] - flat[..., 1]], axis=-1)


def plan_from_above(studio: Studio) -> Html:
    """The plan: x to the right, y up."""
    sheet = Sheet.around(_extent(studio), np.eye(3)[:2])
    return _drawing(sheet, studio, [*_squares(sheet), *_standing(sheet, studio)], "from above")


def view_from_the_side(studio: Studio) -> Html:
    """The elevation along the direction in which the cameras stand furthest apart."""
    across = studio.centres[:, :2] - studio.centres[:, :2].mean(axis=0)
    right = np.append(np.linalg.svd(across)[2][0], 0.0)
    sheet = Sheet.around(_extent(studio), np.array([right, [0, 0, 1.0]]))
    return _drawing(sheet, studio, [*_ground(sheet, studio), *_upright(sheet, studio)], "side")


def _extent(studio: Studio) -> np.ndarray:
    """(N, 3) points that must be on the sheet."""
    points = [*studio.centres]
    points += [[*centre[:2], studio.floor] for centre in studio.centres]
    if studio.performer is not None:
        x, y, _ = studio.performer.centre
        points += [[x, y, studio.floor], [x, y, studio.floor + studio.performer.height_m]]
    return np.array(points)


def _drawing(sheet: Sheet, studio: Studio, behind: Sequence[Html], title: str) -> Html:
    width, height = sheet.size
    return element(
        "svg", *behind, *_facing(sheet, studio), *_cones(sheet, studio), *_names(sheet, studio),
        _metre(sheet), class_="plan", viewBox=f"0 0 {width:.0f} {height:.0f}", role="img",
        aria_label=f"cameras seen {title}",
    )  # fmt: skip


def _squares(sheet: Sheet) -> Iterator[Html]:
    """The floor in squares of one metre."""
    width, height = sheet.size
    for axis in (0, 1):
        first = np.ceil(sheet.low[axis])
        for metre in np.arange(first, sheet.low[axis] + sheet.size[axis] / sheet.scale):
            at = (metre - sheet.low[axis]) * sheet.scale
            ends = (at, 0.0, at, height) if axis == 0 else (0.0, height - at, width, height - at)
            yield _line(ends, "grid" if metre else "grid origin")


def _ground(sheet: Sheet, studio: Studio) -> Iterator[Html]:
    row = float(sheet.px(np.array([0, 0, studio.floor]))[1])
    below = max(0.0, float(sheet.size[1]) - row)
    yield element(
        "rect", x=0, y=f"{row:.1f}", width=f"{sheet.size[0]:.0f}", height=f"{below:.1f}",
        class_="ground",
    )  # fmt: skip
    yield _line((0.0, row, float(sheet.size[0]), row), "floor")


def _standing(sheet: Sheet, studio: Studio) -> Iterator[Html]:
    if studio.performer is not None:
        x, y = sheet.px(studio.performer.centre)
        yield element(
            "circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r=f"{_SHOULDERS_M * sheet.scale:.1f}",
            class_="performer",
        )  # fmt: skip


def _upright(sheet: Sheet, studio: Studio) -> Iterator[Html]:
    if studio.performer is not None:
        x, y, _ = studio.performer.centre
        left, top = sheet.px(np.array([x, y, studio.floor + studio.performer.height_m]))
        half = _SHOULDERS_M * sheet.scale
        yield element(
            "rect", x=f"{left - half:.1f}", y=f"{top:.1f}", width=f"{2 * half:.1f}",
            height=f"{studio.performer.height_m * sheet.scale:.1f}", rx=f"{half:.1f}",
            class_="performer",
        )  # fmt: skip


def _cones(sheet: Sheet, studio: Studio) -> Iterator[Html]:
    for style, facts in enumerate(studio.cameras):
        depth = facts.distance_m if np.isfinite(facts.distance_m) else _DEPTH_M
        px = sheet.px(pyramid(facts.camera, depth)).astype(np.float32)
        hull = cv2.convexHull(px)[:, 0]
        shape = " ".join(f"{x:.1f},{y:.1f}" for x, y in hull)
        colour = Series("", hull, style).classes
        x, y = px[0]
        yield element("polygon", points=shape, class_=f"cone {colour}")
        yield element("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r=5, class_=f"camera {colour}")


def pyramid(camera: Camera, depth: float) -> np.ndarray:
    """(5, 3) world points: the camera's centre and its picture's corners at ``depth`` metres."""
    width, height = camera.size
    corners = np.array([[x, y, 1.0] for x in (-0.5, width - 0.5) for y in (-0.5, height - 0.5)])
    rays = np.linalg.solve(camera.matrix, corners.T).T
    return np.vstack([camera.centre, camera.centre + depth * rays @ camera.rotation])


def _facing(sheet: Sheet, studio: Studio) -> Iterator[Html]:
    centres = {facts.camera.name: sheet.px(facts.camera.centre) for facts in studio.cameras}
    for first, second in studio.opposite:
        yield _line((*centres[first], *centres[second]), "facing")


def _names(sheet: Sheet, studio: Studio) -> Iterator[Html]:
    """Names beside the cameras, moved down where one would lie on another."""
    taken: list[tuple[float, float, float]] = []
    middle = sheet.size[0] / 2
    px = sheet.px(studio.centres)
    for k in np.argsort(px[:, 1]):
        name, (x, y) = studio.cameras[k].camera.name, px[k]
        long = _LETTER_PX * len(name)
        left = x + 9 if x + 9 + long < sheet.size[0] and x >= middle else x - 9 - long
        left = float(np.clip(left, 2, max(2.0, sheet.size[0] - long - 2)))
        row = float(y + 4)
        while any(abs(row - r) < _LINE_PX and left < b and a < left + long for a, b, r in taken):
            row += 1.0
        taken.append((left, left + long, row))
        yield element("text", name, x=f"{left:.1f}", y=f"{row:.1f}")


def _metre(sheet: Sheet) -> Html:
    """A measure of one metre in the lower left corner."""
    y = sheet.size[1] - 12
    line = _line((12.0, y, 12 + sheet.scale, y), "measure")
    return element("g", line, element("text", "1 m", x=14, y=f"{y - 5:.1f}", class_="soft"))


def _line(ends: Sequence[float], style: str) -> Html:
    x1, y1, x2, y2 = (f"{end:.1f}" for end in ends)
    return element("line", x1=x1, y1=y1, x2=x2, y2=y2, class_=style)
