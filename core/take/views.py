"""What the cameras of a take see: calibration and footage brought together, camera by camera."""

import logging
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from ..cameras.adjustment import adjusted, matched_to_footage, observed_pixels
from ..cameras.arrangement import opposite_pairs
from ..cameras.calibration import (
    Calibration,
    CalibrationSettings,
    read_calibration,
    read_camera_names,
)
from ..cameras.camera import Camera
from ..cameras.undistortion import Undistortion
from ..errors import MocapError
from ..footage.footage import Footage, open_footage
from ..footage.patterns import for_camera
from ..footage.pictures import colour_picture, read_picture
from ..footage.video import Video
from ..progress import SILENCE, Progress
from ..rendering.model import GUARD_PX
from ..silhouettes.cleaning import Cleaning
from ..silhouettes.difference import Difference, DifferenceSettings
from ..silhouettes.masks import ReadyMasks, mask_from_picture
from ..silhouettes.plate import Plate, read_plate
from ..silhouettes.silhouette import Silhouette
from ..silhouettes.source import Extractor, SilhouetteSource
from ..silhouettes.statistics import Statistics, StatisticsSettings
from .paths import names_files
from .reduction import Reduction, fitting_reduction
from .table import Table
from .take import Take

_log = logging.getLogger(__name__)
_FEWEST_CAMERAS = 2


@dataclass(frozen=True, eq=False)
class View:
    """One camera of a take.

    Attributes:
        place: path of the footage: a video or folder, or a pattern with ``{frame}``.
        source: its silhouettes, at the footage's resolution, without lens distortion.
        undistortion: from the footage's camera to a pinhole camera.
        reduction: from that pinhole camera to the one that is tracked with.
    """

    place: str
    source: SilhouetteSource
    undistortion: Undistortion
    reduction: Reduction

    @property
    def camera(self) -> Camera:
        """The pinhole camera that is tracked with."""
        return self.reduction.camera(self.undistortion.camera)

    def silhouette(self, frame: int) -> Silhouette:
        """What ``camera`` sees in ``frame``."""
        return self.reduction.silhouette(self.source.read(frame))

    def picture(self, frame: int) -> np.ndarray:
        """(H, W, 3) uint8 BGR footage as ``camera`` sees it."""
        picture = colour_picture(self.source.footage.picture(frame))
        return self.reduction.picture(self.undistortion.undistorted(picture))


@dataclass(frozen=True, eq=False)
class Views:
    """All cameras of a take that are used.

    Attributes:
        views: in the order of the cameras' names.
        frames: first and last frame, inclusive.
        notes: sentences about calibration and footage that the user should see.
        calibration: theirs, as it was read.
    """

    views: tuple[View, ...]
    frames: tuple[int, int]
    notes: tuple[str, ...]
    calibration: Calibration

    @property
    def cameras(self) -> tuple[Camera, ...]:
        """The pinhole cameras that are tracked with."""
        return tuple(view.camera for view in self.views)

    def silhouettes(self, frame: int) -> tuple[Silhouette, ...]:
        """What the cameras see in ``frame``; read side by side, as each has its own footage."""
        return tuple(self._readers.map(lambda view: view.silhouette(frame), self.views))

    def pictures(self, frame: int) -> tuple[np.ndarray, ...]:
        """V pictures (H, W, 3) uint8 BGR of ``frame`` as the cameras see it, read likewise."""
        return tuple(self._readers.map(lambda view: view.picture(frame), self.views))

    @cached_property
    def _readers(self) -> ThreadPoolExecutor:
        """Threads that stay: new ones for every frame would scatter their memory."""
        return ThreadPoolExecutor(len(self.views))

    def stamps(self, frame: int) -> np.ndarray:
        """(V, 2) size and time of change of the files that ``frame`` is read from."""
        return np.array([view.source.footage.stamp(frame) for view in self.views], np.int64)

    def reduced_and_seen(
        self, frames: Sequence[int]
    ) -> tuple["Views", dict[int, tuple[Silhouette, ...]]]:
        """The views at the resolution that fits the performer's size in ``frames``.

        And what those views see, by frame; the views are unreduced so far.
        """
        seen = {frame: self.silhouettes(frame) for frame in frames}
        by_view = zip(*seen.values(), strict=True)
        reduced = self.reduced_by([fitting_reduction(found).factor for found in by_view])
        return reduced, {
            frame: tuple(
                view.reduction.silhouette(silhouette)
                for view, silhouette in zip(reduced.views, silhouettes, strict=True)
            )
            for frame, silhouettes in seen.items()
        }

    def reduced_by(self, factors: Sequence[int]) -> "Views":
        """The views with pictures reduced by one whole factor each.

        Raises:
            MocapError: pictures that are still larger than what can be drawn.
        """
        views = [
            replace(view, reduction=Reduction(factor))
            for view, factor in zip(self.views, factors, strict=True)
        ]
        for view in views:
            _check_drawable(view)
        sizes = (f"{view.camera.name} {'{} x {}'.format(*view.camera.size)}" for view in views)
        _log.info("tracked at px: %s", ", ".join(sizes))
        return replace(self, views=tuple(views))


def _check_drawable(view: View) -> None:
    width, height = view.camera.size
    if max(width, height) > GUARD_PX:
        raise MocapError(
            f"would be tracked at {width} x {height} px, and at most {GUARD_PX:.0f} can be drawn",
            "make the footage smaller, and calibrate it anew or name its scale under [cameras] "
            "adjust",
            file=view.place, camera=view.camera.name,
        )  # fmt: skip


class TooFewCameras(MocapError):
    """Too many cameras are left out."""


def open_views(
    take: Take,
    without: Sequence[str] = (),
    frames: tuple[int | None, int | None] = (None, None),
    progress: Progress = SILENCE,
) -> Views:
    """The views of ``take``, ready to be read at full resolution.

    Args:
        take: the take.
        without: names of cameras to leave out.
        frames: first and last frame, inclusive, that narrow the take's; None leaves an end.
        progress: told while the frames of videos are counted.

    Raises:
        MocapError: calibration or footage that is missing or does not fit, an unknown camera, or
            fewer than two cameras.
    """
    used = _used_names(take, without)
    _check_patterns(take)
    pattern = footage_pattern(take)
    span = None if take.frames is None else narrowed(take, take.frames, frames)
    footage = {name: open_footage(pattern, name, span) for name in used}
    if len(used) < _FEWEST_CAMERAS:
        count = f"{len(used)} camera{'s' * (len(used) != 1)} left"
        raise TooFewCameras(count, f"use at least {_FEWEST_CAMERAS}", file=take.path)
    sizes = {name: f.size for name, f in footage.items()}
    settings = replace(_calibration_settings(take), sizes=sizes, only=used)
    calibration = read_calibration(take.cameras.calibration, settings)
    cameras = calibration.cameras
    views = tuple(_view(take, camera, footage[camera.name]) for camera in cameras)
    notes = [*calibration.notes, *_opposite_notes(cameras), *_rate_notes(take, footage)]
    if span is None:
        _count(footage, progress)
        span = narrowed(take, _common(take, footage), frames)
    return Views(views, span, tuple(notes), calibration)


def camera_names(take: Take) -> tuple[str, ...]:
    """The names of all calibrated cameras."""
    return tuple(read_camera_names(take.cameras.calibration, _calibration_settings(take)))


def _calibration_settings(take: Take) -> CalibrationSettings:
    return CalibrationSettings(take.cameras.format, take.cameras.units, take.cameras.up)


def footage_pattern(take: Take) -> str:
    """Where the pictures of all cameras are."""
    return take.footage.silhouettes or take.footage.video or ""


def _check_patterns(take: Take) -> None:
    for key in ("silhouettes", "video", "plate"):
        pattern = getattr(take.footage, key)
        if pattern is not None and for_camera(pattern, "") == pattern:
            raise MocapError(
                f'"footage.{key}" gives all cameras the same pictures',
                "write {camera} where the cameras' names stand in the path", file=take.path,
            )  # fmt: skip


def _used_names(take: Take, without: Sequence[str]) -> tuple[str, ...]:
    names = camera_names(take)
    for name in names:
        if not names_files(name):
            raise MocapError(
                f"a camera called {name!r} cannot name files", "rename it",
                file=take.cameras.calibration,
            )  # fmt: skip
    if len(names) < _FEWEST_CAMERAS:
        raise MocapError(
            f"holds only 1 camera, {names[0]}", f"calibrate at least {_FEWEST_CAMERAS}",
            file=take.cameras.calibration,
        )  # fmt: skip
    check_cameras((*without, *take.cameras.adjust), names, take.path)
    return tuple(name for name in names if name not in without)


def check_cameras(wanted: Iterable[str], names: Sequence[str], file: Path) -> None:
    """Refuses a ``wanted`` camera that is not among the calibrated ``names``.

    Raises:
        MocapError: ``file`` names one that is not.
    """
    for name in wanted:
        if name not in names:
            raise MocapError(
                f'there is no camera "{name}"', f"the cameras are {', '.join(names)}", file=file
            )


def _view(take: Take, calibrated: Camera, footage: Footage) -> View:
    name, size = calibrated.name, footage.size
    ignored = np.zeros(size[::-1], bool)
    adjustment = take.cameras.adjust.get(name)
    if adjustment is None:
        camera = matched_to_footage(calibrated, size, for_camera(footage_pattern(take), name))
    else:
        change = (adjustment.scale, adjustment.shift)
        camera = adjusted(calibrated, *change, size)
        ignored |= ~observed_pixels(calibrated.size, *change, size)
    if take.footage.ignore is not None:
        ignored |= _ignore_mask(take.footage.ignore, name, size)
    undistortion = _undistortion(take, camera)
    _log.info(
        "camera %s: focal length %.1f px, centre %s m, %s",
        name, camera.matrix[0, 0], camera.centre.round(3).tolist(),
        "no lens distortion" if undistortion.is_identity else "lens distortion taken out",
    )  # fmt: skip
    source = SilhouetteSource(
        footage=footage,
        extractor=_extractor(take, footage),
        cleaning=Cleaning(),
        ignore=ignored if ignored.any() else None,
        rectifier=None if undistortion.is_identity else undistortion,
    )
    return View(for_camera(footage_pattern(take), name), source, undistortion, Reduction())


def _undistortion(take: Take, camera: Camera) -> Undistortion:
    try:
        return Undistortion(camera)
    except MocapError as error:
        raise error.about(take.cameras.calibration) from error


def _ignore_mask(pattern: str, camera: str, size: tuple[int, int]) -> np.ndarray:
    path = Path(for_camera(pattern, camera))
    mask = mask_from_picture(read_picture(path, camera))
    if mask.shape != size[::-1]:
        raise MocapError(
            f"is {mask.shape[1]} x {mask.shape[0]} px, the footage {size[0]} x {size[1]} px",
            "paint it over a frame of the footage", file=path, camera=camera,
        )  # fmt: skip
    if mask.all():
        raise MocapError(
            "hides everything", "paint white only what is not to be trusted",
            file=path, camera=camera,
        )  # fmt: skip
    return mask


def _extractor(take: Take, footage: Footage) -> Extractor:
    files = take.footage
    if files.video is None:
        return ReadyMasks(footage.lossy)
    if files.plate is None:
        raise MocapError(
            f'"footage.plate" is missing, which "{files.extraction}" needs',
            "film the empty scene, or make one with the plate command", file=take.path,
        )  # fmt: skip
    plate = read_plate(files.plate, footage.camera)
    if plate.size != footage.size:
        raise MocapError(
            f"the plate is {plate.size[0]} x {plate.size[1]} px, the footage "
            f"{footage.size[0]} x {footage.size[1]} px",
            "make it from the footage's own camera", file=for_camera(files.plate, footage.camera),
            camera=footage.camera,
        )  # fmt: skip
    table = Table(files.extraction_settings, take.path, f"footage.{files.extraction}")
    return EXTRACTORS[files.extraction](plate, table)


EXTRACTORS: dict[str, Callable[[Plate, Table], Extractor]] = {
    "statistics": lambda plate, table: Statistics(plate, table.settings(StatisticsSettings)),
    "difference": lambda plate, table: Difference(plate, table.settings(DifferenceSettings)),
}


def _count(footage: dict[str, Footage], progress: Progress) -> None:
    """Finds the ends of the videos, all at once, as each has to be decoded for it."""
    videos = [f for f in footage.values() if isinstance(f, Video)]
    if not videos:
        return
    progress.begin("count frames", len(videos))
    with ThreadPoolExecutor(len(videos)) as pool:
        for _ in pool.map(lambda video: video.frames, videos):
            progress.advance(None)


def _common(take: Take, footage: dict[str, Footage]) -> tuple[int, int]:
    """First and last frame, inclusive, that all cameras filmed."""
    firsts = {name: f.frames[0] for name, f in footage.items()}
    lasts = {name: f.frames[-1] for name, f in footage.items()}
    late, early = max(firsts, key=firsts.__getitem__), min(lasts, key=lasts.__getitem__)
    if firsts[late] > lasts[early]:
        raise MocapError(
            f"no frame is common to all: footage of {early} ends with frame {lasts[early]}, that "
            f"of {late} begins with {firsts[late]}",
            "renumber it so that one number is one moment", file=take.path,
        )  # fmt: skip
    return firsts[late], lasts[early]


def narrowed(
    take: Take, whole: tuple[int, int], wanted: tuple[int | None, int | None]
) -> tuple[int, int]:
    """First and last frame, inclusive, that are ``wanted`` of the ``whole`` take.

    Raises:
        MocapError: they lie outside, or the first comes after the last.
    """
    first, last = whole
    begin = first if wanted[0] is None else wanted[0]
    end = last if wanted[1] is None else wanted[1]
    if None not in wanted and begin > end:
        raise MocapError(
            f"the first frame wanted, {begin}, comes after the last, {end}", "swap them"
        )
    if not first <= begin <= end <= last:
        raise MocapError(
            f"frames {begin} to {end} lie outside the take's, {first} to {last}",
            "give frames of the take", file=take.path,
        )  # fmt: skip
    return begin, end


def _opposite_notes(cameras: Sequence[Camera]) -> list[str]:
    return [
        f"cameras {first} and {second} face each other and see nearly mirrored silhouettes"
        for first, second in opposite_pairs(cameras)
    ]


def _rate_notes(take: Take, footage: dict[str, Footage]) -> list[str]:
    rates = {name: f.fps for name, f in footage.items() if f.fps is not None}
    return [
        f"camera {name} says {rate:.2f} frames per second, the take {float(take.fps):.2f}"
        for name, rate in rates.items()
        if abs(rate - float(take.fps)) > 0.01 * float(take.fps)
    ]
