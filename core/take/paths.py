"""Where the paths of a take may lead: nowhere outside its root folder."""

import os
import re
from pathlib import Path

from ..errors import MocapError

_PLACEHOLDER = re.compile(r"\{(camera|frame)")
_NO_NAME = re.compile(r'[/\\:*?"<>|]')
# keys that hold paths or path patterns, by table
PATH_KEYS = {
    "": ("locks",),
    "cameras": ("calibration",),
    "footage": ("silhouettes", "video", "plate", "ignore"),
}


def names_files(name: str) -> bool:
    """Whether files and folders can be called so, on every system."""
    return (
        name not in ("", ".", "..")
        and name == name.strip()
        and name.isprintable()
        and not _NO_NAME.search(name)
    )


def followed(path: Path) -> Path:
    """``path`` made absolute, links followed as far as they lead anywhere."""
    # Path.resolve fails on links that lead in a circle and on names that are too long
    return Path(os.path.realpath(path))


def inside(path: str | Path, root: Path, file: Path, what: str) -> Path:
    """The absolute path, links followed, of ``path`` as written in ``file``.

    Path patterns keep their placeholders; links are followed in the part before them. ``what``
    says in a message what leads there.

    Raises:
        MocapError: it lies outside ``root``, links lead in a circle, or no file can be called so.
    """
    if "\0" in str(path):
        raise MocapError(f"{what} holds a NUL character", "remove it", file=file)
    full = os.path.normpath(file.parent / path)
    hit = _PLACEHOLDER.search(full)
    fixed = full[: hit.start()].rpartition(os.sep)[0] if hit else full
    resolved = followed(Path(fixed))
    if os.path.islink(resolved):
        raise MocapError(f"{what} leads to a loop of links, {resolved}", "mend them", file=file)
    if not resolved.is_relative_to(root):
        raise MocapError(
            f"{what} leads to {resolved}, outside {root}",
            "move the files, or give the folder that holds both with --root",
            file=file,
        )
    return Path(str(resolved) + full[len(fixed) :])
