"""Arrays by name, as stored in .npz files."""

import io
import zlib
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from ..errors import MocapError
from ..files import check_ordinary, unreadable, whole_file

# what numpy and zipfile raise on files that are cut short, changed or of another kind
_DAMAGE = (OSError, ValueError, EOFError, TypeError, RuntimeError, BadZipFile, zlib.error)


def write_archive(path: Path, **arrays) -> None:
    """Writes arrays by name to the .npz file ``path``, whole or not at all; equal ones equally.

    Raises:
        MocapError: it cannot be written.
    """
    # zipfile complains of a full disk once more on standard error when it writes to the disk itself
    memory = io.BytesIO()
    np.savez_compressed(memory, **arrays)
    with whole_file(path) as partial:
        partial.write_bytes(memory.getvalue())


def read_archive(path: Path, kind: str, remedy: str) -> dict[str, np.ndarray]:
    """All arrays of the .npz file ``path``; nothing is unpickled.

    Args:
        path: the file.
        kind: what it should be, for the message.
        remedy: what to advise when it is something else or damaged.

    Raises:
        MocapError: no such file, or no archive that can be read as a whole.
    """
    check_ordinary(path)
    try:
        with np.load(path, allow_pickle=False) as data:
            return {name: data[name] for name in data.files}
    except FileNotFoundError as error:
        raise unreadable(path, error) from error
    except _DAMAGE as error:
        raise MocapError(f"cannot be read as {kind}", remedy, file=path) from error
