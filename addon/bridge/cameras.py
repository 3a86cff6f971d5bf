"""Cameras of a take as Blender cameras.

Blender's camera looks along -Z with Y up, OpenCV's along +Z with Y down: a half turn about X lies
between them. Blender measures the picture by its edges, OpenCV by the centres of pixels: half a
pixel lies between those. With the principal point (cx, cy) taken from the edges,

    lens = fx sensor_width / w,  shift_x = (w / 2 - cx) / w,  shift_y = (cy - h / 2) (fx / fy) / w.

Size and pixel aspect belong to the scene in Blender. They are kept on the camera, and
`look_through` sets them; a camera with fx != fy is exact with the pixel aspect it brings.
"""

import bpy
import numpy as np
from mathutils import Matrix

from ...core.cameras.camera import Camera

SIZE = "capture_size"
PIXEL_ASPECT = "capture_pixel_aspect"
_HALF_TURN = np.diag([1.0, -1.0, -1.0])


def add_camera(
    camera: Camera, parent: bpy.types.Object, collection: bpy.types.Collection
) -> bpy.types.Object:
    """A new camera object that sees what ``camera`` sees, lens distortion left out.

    Its size in px and its pixel aspect are custom properties of its data, `SIZE` and
    `PIXEL_ASPECT`.
    """
    data = bpy.data.cameras.new(camera.name)
    _set_lens(data, camera)
    placed = bpy.data.objects.new(camera.name, data)
    collection.objects.link(placed)
    placed.parent = parent
    placed.rotation_mode = "QUATERNION"
    placed.matrix_basis = _world_from_camera(camera)
    return placed


def _world_from_camera(camera: Camera) -> Matrix:
    matrix = np.eye(4)
    matrix[:3, :3] = camera.rotation.T @ _HALF_TURN
    matrix[:3, 3] = camera.centre
    return Matrix(matrix)


def _set_lens(data: bpy.types.Camera, camera: Camera) -> None:
    width, height = camera.size
    fx, fy = camera.matrix[0, 0], camera.matrix[1, 1]
    cx, cy = camera.matrix[:2, 2] + 0.5
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = 36.0
    data.lens = fx * data.sensor_width / width
    data.shift_x = (width / 2 - cx) / width
    data.shift_y = (cy - height / 2) * (fx / fy) / width
    data.clip_start, data.clip_end = 0.01, 1000.0
    data.display_size = 0.3
    data[SIZE] = [width, height]
    data[PIXEL_ASPECT] = [max(1.0, fy / fx), max(1.0, fx / fy)]


def look_through(scene: bpy.types.Scene, camera: bpy.types.Object) -> None:
    """Makes ``camera``, made by `add_camera`, the scene's camera with its size and pixel aspect."""
    scene.camera = camera
    render = scene.render
    render.resolution_x, render.resolution_y = camera.data[SIZE]
    render.resolution_percentage = 100
    render.pixel_aspect_x, render.pixel_aspect_y = camera.data[PIXEL_ASPECT]
