"""Ctrl-C and SIGTERM: both end the work the same way, and neither breaks a result being written."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def interruptible() -> Iterator[None]:
    """Within, Ctrl-C and SIGTERM raise KeyboardInterrupt (in the main thread)."""

    def interrupt(number, stack):
        raise KeyboardInterrupt

    with _handled(interrupt):
        yield


@contextmanager
def shielded() -> Iterator[None]:
    """Within, Ctrl-C and SIGTERM wait; afterwards they raise KeyboardInterrupt."""
    waiting = []

    def keep(number, stack):
        waiting.append(number)

    with _handled(keep):
        yield
    if waiting:
        raise KeyboardInterrupt


@contextmanager
def _handled(handler) -> Iterator[None]:
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = [signal.signal(number, handler) for number in _SIGNALS]
    try:
        yield
    finally:
        for number, old in zip(_SIGNALS, before, strict=True):
            # None: set by the program that embeds Python, which cannot be put back
            signal.signal(number, signal.SIG_DFL if old is None else old)
