"""The log of a command: what ``--verbose`` tells and ``--log-file`` keeps.

Modules of core log to loggers of their own names and know nothing of handlers. Without either
option nothing of it is shown, Python's warnings and libraries' messages included.
"""

import argparse
import logging
import os
import platform
import re
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TextIO

from ..files import check_replaceable, made_folder, unwritable
from .console import SHOWN, Console

PACKAGE = __name__.removesuffix(".core.cli.logs")
_LOGGERS = (PACKAGE, "py.warnings")
_STDERR = 2
_LINE = "%(asctime)s %(levelname)-7s %(name)s: %(message)s"
_OURS = re.compile(rb"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d,\d{3} [A-Z]+ +\S+: ")
_log = logging.getLogger(__name__)


class Log(ExitStack):
    """Listens while a command runs; nothing is kept until ``open`` is told what to keep.

    Args:
        console: what shows the lines of ``--verbose``.
    """

    def __init__(self, console: Console):
        super().__init__()
        self.console = console
        for name in _LOGGERS:
            self.enter_context(_own_handlers(logging.getLogger(name)))
        logging.captureWarnings(True)
        self.callback(logging.captureWarnings, False)

    def open(self, arguments: argparse.Namespace, argv: Sequence[str]) -> None:
        """Does what ``--verbose`` and ``--log-file`` say.

        Raises:
            MocapError: the log file cannot be written.
        """
        if arguments.verbose:
            self._listen(_Shown(self.console))
        if arguments.log_file is not None:
            self._listen(_opened(arguments.log_file))
        if arguments.log_file is not None or not arguments.verbose:
            self.enter_context(_native_messages_into(arguments.log_file or Path(os.devnull)))
        _log.info("%s", " ".join(argv))
        for fact in _facts() if arguments.log_file is not None else ():
            _log.debug("%s", fact)

    def _listen(self, handler: logging.Handler) -> None:
        for name in _LOGGERS:
            logging.getLogger(name).addHandler(handler)
        self.callback(handler.close)


class _Shown(logging.Handler):
    """Passes messages on to the console, save those that it shows anyway."""

    def __init__(self, console: Console):
        super().__init__(logging.INFO)
        self.console = console
        self.addFilter(lambda record: record.name != SHOWN)

    def emit(self, record: logging.LogRecord) -> None:
        self.console.verbose(record)


class _File(logging.FileHandler):
    """A log file; the work goes on where the disk is full."""

    def handleError(self, record: logging.LogRecord) -> None:
        pass

    def close(self) -> None:
        with suppress(OSError):
            super().close()


def _opened(path: Path) -> _File:
    check_replaceable(path, _OURS)
    made_folder(path.parent)
    try:
        handler = _File(path, encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        raise unwritable(path, error) from error
    handler.setFormatter(logging.Formatter(_LINE))
    return handler


@contextmanager
def _own_handlers(logger: logging.Logger) -> Iterator[None]:
    """Within, the logger tells nobody but the handlers that are added to it."""
    before = logger.level, logger.propagate, logger.handlers[:]
    logger.setLevel(logging.DEBUG)
    logger.propagate = False
    logger.handlers = [logging.NullHandler()]
    try:
        yield
    finally:
        logger.level, logger.propagate, logger.handlers = before
        logger.setLevel(before[0])


def _facts() -> Iterator[str]:
    from ..results.report import versions  # takes a while, and few ask for it

    yield f"process {os.getpid()} in {os.getcwd()}"
    yield f"{platform.platform()}, {os.cpu_count()} processors"
    yield ", ".join(f"{name} {version}" for name, version in versions().items())


@contextmanager
def _native_messages_into(path: Path) -> Iterator[None]:
    """Within, what libraries write to standard error goes to that file; Python's stays.

    OpenCV, FFmpeg and libjpeg tell of damaged files there, beside our own line.
    """
    try:
        kept = os.dup(_STDERR)
    except OSError:
        # standard error is closed
        yield
        return
    own = sys.stderr
    text = {"encoding": own.encoding, "errors": own.errors, "buffering": 1}
    with _kept_open(open(kept, "w", **text)) as stream, path.open("ab") as file:
        if own is sys.__stderr__:
            with suppress(OSError, ValueError):
                own.flush()
            sys.stderr = stream
        os.dup2(file.fileno(), _STDERR)
        try:
            yield
        finally:
            os.dup2(kept, _STDERR)
            sys.stderr = own


@contextmanager
def _kept_open(stream: TextIO) -> Iterator[TextIO]:
    """Closes ``stream`` afterwards, even where what it holds cannot be written any more."""
    try:
        yield stream
    finally:
        with suppress(OSError, ValueError):
            stream.close()
