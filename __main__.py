"""The command line: ``silhouette-mocap`` and ``python -m silhouette_mocap``."""

import os
import signal
import sys
from contextlib import suppress
from importlib.util import find_spec

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_INTERRUPTED = 130


def main() -> int:
    """Runs the command that the program was started with and returns its exit code.

    Where Blender can be imported, its exporter and its reader of rigs are handed to the command;
    it is loaded only when something is exported or a rig is read.
    """
    # while modules load there is nothing to be saved yet
    _handle(lambda *_: os._exit(_INTERRUPTED))
    from .core.cli import main as run

    means = () if find_spec("bpy") is None else (_export_with_blender, _read_rig_with_blender)
    code = run(sys.argv[1:], *means)
    # what comes while Python shuts down must not change the exit code
    _handle(signal.SIG_IGN)
    if code == _INTERRUPTED:
        # nor must one that Python has taken note of already
        with suppress(OSError, ValueError):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)
    return code


def _handle(handler) -> None:
    for number in _SIGNALS:
        signal.signal(number, handler)


def _export_with_blender(request):
    from .addon.export import export_take

    return export_take(request)


def _read_rig_with_blender(file):
    from .addon.bridge.rig_file import read_rig_file

    return read_rig_file(file)


if __name__ == "__main__":
    sys.exit(main())
