"""What a take is made of: cameras, footage, performer, settings (SPEC §9, take.toml)."""

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from ..body.rig_file import RigFile
from ..fitting.search import Search

INITIAL_KINDS = ("A", "T", "elbows", "rest")
EXTRACTIONS = ("statistics", "difference")
EXPORTS = ("blend", "fbx", "bvh", "trc")


@dataclass(frozen=True)
class InitialPose:
    """Where the take shows a known pose.

    Attributes:
        frames: first and last frame that show it, inclusive; None for the take's first frame.
        kind: ``A``, ``T``, ``elbows`` (upper arms lifted, forearms hanging straight down) or
            ``rest``, the body's own rest pose; None where the take tells nothing, and a frame has
            to be found.
    """

    frames: tuple[int, int] | None = None
    kind: str | None = "A"


@dataclass(frozen=True)
class Adjustment:
    """How one camera's footage differs from what was calibrated.

    A footage pixel is ``scale`` times the calibrated pixel plus ``shift``.
    """

    scale: float = 1.0
    shift: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Calibrated:
    """The calibration file and how to read it.

    Attributes:
        calibration: the file or folder.
        format: the format's name; None to detect it by content.
        units: ``m``, ``cm``, ``mm`` …; None to take the format's own, or guess.
        up: the axis that points up, such as ``z`` or ``-y``; None for the format's own.
        adjust: by camera name.
    """

    calibration: Path
    format: str | None
    units: str | None
    up: str | None
    adjust: dict[str, Adjustment]


@dataclass(frozen=True)
class FootageFiles:
    """Where the pictures are; either ``silhouettes`` or ``video`` is given.

    All are path patterns with ``{camera}`` and, for picture sequences, ``{frame:06d}``.

    Attributes:
        silhouettes: ready masks or mattes, or silhouette videos.
        video: footage in colour.
        plate: pictures of the empty scene.
        extraction: how silhouettes are made from ``video``, one of `EXTRACTIONS`.
        extraction_settings: the method's own settings, by name, unchecked.
        ignore: masks of what says nothing about the performer.
    """

    silhouettes: str | None
    video: str | None
    plate: str | None
    extraction: str
    extraction_settings: dict[str, object]
    ignore: str | None


@dataclass(frozen=True)
class Performer:
    """Who is captured.

    Attributes:
        body: a template's name, the path of a fitted ``body.npz``, or an armature of the user's.
        height_m: standing height; None for that of the body's file, or, of a template, what the
            silhouettes show.
        measured: whether a body from a file takes its size from the silhouettes, too.
    """

    body: str | Path | RigFile
    height_m: float | None
    measured: bool = False


@dataclass(frozen=True)
class Take:
    """One recording: cameras, footage, performer, settings.

    Attributes:
        path: the take.toml it was read from.
        name: names the files of the result.
        fps: frames per second, exact: 29.97 stands for 30000/1001.
        frames: first and last frame, inclusive; None for all of the footage.
        initial_pose: where the take shows a known pose.
        cameras: the calibration.
        footage: the pictures.
        performer: who is captured.
        floor: height of the floor, world metres.
        search: how to track.
        exports: formats that fit writes beside motion.npz, of `EXPORTS`.
        locks: file of poses that are given, see `motion.locks`; None for none.
    """

    path: Path
    name: str
    fps: Fraction
    frames: tuple[int, int] | None
    initial_pose: InitialPose
    cameras: Calibrated
    footage: FootageFiles
    performer: Performer
    floor: float
    search: Search
    exports: tuple[str, ...]
    locks: Path | None = None
