"""The add-on: everything that imports bpy. Reads the scene, calls core, writes the result back."""


def register():
    """Registers everything the add-on gives Blender."""
    from . import cli, preferences

    preferences.register()
    cli.register()


def unregister():
    """Takes back what `register` gave, in reverse order."""
    from . import cli, preferences

    cli.unregister()
    preferences.unregister()
