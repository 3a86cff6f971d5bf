"""Silhouettes and plates of a whole take, written to files."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ..errors import MocapError
from ..footage.footage import open_footage
from ..footage.patterns import for_camera
from ..progress import Progress
from ..silhouettes.masks import ReadyMasks, write_masks
from ..silhouettes.plate import write_plate
from ..silhouettes.plate_making import plate_from
from ..silhouettes.plate_recipe import PlateRecipe
from ..silhouettes.quality import MaskMeter, MaskQuality
from .take import Take
from .views import View, Views


def write_take_masks(views: Views, folder: Path, progress: Progress) -> dict[str, MaskQuality]:
    """Writes ``folder/CAMERA/000000.png`` … in footage px, lens and ignore mask left as they are.

    Returns:
        How sound the masks look, by camera.

    Raises:
        MocapError: a frame that is missing or damaged, or a folder that cannot be written.
    """
    for view in views.views:
        _check_spared(view, folder)
    first, last = views.frames
    progress.begin("masks", len(views.views) * (last - first + 1))
    pattern = folder / "{camera}" / "{frame:06d}.png"
    found = {}
    for view in views.views:
        meter = MaskMeter()
        write_masks(pattern, view.camera.name, _masks(view, views.frames, meter, progress))
        found[view.camera.name] = meter.quality()
    return found


def _check_spared(view: View, folder: Path) -> None:
    """Refuses to write masks over the pictures that they are made from."""
    place, target = Path(view.place), (folder / view.camera.name).resolve()
    if target in (place.parent, place):
        raise MocapError(
            "holds the pictures of the take, which the masks would replace",
            "give another folder", file=target, camera=view.camera.name,
        )  # fmt: skip


def _masks(
    view: View, frames: tuple[int, int], meter: MaskMeter, progress: Progress
) -> Iterator[tuple[int, np.ndarray]]:
    footage, ready = view.source.footage, isinstance(view.source.extractor, ReadyMasks)
    for frame in range(frames[0], frames[1] + 1):
        cleaned = view.source.mask(frame)
        meter.add(cleaned, None if ready else footage.picture(frame))
        progress.advance(frame)
        yield frame, cleaned.mask


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
        MocapError: the take has no footage or names no plate, a picture cannot be read, or no
            frame lies between the first and the last.
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
    if span[0] > span[1]:
        raise MocapError(
            f"there are no frames from {span[0]} to {span[1]}",
            "give frames of the take", file=take.path,
        )  # fmt: skip
    path = Path(for_camera(files.plate, camera))
    write_plate(path, plate_from(footage, span, recipe))
    return path
