"""The command ``blender -b -c silhouette_mocap …``, the same as ``silhouette-mocap …``."""

import bpy

from .preferences import with_preferences

NAME = "silhouette_mocap"

_handles = []


def register():
    """Makes the command known to Blender."""
    _handles.append(bpy.utils.register_cli_command(NAME, _run))


def unregister():
    """Takes the command back."""
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())


def _run(arguments: list[str]) -> int:
    """The exit code; core is imported here, so that Blender starts without it."""
    from ..core.cli import main
    from .bridge.rig_file import read_rig_file
    from .export import export_take

    return main(with_preferences(arguments), export_take, read_rig_file)
