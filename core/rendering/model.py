"""Bodies and cameras in the form the native kernel takes: flat arrays behind one record each."""

from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np

from ..body.body import Body
from ..body.kinematics import rest_joints, skinned_segments
from ..cameras.camera import Camera
from ..native.library import BodyRecord, ViewsRecord
from .clusters import ClusteredMesh, clustered_mesh
from .edges import ClosedEdges, closed_edges
from .faces import faces_of

NEAR = 0.01
"""Metres in front of a camera at which surfaces are cut off."""
LANES = 8
"""Views side by side in the kernel."""
SPARE = 8
"""Vertices that the kernel may read beyond the last one."""
GUARD_PX = 16000.0
"""Surfaces are cut off this far from the first pixel's centre, so that 256 times fits 23 bits."""


def _filled(record, arrays: dict[str, np.ndarray]):
    """The record with its array members pointing at ``arrays``, which it keeps alive."""
    arrays = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
    for name, array in arrays.items():
        setattr(record, name, array.ctypes.data)
    record.arrays = arrays
    return record


def check_cameras(cameras: Sequence[Camera]) -> None:
    """Refuses what cannot be drawn.

    Raises:
        ValueError: no camera, one with lens distortion, or pictures that leave the guard region,
            beyond which nothing is ever covered.
    """
    if not cameras or not all(camera.is_pinhole for camera in cameras):
        raise ValueError("expected at least one camera, all of them pinhole")
    largest = max(max(camera.size) for camera in cameras)
    if largest > GUARD_PX:
        raise ValueError(f"expected pictures of at most {GUARD_PX:.0f} px, got {largest}")


def enclosing_spheres(vertices: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(S, 4) centres and radii of spheres round each segment's vertices; not the smallest."""
    spheres = np.zeros((len(starts) - 1, 4))
    for sphere, begin, end in zip(spheres, starts[:-1], starts[1:], strict=True):
        if end > begin:
            points = vertices[begin:end].astype(float)
            sphere[:3] = (points.min(axis=0) + points.max(axis=0)) / 2
            sphere[3] = np.linalg.norm(points - sphere[:3], axis=1).max()
    return spheres


@lru_cache(maxsize=8)
def body_record(body: Body, level: int) -> BodyRecord:
    """The body at one level of detail as the kernel's ``sm_body``, which nobody changes."""
    surface, dofs = body.surfaces[level], body.dofs
    joints, segments = len(body.joint_names), len(body.segment_names)
    bounds = zip(pairwise(surface.vertex_starts), pairwise(surface.triangle_starts), strict=True)
    pieces = [
        faces_of(surface.vertices[v0:v1], surface.triangles[f0:f1] - v0)
        for (v0, v1), (f0, f1) in bounds
    ]
    x, y, z = np.pad(surface.vertices, ((0, SPARE), (0, 0))).T
    arrays = {
        "parents": body.parents,
        "offsets": body.offsets,
        "dof_starts": np.searchsorted(dofs.joints, np.arange(joints + 1)).astype(np.int32),
        "dof_kinds": dofs.kinds,
        "dof_axes": dofs.axes,
        "segment_joints": body.segment_joints,
        "spheres": enclosing_spheres(surface.vertices, surface.vertex_starts),
        "vertex_starts": surface.vertex_starts,
        **{"x": x, "y": y, "z": z},
        **_mesh_arrays([clustered_mesh(piece) for piece in pieces]),
        "skinned": skinned_segments(body, surface).astype(np.uint8),
        "skin_joints": np.zeros(0, np.int32) if surface.skin is None else surface.skin.joints,
        "skin_weights": np.zeros(0, np.float32) if surface.skin is None else surface.skin.weights,
        "rests": rest_joints(body),
        **_edge_arrays([closed_edges(piece) for piece in pieces]),
    }
    lasts = (int(arrays[f"{name}_starts"][-1]) for name in ("cluster", "run", "edge"))
    counts = joints, len(dofs), segments, len(surface.vertices), *lasts
    return _filled(BodyRecord(*counts), arrays)


def _mesh_arrays(meshes: list[ClusteredMesh]) -> dict[str, np.ndarray]:
    """The segments' triangles, one after the other."""
    return {
        "cluster_starts": _running([mesh.cluster_planes.shape[1] for mesh in meshes]),
        "run_starts": _running(np.concatenate([mesh.run_lengths for mesh in meshes])),
        "corners": np.concatenate([mesh.corners for mesh in meshes]),
        "face_planes": np.concatenate([mesh.face_planes for mesh in meshes], axis=1),
        "cluster_planes": np.concatenate([mesh.cluster_planes for mesh in meshes], axis=1),
        "record_vertices": np.concatenate([mesh.records.vertices for mesh in meshes]),
        "record_faces": np.concatenate([mesh.records.faces for mesh in meshes]),
    }


def _edge_arrays(closed: list[ClosedEdges]) -> dict[str, np.ndarray]:
    """The closed segments' edges, one segment's after the other's."""
    cones = np.concatenate([edges.cones for edges in closed], axis=1)
    return {
        "edge_starts": _running([len(edges.sides) for edges in closed]),
        "edge_cones": np.pad(cones.ravel(), (0, 2 * SPARE)),
        "edge_sides": np.concatenate([edges.sides for edges in closed]),
        "edge_ends": np.concatenate([edges.ends for edges in closed]),
        "edge_corners": np.concatenate([edges.corners for edges in closed]),
    }


def _running(counts: Iterable[int]) -> np.ndarray:
    """(n + 1,) int32 running sums from 0 on."""
    return np.cumsum([0, *counts]).astype(np.int32)


def clipping_planes(camera: Camera) -> np.ndarray:
    """(9, 4) unit planes in the world, positive inside: near, the guard's sides, the picture's."""
    x, y, depth = camera.projection
    width, height = camera.size
    planes = np.stack(
        [
            depth - [0, 0, 0, NEAR],
            *(
                GUARD_PX * depth + x,
                GUARD_PX * depth - x,
                GUARD_PX * depth + y,
                GUARD_PX * depth - y,
            ),
            *(depth + x, width * depth - x, depth + y, height * depth - y),
        ]
    )
    return planes / np.linalg.norm(planes[:, :3], axis=1, keepdims=True)


def optics(camera: Camera) -> np.ndarray:
    """(5,) the centre of projection in the world, det K R, and the largest stretch of K in px.

    Of what is projected, as R may be slightly off a rotation: a point in the plane of a face must
    be seen at its edge.
    """
    left, right = camera.projection[:, :3], camera.projection[:, 3]
    scale = np.linalg.norm(camera.matrix[:2, :2], 2)
    return np.array([*-np.linalg.solve(left, right), np.linalg.det(left), scale])


def _side_by_side(values: list[np.ndarray]) -> np.ndarray:
    """(..., L) the views' values, filled up with those of the first one."""
    filled = values + values[:1] * (-len(values) % LANES)
    return np.stack(filled, axis=-1)


def views_record(cameras: Sequence[Camera], processor: int) -> ViewsRecord:
    """The cameras as the kernel's ``sm_views``, computed by the given code path.

    Raises:
        ValueError: as by `check_cameras`, or a camera with another last row than 0 0 1.
    """
    check_cameras(cameras)
    if not all(np.array_equal(camera.matrix[2], [0, 0, 1]) for camera in cameras):
        raise ValueError("expected 0 0 1 in the last row of every intrinsic matrix")
    sizes = np.array([camera.size for camera in cameras], np.int32)
    width, height = sizes.astype(np.int64).T

    def starts(counts: np.ndarray) -> np.ndarray:
        return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)

    arrays = {
        "sizes": sizes,
        "projections": _side_by_side([camera.projection for camera in cameras]),
        "planes": _side_by_side([clipping_planes(camera) for camera in cameras]),
        "optics": _side_by_side([optics(camera) for camera in cameras]),
        "word_starts": starts(height * ((width + 63) // 64)),
        "map_starts": starts(height * width),
        "sum_starts": starts(height * (width + 1)),
    }
    return _filled(ViewsRecord(len(cameras), processor, NEAR), arrays)
