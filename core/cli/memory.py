"""What a command asks of the C library's memory before it begins."""

import ctypes
import sys

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Numbers of glibc's options (malloc.h)."""
_KEPT, _LARGE = 256 << 20, 32 << 20


def keep_freed_memory() -> None:
    """Has glibc keep what is freed for the next frame, up to 256 MB; elsewhere nothing changes.

    It hands large pieces back at once, and the system clears each page again when a frame asks for
    it: that takes a quarter of a fit's time.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None) if sys.platform == "linux" else None
    if mallopt is not None:
        mallopt(_MMAP_THRESHOLD, _LARGE)
        mallopt(_TRIM_THRESHOLD, _KEPT)
