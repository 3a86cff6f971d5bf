"""Silhouette Mocap: markerless human motion capture from silhouettes.

Inside Blender this package is the extension; everything of it is imported when Blender registers
the add-on, so that ``silhouette_mocap.core`` works without Blender.
"""


def register():
    """Registers the add-on's classes and commands; called by Blender."""
    from . import addon

    addon.register()


def unregister():
    """Takes back what `register` did; called by Blender."""
    from . import addon

    addon.unregister()
