"""Silhouettes and plates of a whole take, written to files."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import MocapError
from ..footage.footage import open_footage
from ..footage.patterns import for_camera
from ..progress import Progress
from ..silhouettes.masks import write_masks
from ..silhouettes.plate import write_plate
from ..silhouettes.plate_making import plate_from
from ..silhouettes.plate_recipe import PlateRecipe
from .take import Take
from .views import View, Views

_SEEN_SHARE = 0.001
"""Share of the picture that a performer covers at least."""


@dataclass(frozen=True)
class MaskQuality:
    """How sound one camera's silhouettes look.

    Attributes:
        camera: its name.
        frames: how many were made.
        empty: frames in which hardly anything was found.
        flicker: median share of the silhouette's px that change from one frame to the next.
        specks: mean number of specks removed per frame.
        holes: mean number of holes filled per frame.
        at_edge: share of the frames in which the silhouette touches the picture's edge.
    """

    camera: str
    frames: int
    empty: int
    flicker: float
    specks: float
    holes: float
    at_edge: float


def write_take_masks(views: Views, folder: Path, progress: Progress) -> tuple[MaskQuality, ...]:
    """Writes ``folder/CAMERA/000000.png`` … in footage px, lens and ignore mask left as they are.

    Raises:
        MocapError: a frame that is missing or damaged, or a folder that cannot be written.
    """
    first, last = views.frames
    progress.begin("masks", len(views.views) * (last - first + 1))
    found = []
    for view in views.views:
        tally = _Tally()
        pattern = folder / "{camera}" / "{frame:06d}.png"
        masks = _masks(view, views.frames, tally, progress)
        write_masks(pattern, view.camera.name, masks)
        found.append(tally.quality(view.camera.name))
    return tuple(found)


def _masks(
    view: View, frames: tuple[int, int], tally: "_Tally", progress: Progress
) -> Iterator[tuple[int, np.ndarray]]:
    for frame in range(frames[0], frames[1] + 1):
        cleaned = view.source.mask(frame)
        tally.add(cleaned.mask, cleaned.specks, cleaned.holes)
        progress.advance(frame)
        yield frame, cleaned.mask


class _Tally:
    """What `MaskQuality` is made of, frame by frame."""

    def __init__(self):
        self.last: np.ndarray | None = None
        self.frames = self.empty = self.specks = self.holes = self.at_edge = 0
        self.changes: list[float] = []

    def add(self, mask: np.ndarray, specks: int, holes: int) -> None:
        """Counts one frame."""
        area = np.count_nonzero(mask)
        self.frames += 1
        self.empty += area < _SEEN_SHARE * mask.size
        self.specks += specks
        self.holes += holes
        self.at_edge += bool(mask[0].any() or mask[-1].any() or mask[:, [0, -1]].any())
        if self.last is not None:
            self.changes.append(np.count_nonzero(mask ^ self.last) / max(area, 1))
        self.last = mask

    def quality(self, camera: str) -> MaskQuality:
        """The figures so far."""
        return MaskQuality(
            camera=camera,
            frames=self.frames,
            empty=self.empty,
            flicker=float(np.median(self.changes)) if self.changes else 0.0,
            specks=self.specks / self.frames,
            holes=self.holes / self.frames,
            at_edge=self.at_edge / self.frames,
        )


def make_plate(
    take: Take, camera: str, recipe: PlateRecipe, frames: tuple[int | None, int | None]
) -> Path:
    """Makes one camera's plate from its footage and writes it where the take expects it.

    Args:
        take: the take.
        camera: the camera's name.
        recipe: what helps, as nobody filmed the empty scene.
        frames: first and last frame to look at, inclusive; None for the take's own.

    Raises:
        MocapError: the take has no footage or names no plate, or a picture cannot be read.
    """
    files = take.footage
    if files.video is None or files.plate is None:
        raise MocapError(
            'expected "video" and "plate" in [footage]',
            "say where the footage is and where the plate shall go", file=take.path,
        )  # fmt: skip
    footage = open_footage(files.video, camera, take.frames)
    first, last = take.frames or (footage.frames[0], footage.frames[-1])
    begin, end = frames
    span = (first if begin is None else begin, last if end is None else end)
    path = Path(for_camera(files.plate, camera))
    write_plate(path, plate_from(footage, span, recipe))
    return path
