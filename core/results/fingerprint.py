"""What a fit depends on, so that it is continued only where it would have come to the same."""

import hashlib
import json
import os
from collections.abc import Sequence
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path

import numpy as np

from ..errors import MocapError
from ..footage.patterns import for_camera
from ..take.take import Take
from ..take.views import Views
from .report import versions

Inputs = dict[str, str]
"""Dotted key -> value as JSON, or the digest of a file."""

_DIGEST = "sha256 "
_NAMED_AT_MOST = 3
_LARGEST = 1 << 26
"""Bytes; no calibration, body or plate is as large, but footage may lie beside them."""
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
    values["cameras"]["calibration"] = _digest(take.cameras.calibration)
    if isinstance(take.performer.body, Path):
        values["performer"]["body"] = _digest(take.performer.body)
    for key in ("silhouettes", "video"):
        if values["footage"][key]:
            values["footage"][key] = os.path.relpath(values["footage"][key], take.path.parent)
    for key in ("plate", "ignore"):
        pattern = values["footage"][key]
        if pattern:
            paths = {c.name: Path(for_camera(pattern, c.name)) for c in views.cameras}
            values["footage"][key] = {name: _digest(path) for name, path in paths.items()}
    program = {key: value for key, value in versions().items() if key not in ("python", "machine")}
    cameras = [camera.name for camera in views.cameras]
    asked = {**settings, "frames": list(views.frames), "used_cameras": cameras}
    return _flat({**values, "fit": asked, "program": program})


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
        f"footage of {name}": _DIGEST
        + hashlib.sha256(np.ascontiguousarray(ordered[:, view]).tobytes()).hexdigest()
        for view, name in enumerate(names)
    }


def _difference(key: str, before: str | None, now: str | None) -> str:
    if (before or "").startswith(_DIGEST) and (now or "").startswith(_DIGEST):
        return f"{key} has changed"
    return f"{key} was {before or 'not given'}, now {now or 'not given'}"


def _digest(path: Path) -> str:
    """Of a file, or of the files of a folder with their names."""
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    digest = hashlib.sha256()
    for file in files:
        if file.is_file() and file.stat().st_size < _LARGEST:
            digest.update(file.name.encode())
            digest.update(_contents(file))
    return _DIGEST + digest.hexdigest()


def _contents(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise MocapError(
            f"cannot be read ({error.strerror})", "check the file", file=file
        ) from error


def _flat(values: dict, above: str = "") -> Inputs:
    found: Inputs = {}
    for key, value in values.items():
        if isinstance(value, dict):
            found |= _flat(value, f"{above}{key}.")
        elif value is not None:
            plain = isinstance(value, str | Fraction)
            found[f"{above}{key}"] = str(value) if plain else json.dumps(value)
    return found
