"""What a Blender file holds, to take back what was added to it for a while."""

import contextlib
from collections.abc import Iterator

import bpy

# shape keys go with their meshes
_NOT_BY_THEMSELVES = frozenset(("shape_keys", "window_managers", "workspaces", "screens"))


@contextlib.contextmanager
def taken_back() -> Iterator[None]:
    """Whatever is added within goes away again."""
    before = set(_everything())
    try:
        yield
    finally:
        bpy.data.batch_remove([block for block in _everything() if block not in before])


def _everything() -> list[bpy.types.ID]:
    kinds = (
        kind.identifier
        for kind in bpy.data.bl_rna.properties
        if kind.type == "COLLECTION" and kind.identifier not in _NOT_BY_THEMSELVES
    )
    return [block for kind in kinds for block in getattr(bpy.data, kind)]
