"""A whole take in a scene: cameras, footage, performer and action under one Capture Space."""

from dataclasses import dataclass

import bpy

from ...core.motion.export_request import ExportRequest
from .action import Keys, add_action
from .armature import add_armature
from .cameras import add_camera, look_through
from .footage import show_footage
from .mesh import add_mesh
from .rig_actor import add_actor
from .space import add_capture_space
from .timing import scene_frames


@dataclass(frozen=True, eq=False)
class Performance:
    """What `add_performance` made.

    Attributes:
        space: the empty above it all.
        cameras: in the order of the take.
        armature: the performer, with the take's action.
        meshes: the performer's surface.
    """

    space: bpy.types.Object
    cameras: tuple[bpy.types.Object, ...]
    armature: bpy.types.Object
    meshes: tuple[bpy.types.Object, ...]


def add_performance(scene: bpy.types.Scene, take: ExportRequest) -> Performance:
    """Adds a take to ``scene`` and looks through its first camera.

    The motion is keyed at the scene's rate, which stays as it is.

    Raises:
        MocapError: footage that cannot be opened, or a rig that is gone or changed.
    """
    collection = bpy.data.collections.new(take.name)
    scene.collection.children.link(collection)
    space = add_capture_space(collection)
    cameras = tuple(add_camera(camera, space, collection) for camera in take.cameras)
    for camera, placed in zip(take.cameras, cameras, strict=True):
        if camera.name in take.footage:
            show_footage(placed, take.footage[camera.name], take.motion.frames)
    motion = take.motion
    frames = scene_frames(scene, motion.frames, motion.rate)
    keys = Keys(frames, motion.pose, motion.locked, motion.keyed)
    if take.rig is None:
        armature = add_armature(take.body, take.name, space, collection)
        meshes = (add_mesh(take.body, take.body.surfaces[-1], armature),)
        add_action(armature, take.body, take.name, keys)
    else:
        actor = add_actor(take, keys, space, collection)
        armature, meshes = actor.armature, actor.meshes
    if cameras:
        look_through(scene, cameras[0])
    return Performance(space, cameras, armature, meshes)
