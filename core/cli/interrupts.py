"""Ctrl-C and SIGTERM: both end the work the same way, and neither breaks a result being written."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def interruptible() -> Iterator[None]:
    """Within, the first Ctrl-C or SIGTERM raises KeyboardInterrupt (in the main thread).

    Whatever follows it is ignored, also afterwards until the program ends: an impatient second
    signal must neither stop the finished frames from being written nor change the exit code.
    """
    interrupts = []

    def interrupt(number, stack):
        interrupts.append(number)
        if len(interrupts) == 1:
            raise KeyboardInterrupt

    before = _set([interrupt] * len(_SIGNALS))
    try:
        yield
    except Exception as error:
        if interrupts:
            # libraries turn it into errors of their own, as numpy does while it is imported
            raise KeyboardInterrupt from error
        raise
    finally:
        _set([signal.SIG_IGN] * len(_SIGNALS) if interrupts else before)


@contextmanager
def shielded() -> Iterator[None]:
    """Within, Ctrl-C and SIGTERM wait; afterwards they do what they would have done."""
    waiting = []

    def keep(number, stack):
        waiting.append(number)

    before = _set([keep] * len(_SIGNALS))
    try:
        yield
    finally:
        _set(before)
        for number in waiting:
            signal.raise_signal(number)


def _set(handlers: list) -> list:
    """Sets the handler of each signal, where that is allowed, and returns those before."""
    if threading.current_thread() is not threading.main_thread():
        return []
    # None: set by the program that embeds Python, which cannot be put back
    return [
        signal.signal(number, signal.SIG_DFL if handler is None else handler)
        for number, handler in zip(_SIGNALS, handlers, strict=True)
    ]
