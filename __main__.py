"""The command line: ``silhouette-mocap`` and ``python -m silhouette_mocap``."""

import sys
from collections.abc import Sequence
from importlib.util import find_spec


def main(argv: Sequence[str] | None = None) -> int:
    """Runs one command and returns its exit code.

    Where Blender can be imported, its exporter is handed to the command; it is loaded only when
    something is exported.
    """
    from .core.cli import main as run

    exporter = None if find_spec("bpy") is None else _export_with_blender
    return run(sys.argv[1:] if argv is None else argv, exporter)


def _export_with_blender(request):
    from .addon.export import export_take

    return export_take(request)


if __name__ == "__main__":
    sys.exit(main())
