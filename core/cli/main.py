"""One tree of commands, and the meaning of their exit codes (SPEC §9)."""

import argparse
import errno
import os
import sys
import tempfile
import traceback
from collections.abc import Sequence
from importlib.metadata import PackageNotFoundError, version
from typing import NoReturn

from ..errors import MocapError
from ..files import unwritable
from ..motion.export_request import Exporter
from . import export, fit, info, masks, plate, score
from .console import complain
from .interrupts import interruptible

DONE, INTERNAL, INPUT, LOST, INTERRUPTED = 0, 1, 2, 3, 130
COMMANDS = (fit, masks, plate, export, score, info)
_DISK_FAULTS = (errno.ENOSPC, errno.EACCES, errno.EROFS, errno.EDQUOT, errno.EPERM)


def main(argv: Sequence[str], exporter: Exporter | None = None) -> int:
    """Runs one command.

    Args:
        argv: the words after the program's name.
        exporter: writes what only Blender can write; None where there is no Blender.

    Returns:
        The exit code: 0 done, 1 internal error, 2 the input is at fault, 3 frames were lost and
        ``--strict`` was given, 130 interrupted.
    """
    try:
        arguments = build_parser().parse_args(argv)
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else DONE
    try:
        with interruptible():
            return arguments.run(arguments, exporter)
    except MocapError as error:
        complain(str(error))
        return INPUT
    except KeyboardInterrupt:
        complain("interrupted")
        return INTERRUPTED
    except BrokenPipeError:
        # whoever read the output has enough of it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except Exception as error:
        if isinstance(error, OSError) and error.errno in _DISK_FAULTS:
            complain(str(unwritable(error.filename or "the disk", error)))
            return INPUT
        complain(f"internal error ({error!r}); please send {_written_traceback()} to the makers")
        return INTERNAL


def build_parser() -> argparse.ArgumentParser:
    """The tree of commands."""
    parser = _Parser(
        prog="silhouette-mocap",
        description="Markerless human motion capture from silhouettes.",
        epilog="silhouette-mocap COMMAND --help tells more, with an example.",
    )
    parser.add_argument("--version", action="version", version=_version())
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for command in COMMANDS:
        sub = commands.add_parser(
            command.NAME,
            help=command.SUMMARY,
            description=command.SUMMARY[0].upper() + command.SUMMARY[1:] + ".",
            epilog=f"example: {command.EXAMPLE}",
        )
        command.add_arguments(sub)
        sub.set_defaults(run=command.run)
    return parser


class _Parser(argparse.ArgumentParser):
    """Tells a wrong word in one line."""

    def error(self, message: str) -> NoReturn:
        complain(f"{message}; see {self.prog} --help")
        raise SystemExit(INPUT)


def _version() -> str:
    try:
        return version("silhouette-mocap")
    except PackageNotFoundError:
        return "not installed"


def _written_traceback() -> str:
    with tempfile.NamedTemporaryFile(
        "w", encoding="utf-8", prefix="silhouette_mocap_error_", suffix=".txt", delete=False
    ) as stream:
        stream.write(traceback.format_exc())
    return stream.name
