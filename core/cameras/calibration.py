"""Reading the cameras of a take from a calibration file of any known format.

The format is found by content, never by suffix. Units and "up" are what files leave open most
often: millimetres or metres are guessed from how far apart the cameras stand, and said; both can
be overridden. The result is always metres, Z up, OpenCV axes (FORMATS).
"""

import logging
import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..errors import MocapError
from ..files import check_ordinary
from .camera import Camera
from .readers import anipose_toml, opencv_yml, qualisys_qca
from .readers.file_camera import FileCamera, FileContent, Reader
from .units import METRES_PER_UNIT, Placing

READERS: tuple[Reader, ...] = (
    anipose_toml.READER,
    qualisys_qca.READER,
    opencv_yml.READER,
)
_FOCAL_WIDTHS = (0.05, 1000.0)
_MOST_BYTES = 8 * 2**20
_log = logging.getLogger(__name__)
WORLD_FROM_UP = {
    "z": np.eye(3),
    "-z": np.diag([1.0, -1.0, -1.0]),
    "y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "-y": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    "x": np.array([[0.0, 0, -1], [0, 1, 0], [1, 0, 0]]),
    "-x": np.array([[0.0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
}


@dataclass(frozen=True)
class CalibrationSettings:
    """What the user knows better than the file.

    Attributes:
        format: a reader's key ("toml", …); None detects it.
        units: "m", "cm" or "mm"; None takes the format's own or guesses.
        up: the file's axis that points up: "z", "-z", "y", "-y", "x", "-x"; None means "z".
        sizes: (width, height) in px by camera name, for formats that do not tell.
        only: names of the cameras to keep, so that the others need no size; None keeps all.
    """

    format: str | None = None
    units: str | None = None
    up: str | None = None
    sizes: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    only: Collection[str] | None = None

    def __post_init__(self):
        _expect_one_of("format", self.format, [reader.key for reader in READERS])
        _expect_one_of("units", self.units, METRES_PER_UNIT)
        _expect_one_of("up", self.up, WORLD_FROM_UP)


@dataclass(frozen=True, eq=False)
class Calibration:
    """The cameras of a take.

    Attributes:
        cameras: in natural order of their names (cam_2 before cam_10).
        format: title of the file's format.
        units: the file's unit of length: "m", "cm" or "mm".
        units_guessed: whether that unit was guessed from the cameras' distances.
        notes: sentences that the user should see.
    """

    cameras: tuple[Camera, ...]
    format: str
    units: str
    units_guessed: bool
    notes: tuple[str, ...]


def read_calibration(path: str | Path, settings: CalibrationSettings | None = None) -> Calibration:
    """The calibrated cameras of a file (or folder, where the format is one), in metres, Z up.

    Raises:
        MocapError: no such file, an unknown format, or a camera that cannot be used; the line
            names file, camera, key and remedy.
    """
    path, settings = _file(Path(path)), settings or CalibrationSettings()
    reader = _reader(path, settings.format)
    content = _checked_content(path, reader)
    kept = [c for c in content.cameras if settings.only is None or c.name in settings.only]
    placing = _placing(kept)
    units, guessed = _units(reader, placing, settings.units)
    placing.check(units, path)
    cameras = tuple(
        _metric_camera(path, camera, METRES_PER_UNIT[units], settings) for camera in kept
    )
    notes = list(content.notes)
    if guessed:
        notes.append(_unit_note(placing, units))
    if settings.up is None:
        notes.extend(_up_notes(cameras))
    how = "guessed" if guessed else "known"
    _log.info(
        "calibration %s: %s, %d cameras, in %s (%s)", path, reader.title, len(cameras), units, how
    )
    return Calibration(cameras, reader.title, units, guessed, tuple(notes))


def read_camera_names(
    path: str | Path, settings: CalibrationSettings | None = None
) -> tuple[str, ...]:
    """The names of the cameras in natural order, for finding footage before sizes are known.

    Raises:
        MocapError: as :func:`read_calibration`, save for a missing size.
    """
    path, settings = _file(Path(path)), settings or CalibrationSettings()
    content = _checked_content(path, _reader(path, settings.format))
    return tuple(camera.name for camera in content.cameras)


def natural_key(name: str) -> list[tuple[bool, int, str]]:
    """Sort key under which cam_2 comes before cam_10."""
    parts = re.findall(r"\d+|\D+", name)
    return [(not p.isdecimal(), int(p) if p.isdecimal() else 0, p) for p in parts]


def _expect_one_of(key: str, value: str | None, known) -> None:
    if value is not None and value not in known:
        raise MocapError(f"unknown {key} {value!r} of a calibration", f"use {', '.join(known)}")


def _file(path: Path) -> Path:
    """The file to read where ``path`` may be the folder of a pair intri.yml, extri.yml."""
    if not path.is_dir():
        return path
    file = path / "intri.yml"
    if not file.exists():
        raise MocapError(
            "this folder holds no intri.yml", "name the calibration file itself", file=path
        )
    return file


def _reader(path: Path, key: str | None) -> Reader:
    content = _first_bytes(path)
    if key is not None:
        return next(reader for reader in READERS if reader.key == key)
    for reader in READERS:
        if reader.recognises(content):
            return reader
    known = "; ".join(f"{reader.title} ({reader.key})" for reader in READERS)
    raise MocapError("unknown calibration format", f"known formats are {known}", file=path)


def _first_bytes(path: Path) -> bytes:
    check_ordinary(path)
    try:
        if path.stat().st_size > _MOST_BYTES:
            raise MocapError("is too large for a calibration", "check the path", file=path)
        content = path.read_bytes()
    except OSError as error:
        raise MocapError(
            f"calibration cannot be read ({error.strerror})",
            "check the path given in [cameras] calibration",
            file=path,
        ) from None
    if not content.strip():
        raise MocapError("calibration is empty", "export it again", file=path)
    return content


def _checked_content(path: Path, reader: Reader) -> FileContent:
    content = reader.read(path)
    if not content.cameras:
        raise MocapError(
            f"no camera in this {reader.title} file", "export it again with its cameras", file=path
        )
    name, count = Counter(camera.name for camera in content.cameras).most_common(1)[0]
    if count > 1:
        raise MocapError(
            f"{count} cameras are called {name!r}", "give each its own name", file=path
        )
    ordered = sorted(content.cameras, key=lambda camera: natural_key(camera.name))
    return FileContent(tuple(ordered), content.notes)


def _placing(cameras: Sequence[FileCamera]) -> Placing:
    centres = [-camera.rotation.T @ camera.translation for camera in cameras]
    return Placing(tuple(camera.name for camera in cameras), np.array(centres).reshape(-1, 3))


def _units(reader: Reader, placing: Placing, wanted: str | None) -> tuple[str, bool]:
    if wanted is not None:
        return wanted, False
    if reader.metres_per_unit is not None:
        return next(u for u, m in METRES_PER_UNIT.items() if m == reader.metres_per_unit), False
    return placing.guessed_unit(), True


def _unit_note(placing: Placing, units: str) -> str:
    return (
        f"units are taken as {units}, which puts the cameras "
        f"{placing.spread * METRES_PER_UNIT[units]:.2f} m apart; "
        'set units = "m", "cm" or "mm" if that is wrong'
    )


def _up_notes(cameras: tuple[Camera, ...]) -> list[str]:
    """A hint where most pictures stand upright along another axis than +Z."""
    mean_up = np.mean([-camera.rotation[1] for camera in cameras], axis=0)
    axis = int(np.argmax(np.abs(mean_up)))
    name = ("-" if mean_up[axis] < 0 else "") + "xyz"[axis]
    if name == "z" or abs(mean_up[axis]) < 0.6:
        return []
    return [
        f'the pictures stand upright along {name}, not z; set up = "{name}" unless the cameras '
        "were mounted turned"
    ]


def _metric_camera(
    path: Path, camera: FileCamera, metres_per_unit: float, settings: CalibrationSettings
) -> Camera:
    size = camera.size or settings.sizes.get(camera.name)
    if size is None:
        raise MocapError(
            "the calibration does not tell the size of the pictures",
            "add it to the file, or give the footage's size",
            file=path,
            camera=camera.name,
        )
    _check_focal_length(path, camera, size[0])
    rotation = camera.rotation @ WORLD_FROM_UP[settings.up or "z"].T
    return Camera(
        name=camera.name,
        size=size,
        matrix=camera.matrix,
        camera_from_world=np.column_stack([rotation, camera.translation * metres_per_unit]),
        distortion=camera.distortion,
        fisheye=camera.fisheye,
    )


def _check_focal_length(path: Path, camera: FileCamera, width: int) -> None:
    """Refuses focal lengths that no lens has, in widths of the picture."""
    focal = camera.matrix[0, 0]
    shortest, longest = _FOCAL_WIDTHS
    if not shortest * width <= focal <= longest * width:
        raise MocapError(
            f"matrix has a focal length of {focal:g} px for pictures {width} px wide",
            "give it in px, or calibrate this camera again",
            file=path,
            camera=camera.name,
        )
