"""Blender's own projection is the oracle: the picture it renders against core's pixels."""

import bpy
import numpy as np
import pytest
from bl_ext.user_default.silhouette_mocap.addon.bridge.cameras import add_camera, look_through
from bl_ext.user_default.silhouette_mocap.addon.bridge.space import add_capture_space
from bl_ext.user_default.silhouette_mocap.core.cameras.camera import Camera
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector
from scipy.spatial.transform import Rotation

TOLERANCE_PX = 0.01

LENSES = {
    "centred": ((640, 480), 600, 600, 319.5, 239.5),
    "off centre": ((1280, 960), 1100, 1100, 700.3, 400.8),
    "portrait": ((1088, 1920), 1650, 1650, 520.2, 990.1),
    "portrait, pixels 3 % too tall": ((1080, 1920), 1700, 1650, 512, 961),
    "pixels 9 % too wide": ((720, 576), 800, 872, 371.5, 300.2),
    "4K": ((3840, 2160), 2500.123, 2500.123, 1900.5, 1100.25),
}


@pytest.fixture(params=LENSES, ids=str)
def camera(request):
    size, fx, fy, cx, cy = LENSES[request.param]
    rotation = Rotation.from_euler("xyz", [100, 25, -130], degrees=True).as_matrix()
    eye = np.array([2.0, -3.0, 1.5])
    pose = np.column_stack([rotation, -rotation @ eye])
    return Camera("cam01", size, [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], pose)


@pytest.fixture
def seen_points(camera):
    """World points all over the picture, one to nine metres away."""
    rng = np.random.default_rng(1)
    px = rng.uniform(-0.5, 0.5, (200, 2)) + rng.uniform(0, np.array(camera.size), (200, 2))
    rays = np.column_stack([px, np.ones(200)]) @ np.linalg.inv(camera.matrix).T
    return rays * rng.uniform(1, 9, (200, 1)) @ camera.rotation + camera.centre


def placed(camera):
    scene = bpy.context.scene
    space = add_capture_space(scene.collection)
    ob = add_camera(camera, space, scene.collection)
    look_through(scene, ob)
    return space, ob


def rendered_px(ob, points):
    """(N, 2) px by the matrices that Blender renders with, the first pixel's centre at (0, 0)."""
    render = bpy.context.scene.render
    width, height = render.resolution_x, render.resolution_y
    window = ob.calc_matrix_camera(
        bpy.context.evaluated_depsgraph_get(),
        x=width,
        y=height,
        scale_x=render.pixel_aspect_x,
        scale_y=render.pixel_aspect_y,
    )
    world = np.linalg.inv(np.array(ob.matrix_world, float))
    clip = np.column_stack([points, np.ones(len(points))]) @ (np.array(window, float) @ world).T
    ndc = clip[:, :2] / clip[:, 3:]
    return (ndc * [1, -1] + 1) / 2 * [width, height] - 0.5


def test_blender_renders_a_point_on_the_pixel_that_core_projects_it_to(camera, seen_points):
    _, ob = placed(camera)
    error = np.abs(rendered_px(ob, seen_points) - camera.project(seen_points))
    assert error.max() < TOLERANCE_PX


def test_world_to_camera_view_agrees_with_core(camera, seen_points):
    _, ob = placed(camera)
    bpy.context.view_layer.update()
    views = [world_to_camera_view(bpy.context.scene, ob, Vector(p)) for p in seen_points]
    px = np.array([[v.x * camera.size[0], (1 - v.y) * camera.size[1]] for v in views]) - 0.5
    assert np.abs(px - camera.project(seen_points)).max() < TOLERANCE_PX


def test_a_moved_capture_space_takes_the_cameras_along(camera, seen_points):
    space, ob = placed(camera)
    space.location, space.rotation_euler = (1, 2, 0.5), (0, 0, 0.7)
    bpy.context.view_layer.update()
    matrix = np.array(space.matrix_world, float)
    moved = seen_points @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.abs(rendered_px(ob, moved) - camera.project(seen_points)).max() < TOLERANCE_PX


def test_every_camera_keeps_its_size_and_looking_through_it_brings_it_back():
    scene = bpy.context.scene
    space = add_capture_space(scene.collection)
    sizes = {"wide": (1280, 720), "tall": (1088, 1920)}
    pose = np.eye(4)[:3]
    made = {}
    for name, size in sizes.items():
        camera = Camera(name, size, [[900, 0, 300], [0, 900, 300], [0, 0, 1]], pose)
        made[name] = add_camera(camera, space, scene.collection)
    for name, size in sizes.items():
        look_through(scene, made[name])
        assert scene.camera.name == name
        assert (scene.render.resolution_x, scene.render.resolution_y) == size
