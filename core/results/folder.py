"""One run at a time in a folder."""

import errno
import os
import socket
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from ..errors import MocapError
from ..files import made_folder, unwritable

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

LOCK = ".in_use"
_WITHOUT_LOCKS = (errno.ENOLCK, errno.ENOTSUP, errno.ENOSYS)


@contextmanager
def occupied(folder: Path) -> Iterator[None]:
    """Within, ``folder`` is there, and other runs that ask for it are refused.

    The lock is the system's own: it ends with the process, however that ends. A folder that was
    made here and is still empty at the end goes away again.

    Raises:
        MocapError: the folder cannot be made or written to, or another run occupies it.
    """
    missing = [place for place in (folder, *folder.parents) if not os.path.exists(place)]
    lock = _locked(folder)
    try:
        yield
    finally:
        if sys.platform == "win32":
            lock.close()
        with suppress(OSError):
            Path(lock.name).unlink()
        lock.close()
        with suppress(OSError):
            for place in missing:
                place.rmdir()


def _locked(folder: Path) -> BinaryIO:
    path = folder / LOCK
    while True:
        # the run before may remove the lock, and a folder that it has made, at any time
        made_folder(folder)
        try:
            lock = path.open("r+b" if path.exists() else "w+b")
        except FileNotFoundError:
            continue
        except OSError as error:
            raise unwritable(path.parent, error) from error
        if not _lock(lock):
            holder = lock.read(200).decode("utf-8", "replace").strip()
            lock.close()
            raise MocapError(
                f"another run writes into this folder ({holder or 'just begun'})",
                "wait for it, or give another folder", file=path.parent,
            )  # fmt: skip
        if path.exists() and os.path.samestat(os.fstat(lock.fileno()), path.stat()):
            break
        lock.close()
    lock.truncate()
    holder = f"process {os.getpid()} on {socket.gethostname()} since {time.strftime('%H:%M:%S')}"
    lock.write(holder.encode())
    lock.flush()
    return lock


def _lock(file: BinaryIO) -> bool:
    """Takes the system's lock of an open file; False where another process has it."""
    try:
        if sys.platform == "win32":
            # beyond the text, which others shall be able to read
            file.seek(1 << 20)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
            file.seek(0)
        else:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.seek(0)
        return error.errno in _WITHOUT_LOCKS
    return True
