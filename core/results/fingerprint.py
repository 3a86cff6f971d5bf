"""What a fit depends on, so that it is continued only where it would have come to the same."""

import hashlib
import json
import os
from collections.abc import Sequence
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path

import numpy as np

from ..body.rig_file import RigFile
from ..errors import MocapError
from ..files import check_ordinary, unreadable
from ..take.take import Take
from ..take.views import View, Views
from .report import versions

Inputs = dict[str, str]
"""Dotted key -> value as JSON, or a digest."""

_DIGEST = "sha256 "
_NAMED_AT_MOST = 3
# they change what is written, not what is fitted; paths are judged by what lies there
_OF_NO_MATTER = ("path", "name", "exports", "search", "frames")


def fit_inputs(take: Take, views: Views, settings: dict[str, object]) -> Inputs:
    """All that decides the poses, but for the footage, which is stamped frame by frame.

    Args:
        take: the take.
        views: its cameras, as they are used.
        settings: what was asked for beside the take.

    Raises:
        MocapError: a file that cannot be read.
    """
    values = {key: value for key, value in asdict(take).items() if key not in _OF_NO_MATTER}
    # not the file: what was read from it, and from whatever else belongs to it
    del values["cameras"]["calibration"]
    body = take.performer.body
    if isinstance(body, Path):
        values["performer"]["body"] = _digest(_contents(body))
    if isinstance(body, RigFile):
        values["performer"]["body"] = _digest(_contents(body.path))
        values["performer"]["armature"] = body.armature
    if take.locks is not None:
        values["locks"] = _digest(_contents(take.locks))
    for key in ("silhouettes", "video", "plate", "ignore"):
        if values["footage"][key]:
            values["footage"][key] = os.path.relpath(values["footage"][key], take.path.parent)
    program = {key: value for key, value in versions().items() if key not in ("python", "machine")}
    asked = {**settings, "frames": list(views.frames)}
    seen: Inputs = {}
    for view in views.views:
        seen |= _view_digests(view)
    return {**_flat({**values, "fit": asked, "program": program}), **seen}


def _view_digests(view: View) -> Inputs:
    """Digests of one camera's calibration, plate and ignore mask, as they were read."""
    camera, source = view.undistortion.source, view.source
    plate = getattr(source.extractor, "plate", None)
    lens = (camera.matrix, camera.camera_from_world, camera.distortion)
    parts = {
        "camera": (*lens, np.array([*camera.size, camera.fisheye])),
        "plate of": () if plate is None else (plate.mean, plate.spread),
        "ignore mask of": () if source.ignore is None else (source.ignore,),
    }
    return {
        f"{part} {camera.name}": _digest(*(np.ascontiguousarray(a).tobytes() for a in arrays))
        for part, arrays in parts.items()
        if arrays
    }


def check_same(before: Inputs, now: Inputs, folder: Path) -> None:
    """Refuses to continue the fit in ``folder`` with other inputs, naming what differs.

    Raises:
        MocapError: something differs.
    """
    keys = [key for key in {**before, **now} if before.get(key) != now.get(key)]
    if not keys:
        return
    told = [_difference(key, before.get(key), now.get(key)) for key in keys[:_NAMED_AT_MOST]]
    more = f" and {len(keys) - len(told)} more" if len(keys) > len(told) else ""
    raise MocapError(
        f"this fit was begun otherwise: {', '.join(told)}{more}",
        "change it back, or leave out --resume to fit all frames anew", file=folder,
    )  # fmt: skip


def stamp_digests(names: Sequence[str], frames: np.ndarray, stamps: np.ndarray) -> Inputs:
    """One digest per camera of what stamps (T, V, 2) its ``frames`` (T,), in any order, had."""
    ordered = stamps[np.argsort(frames)]
    return {
        f"footage of {name}": _digest(np.ascontiguousarray(ordered[:, view]).tobytes())
        for view, name in enumerate(names)
    }


def _difference(key: str, before: str | None, now: str | None) -> str:
    if (before or now or "").startswith(_DIGEST):
        return f"{key} " + (
            "is new" if before is None else "is gone" if now is None else "has changed"
        )
    return f"{key} was {before or 'not given'}, now {now or 'not given'}"


def _digest(*contents: bytes) -> str:
    digest = hashlib.sha256()
    for content in contents:
        digest.update(content)
    return _DIGEST + digest.hexdigest()


def _contents(file: Path) -> bytes:
    check_ordinary(file)
    try:
        return file.read_bytes()
    except OSError as error:
        raise unreadable(file, error) from error


def _flat(values: dict, above: str = "") -> Inputs:
    found: Inputs = {}
    for key, value in values.items():
        if isinstance(value, dict):
            found |= _flat(value, f"{above}{key}.")
        elif value is not None:
            plain = isinstance(value, str | Fraction)
            found[f"{above}{key}"] = str(value) if plain else json.dumps(value)
    return found
