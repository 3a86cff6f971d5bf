"""take.toml -> Take.

A file may extend another one; tables are merged key by key, the extending file wins, and every
path counts from the file it is written in.
"""

import logging
import os
from fractions import Fraction
from pathlib import Path
from typing import Any

from ..body.rig_file import RigFile
from ..body.templates import TEMPLATES
from ..cameras.calibration import READERS, WORLD_FROM_UP
from ..cameras.units import METRES_PER_UNIT
from ..errors import MocapError
from ..fitting.hierarchical import SETTINGS
from ..fitting.search import TRACKERS, Search
from ..initialisation.plausibility import HEIGHTS_M
from ..toml import read_toml
from .paths import PATH_KEYS, followed, inside, names_files
from .table import Table
from .take import (
    EXPORTS,
    EXTRACTIONS,
    INITIAL_KINDS,
    Adjustment,
    Calibrated,
    FootageFiles,
    InitialPose,
    Performer,
    Take,
)

VERSION = 1
_FRAME_RATES = (0.1, 10_000.0)
_SCALES = (0.01, 100.0)
_LONGEST_NAME = 100
_RIG = ".blend#"
_MEASURED = "measured"
"""Instead of a height: what the silhouettes show."""
_LONGEST_CHAIN = 20
_TOP = (
    "version", "name", "fps", "frames", "initial_pose", "extends", "locks",
    "cameras", "footage", "performer", "world", "fit", "export",
)  # fmt: skip
_log = logging.getLogger(__name__)
_LATER_EXTRACTIONS = ("horprasert", "chroma_key", "mog2", "knn")
_LATER_TRACKERS = ("monte_carlo",)
_LATER_EXPORTS = ("c3d", "glb", "usd")


def read_take(path: str | Path, root: str | Path | None = None) -> Take:
    """The take described by the TOML file ``path``.

    Args:
        path: the file.
        root: the folder that all paths of the take must lie in; by default the folder above the
            file's own folder.

    Raises:
        MocapError: no such file, not TOML, an unknown or missing key, a wrong value, a path outside
            ``root``, or something that is not supported yet.
    """
    path = followed(Path(path))
    top_folder = path.parent.parent if root is None else followed(Path(root))
    inside(path, top_folder, path, "the take itself")
    take = _take(Table(_merged(path, top_folder, ()), path))
    _log.info("take %s from %s; all its files lie in %s", take.name, path, top_folder)
    _log.debug("%s", take)
    return take


def _merged(path: Path, root: Path, above: tuple[Path, ...]) -> dict[str, Any]:
    """The tables of ``path`` over those of the file it extends, paths absolute."""
    if len(above) > _LONGEST_CHAIN:
        problem = f"extends more than {_LONGEST_CHAIN} files in a row"
        raise MocapError(problem, 'remove some of the "extends" keys', file=above[0])
    if path in above:
        raise MocapError("extends itself", 'remove one of the "extends" keys', file=path)
    values = read_toml(path)
    table = Table(values, path)
    table.allow(*_TOP)
    for section, keys in PATH_KEYS.items():
        part = table.table(section) if section else table
        for key in keys:
            text = part.text(key)
            if text is not None:
                part.values[key] = str(inside(text, root, path, f'"{part.key(key)}"'))
    _place_body(table.table("performer"), root)
    base = table.text("extends")
    if base is None:
        return values
    base_path = inside(base, root, path, '"extends"')
    return _over(_merged(base_path, root, (*above, path)), values)


def _over(base: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    merged = dict(base)
    for key, value in values.items():
        below = merged.get(key)
        if isinstance(below, dict) and isinstance(value, dict):
            value = _over(below, value)
        merged[key] = value
    return merged


def _place_body(performer: Table, root: Path) -> None:
    body = performer.text("body")
    if body is None:
        return
    file, mark, armature = body.partition(_RIG)
    if mark:
        file += ".blend"
    if mark or file.endswith(".npz"):
        place = inside(file, root, performer.file, '"performer.body"')
        performer.values["body"] = f"{place}{mark and '#'}{armature}"


def _take(table: Table) -> Take:
    found = table.values.get("version", "none")
    if type(found) is not int or found != VERSION:
        table.fault(f'expected "version" = {VERSION}, got {found}', f"write version = {VERSION}")
    locks = table.text("locks")
    frames = table.frames("frames")
    world, fit, export = (table.table(name) for name in ("world", "fit", "export"))
    world.allow("floor")
    fit.allow("tracker", "setting", "fast_motion")
    export.allow("formats")
    _refuse_later(fit, "tracker", _LATER_TRACKERS, TRACKERS)
    _refuse_later(export, "formats", _LATER_EXPORTS, EXPORTS)
    floor = world.number("floor")
    performer = _performer(table.table("performer"))
    return Take(
        path=table.file,
        name=_name(table),
        fps=_fps(table),
        frames=frames,
        initial_pose=_initial_pose(table.table("initial_pose"), frames, performer),
        cameras=_cameras(table.table("cameras")),
        footage=_footage(table.table("footage")),
        performer=performer,
        floor=0.0 if floor is None else floor,
        search=_search(fit),
        exports=export.words("formats", EXPORTS),
        locks=None if locks is None else Path(locks),
    )


def _search(fit: Table) -> Search:
    search = Search(
        tracker=fit.choice("tracker", TRACKERS, TRACKERS[0]),
        setting=fit.choice("setting", SETTINGS, "robust"),
        fast_motion=fit.flag("fast_motion"),
    )
    for key in ("setting", "fast_motion"):
        if search.tracker != "hierarchical" and key in fit.values:
            fit.fault(
                f'"{fit.key(key)}" belongs to the tracker hierarchical, not to {search.tracker}',
                f'write tracker = "hierarchical", or remove "{key}"',
            )
    return search


def _refuse_later(table: Table, key: str, later: tuple[str, ...], instead: tuple[str, ...]) -> None:
    value = table.values.get(key)
    for word in value if isinstance(value, list) else [value]:
        if word in later:
            choices = ", ".join(instead)
            table.fault(f'"{word}" in "{table.key(key)}" is not supported yet', f"use {choices}")


def _name(table: Table) -> str:
    name = table.text("name")
    if name is None:
        folder = table.file.parent.name
        return folder if names_files(folder) else "take"
    if not names_files(name):
        table.fault(f'"name" = {name!r} cannot name files', "use letters, digits, _ and -")
    if len(name.encode()) > _LONGEST_NAME:
        table.fault(
            f'"name" has {len(name.encode())} bytes, too long to name files',
            f"shorten it to {_LONGEST_NAME}",
        )
    return name


def _fps(table: Table) -> Fraction:
    table.required("fps")
    fps = table.number("fps", *_FRAME_RATES)
    assert fps is not None
    return exact_fps(fps)


def exact_fps(fps: float) -> Fraction:
    """The frame rate that a decimal number stands for; 29.97 is 30000/1001 (NTSC)."""
    ntsc = Fraction(round(fps) * 1000, 1001)
    if fps != round(fps) and round(fps) % 6 == 0 and abs(float(ntsc) - fps) < 0.005:
        return ntsc
    return Fraction(str(fps))


def _initial_pose(
    table: Table, frames: tuple[int, int] | None, performer: Performer
) -> InitialPose:
    table.allow("frames", "kind")
    if not table.values:
        return InitialPose(kind=None)
    usual = "rest" if isinstance(performer.body, RigFile) else "A"
    pose = InitialPose(table.frames("frames"), table.choice("kind", INITIAL_KINDS, usual))
    if frames and pose.frames and not frames[0] <= pose.frames[0] <= pose.frames[1] <= frames[1]:
        table.fault(
            f'"initial_pose.frames" {list(pose.frames)} lies outside "frames" {list(frames)}',
            "give frames of the take",
        )
    return pose


def _cameras(table: Table) -> Calibrated:
    table.allow("calibration", "format", "units", "up", "offsets", "adjust")
    table.refuse("offsets", "cut the footage so that all cameras start together")
    table.required("calibration")
    adjust = table.table("adjust")
    return Calibrated(
        calibration=Path(table.text("calibration") or ""),
        format=table.choice("format", [reader.key for reader in READERS]),
        units=table.choice("units", METRES_PER_UNIT),
        up=table.choice("up", WORLD_FROM_UP),
        adjust={camera: _adjustment(adjust.table(camera)) for camera in adjust.values},
    )


def _adjustment(table: Table) -> Adjustment:
    table.allow("scale", "shift")
    scale, shift = table.number("scale", *_SCALES), table.numbers("shift", 2)
    return Adjustment(1.0 if scale is None else scale, (0.0, 0.0) if shift is None else shift)


def _footage(table: Table) -> FootageFiles:
    table.allow(
        "silhouettes", "video", "plate", "extraction", "ignore", *EXTRACTIONS, *_LATER_EXTRACTIONS
    )
    _refuse_later(table, "extraction", _LATER_EXTRACTIONS, EXTRACTIONS)
    files = {key: table.text(key) for key in PATH_KEYS["footage"]}
    if (files["silhouettes"] is None) == (files["video"] is None):
        table.fault(
            'expected either "silhouettes" or "video" in [footage], got '
            + ("none" if files["video"] is None else "both"),
            "give ready masks, or footage with a plate",
        )
    method = table.choice("extraction", EXTRACTIONS, "statistics")
    for other in (*EXTRACTIONS, *_LATER_EXTRACTIONS):
        if other in table.values and (other != method or files["video"] is None):
            table.fault(
                f"[footage.{other}] is of no use here",
                f"the silhouettes come from {method}"
                if files["video"]
                else "the silhouettes are ready",
            )
    return FootageFiles(**files, extraction=method, extraction_settings=table.table(method).values)


def _performer(table: Table) -> Performer:
    table.allow("body", "height_m")
    body = table.text("body") or "performer"
    measured = table.values.get("height_m") == _MEASURED
    return Performer(
        # paths are absolute by now
        body=_file(body) if os.path.isabs(body) else table.choice("body", TEMPLATES, "performer"),
        height_m=None if measured else table.number("height_m", *HEIGHTS_M),
        measured=measured,
    )


def _file(body: str) -> Path | RigFile:
    file, mark, armature = body.partition(_RIG)
    return RigFile(Path(f"{file}.blend"), armature) if mark else Path(body)
