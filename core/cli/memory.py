"""What a command asks of the C library's memory before it begins."""

import ctypes
import sys

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
"""Numbers of glibc's options (malloc.h)."""
_KEPT, _LARGE = 64 << 20, 4 << 20


def keep_freed_memory() -> None:
    """Has glibc keep freed pieces of up to 4 MB for the next frame, up to 64 MB of them.

    It would hand them back at once, and the system clears each page again when a frame asks for it:
    that takes a quarter of a fit's time. Larger ones are as long as the take, and go. Elsewhere
    nothing changes.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None) if sys.platform == "linux" else None
    if mallopt is not None:
        mallopt(_MMAP_THRESHOLD, _LARGE)
        mallopt(_TRIM_THRESHOLD, _KEPT)
