"""The command line: ``silhouette-mocap``, ``python -m silhouette_mocap`` and Blender's ``-c``."""

import sys
from collections.abc import Sequence
from importlib.util import find_spec


def main(argv: Sequence[str] | None = None) -> int:
    """Runs one command and returns its exit code.

    Where Blender can be imported, its exporter is handed to the command; the rest needs no Blender.
    """
    from .core.cli import main as run

    export = None
    if find_spec("bpy") is not None:
        from .addon.export import export_motion as export
    return run(sys.argv[1:] if argv is None else argv, export)


if __name__ == "__main__":
    sys.exit(main())
