"""One tree of commands, and the meaning of their exit codes (SPEC §9)."""

import argparse
import errno
import logging
import os
from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from ..errors import MocapError
from ..files import unwritable
from .bar import BarConsole, LineConsole
from .console import PROGRAM, Console, PlainConsole, let_go
from .events import JsonConsole
from .failures import internal_fault
from .interrupts import interruptible
from .logs import Log
from .memory import keep_freed_memory
from .options import add_common, asked_progress

if TYPE_CHECKING:
    from ..body.rig_file import RigReader
    from ..motion.export_request import Exporter

DONE, INTERNAL, INPUT, LOST, INTERRUPTED = 0, 1, 2, 3, 130
COMMANDS = {
    "fit": "track the performer of a take and write the motion",
    "initialise": "find the body of the performer, lengths and girths, with pictures of every step",
    "masks": "write the silhouettes of a take as masks and tell how sound they look",
    "plate": "make a plate of the empty scene for each camera from its footage and further stills",
    "clean": "smooth the motion of a fit, fill gaps, hold the feet where they stand, or undo that",
    "export": "write the result of a fit in further formats",
    "score": "measure the error of a motion against a reference, in mm",
    "info": "check everything that fit will meet and say what is missing",
    "bench": "measure how fast energies are on this machine, and how well the trackers hold on",
}
# OpenCV reads it when it is loaded, by the commands: a damaged file may claim any number of pixels
os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(50_000_000))
# matrices here are small: more threads of numpy's own would only wait for each other
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
_DISK_FAULTS = (errno.ENOSPC, errno.EACCES, errno.EROFS, errno.EDQUOT, errno.EPERM)
_log = logging.getLogger(__name__)


def main(
    argv: Sequence[str],
    exporter: "Exporter | None" = None,
    read_rig: "RigReader | None" = None,
) -> int:
    """Runs one command.

    Args:
        argv: the words after the program's name.
        exporter: writes what only Blender can write; None where there is no Blender.
        read_rig: reads what only Blender can read; likewise.

    Returns:
        The exit code: 0 done, 1 internal error, 2 the input is at fault, 3 frames were lost and
        ``--strict`` was given, 130 interrupted.
    """
    keep_freed_memory()
    console = _console(asked_progress(argv))
    with Log(console) as log:

        def command() -> int:
            with interruptible():
                named = _named(argv)
                console.start(named)
                arguments = build_parser(named).parse_args(argv)
                arguments.console, arguments.read_rig = console, read_rig
                log.open(arguments, argv)
                return arguments.run(arguments, exporter)

        code = _exit_code(command, console)
        console.end(code)
    let_go()
    return code


def _exit_code(command: Callable[[], int], console: Console) -> int:
    """What ``command`` returns or its failure means; the console is told of the failure."""
    try:
        return command()
    except SystemExit as stop:
        if isinstance(stop.code, int | None):
            # argparse has answered itself
            return stop.code or DONE
        console.fault(MocapError(str(stop.code)), INTERNAL)
        return INTERNAL
    except MocapError as error:
        console.fault(error, INPUT)
        return INPUT
    except KeyboardInterrupt:
        console.fault(MocapError("interrupted"), INTERRUPTED)
        return INTERRUPTED
    except Exception as error:
        if isinstance(error, OSError) and error.errno in _DISK_FAULTS:
            console.fault(unwritable(error.filename or "the disk", error), INPUT)
            return INPUT
        _log.debug("internal error", exc_info=error)
        console.fault(internal_fault(error), INTERNAL)
        return INTERNAL


def build_parser(named: str | None = None) -> argparse.ArgumentParser:
    """The tree of commands; only the words of the ``named`` one are loaded, which takes a while."""
    parser = _Parser(
        prog=PROGRAM,
        description="Markerless human motion capture from silhouettes.",
        epilog=f"{PROGRAM} COMMAND --help tells more, with an example.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=_version())
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, summary in COMMANDS.items():
        sub = commands.add_parser(name, help=summary, allow_abbrev=False)
        if name == named:
            command = import_module(f".{name}", __package__)
            sub.description = summary[0].upper() + summary[1:] + "."
            sub.epilog = f"example: {command.EXAMPLE}"
            command.add_arguments(sub)
            add_common(sub)
            sub.set_defaults(run=command.run)
    return parser


class _Parser(argparse.ArgumentParser):
    """Tells a wrong word in one line, an empty path among them."""

    def __init__(self, *words, **settings):
        super().__init__(*words, **settings)
        self.register("type", Path, _path)

    def error(self, message: str) -> NoReturn:
        raise MocapError(message, f"see {self.prog} --help")


def _path(text: str) -> Path:
    """The path; an empty one would be the current folder."""
    if not text.strip():
        raise argparse.ArgumentTypeError("expected a path, got nothing")
    return Path(text)


def _console(progress: str | None) -> Console:
    if progress == "json":
        return JsonConsole()
    if progress == "none":
        return PlainConsole()
    console = BarConsole()
    return console if console.stream.isatty() else LineConsole()


def _named(argv: Sequence[str]) -> str | None:
    """The command among the words, where it is one."""
    first = next((word for word in argv if not word.startswith("-")), None)
    return first if first in COMMANDS else None


def _version() -> str:
    try:
        return version("silhouette-mocap")
    except PackageNotFoundError:
        return "not installed"
