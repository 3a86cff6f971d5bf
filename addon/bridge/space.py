"""The empty that carries a take: move, turn or scale it to place the performer on a set."""

import bpy

NAME = "Capture Space"


def add_capture_space(collection: bpy.types.Collection) -> bpy.types.Object:
    """A new empty at the world's origin, to be the parent of cameras and performer."""
    empty = bpy.data.objects.new(NAME, None)
    empty.empty_display_type = "ARROWS"
    empty.empty_display_size = 0.5
    collection.objects.link(empty)
    return empty
