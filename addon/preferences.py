"""The add-on's preferences: what holds for all scenes of a user."""

import bpy

_EXTENSION = __package__.rpartition(".")[0]
_AUTOMATIC = "AUTOMATIC"


class SilhouetteMocapPreferences(bpy.types.AddonPreferences):
    """Shown under Preferences, Add-ons."""

    bl_idname = _EXTENSION

    evaluator: bpy.props.EnumProperty(
        name="Evaluator",
        description="What renders the performer and compares silhouettes when a take is fitted",
        items=(
            (_AUTOMATIC, "Automatic", "Whatever is best on this machine"),
            ("NATIVE", "Native", "The processor"),
            ("OPENGL", "OpenGL", "A graphics processor; the native evaluator where there is none"),
        ),
        default=_AUTOMATIC,
    )

    def draw(self, context):
        """The preferences, one below the other."""
        self.layout.use_property_split = True
        self.layout.prop(self, "evaluator")


def register():
    """Makes the preferences known to Blender."""
    bpy.utils.register_class(SilhouetteMocapPreferences)


def unregister():
    """Takes them back."""
    bpy.utils.unregister_class(SilhouetteMocapPreferences)


def with_preferences(words: list[str]) -> list[str]:
    """The words of a command; ``fit`` gets the preferred evaluator unless they name one."""
    command = next((word for word in words if not word.startswith("-")), None)
    named = any(word.split("=")[0] == "--evaluator" for word in words)
    addon = bpy.context.preferences.addons.get(_EXTENSION)
    preferred = addon.preferences.evaluator if addon else _AUTOMATIC
    if command != "fit" or named or preferred == _AUTOMATIC:
        return words
    return [*words, "--evaluator", preferred.lower()]
