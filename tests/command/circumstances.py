"""Circumstances in which a command can fail, made by hand: no permission, no space."""

import contextlib
import ctypes
import os
import sys
from collections.abc import Iterator
from pathlib import Path

ON_LINUX = "" if sys.platform == "linux" else "needs Linux"
ON_UNIX = "" if os.name == "posix" else "needs Unix"
_VERSION_3 = 0x20080522


class _Header(ctypes.Structure):
    _fields_ = (("version", ctypes.c_uint32), ("pid", ctypes.c_int))


class _Sets(ctypes.Structure):
    _fields_ = tuple((name, ctypes.c_uint32) for name in ("effective", "permitted", "inherited"))


@contextlib.contextmanager
def bound_by_permissions(folder: Path) -> Iterator[None]:
    """Within, permissions of files hold for root too: this thread's capabilities are put away."""
    libc = ctypes.CDLL(None, use_errno=True)
    header, sets = _Header(_VERSION_3, 0), (_Sets * 2)()
    assert libc.capget(ctypes.byref(header), sets) == 0
    before = [one.effective for one in sets]
    _set_effective(libc, header, sets, [0, 0])
    try:
        yield
    finally:
        _set_effective(libc, header, sets, before)


def _set_effective(libc, header, sets, values) -> None:
    for one, value in zip(sets, values, strict=True):
        one.effective = value
    assert libc.capset(ctypes.byref(header), sets) == 0


@contextlib.contextmanager
def hardly_any_space(folder: Path) -> Iterator[None]:
    """Within, no file can grow beyond 3,000 bytes: what a full disk looks like."""
    import resource

    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
