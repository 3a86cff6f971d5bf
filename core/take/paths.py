"""Where the paths of a take may lead: nowhere outside its root folder."""

import os
import re
from pathlib import Path

from ..errors import MocapError

_PLACEHOLDER = re.compile(r"\{(camera|frame)")
# keys that hold paths or path patterns, by table
PATH_KEYS = {
    "": ("locks",),
    "cameras": ("calibration",),
    "footage": ("silhouettes", "video", "plate", "ignore"),
}


def inside(path: str | Path, root: Path, file: Path, key: str) -> Path:
    """The absolute path, links followed, of ``path`` as written in ``file``.

    Path patterns keep their placeholders; links are followed in the part before them.

    Raises:
        MocapError: it lies outside ``root``, or no file can be called so.
    """
    if "\0" in str(path):
        raise MocapError(f'"{key}" holds a NUL character', "remove it", file=file)
    full = os.path.normpath(file.parent / path)
    hit = _PLACEHOLDER.search(full)
    fixed = full[: hit.start()].rpartition(os.sep)[0] if hit else full
    resolved = Path(fixed).resolve()
    if not resolved.is_relative_to(root):
        raise MocapError(
            f'"{key}" leads to {resolved}, outside {root}',
            "move the files, or give the folder that holds both with --root",
            file=file,
        )
    return Path(str(resolved) + full[len(fixed) :])
