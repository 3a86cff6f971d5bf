"""Bodies and cameras in the form the native kernel takes: flat arrays behind one record each."""

from collections.abc import Sequence

import numpy as np

from ..body.body import Body
from ..cameras.camera import Camera
from ..native.library import BodyRecord, ViewsRecord
from .records import edge_records

NEAR = 0.01
"""Metres in front of a camera at which surfaces are cut off."""
GUARD_PX = 16000.0
"""Surfaces are cut off this far from the first pixel's centre, so that 256 times fits 23 bits."""


def _filled(record, arrays: dict[str, np.ndarray]):
    """The record with its array members pointing at ``arrays``, which it keeps alive."""
    arrays = {name: np.ascontiguousarray(array) for name, array in arrays.items()}
    for name, array in arrays.items():
        setattr(record, name, array.ctypes.data)
    record.arrays = arrays
    return record


def enclosing_spheres(vertices: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """(S, 4) centres and radii of spheres round each segment's vertices; not the smallest."""
    spheres = np.zeros((len(starts) - 1, 4))
    for sphere, begin, end in zip(spheres, starts[:-1], starts[1:], strict=True):
        if end > begin:
            points = vertices[begin:end].astype(float)
            sphere[:3] = (points.min(axis=0) + points.max(axis=0)) / 2
            sphere[3] = np.linalg.norm(points - sphere[:3], axis=1).max()
    return spheres


def body_record(body: Body, level: int) -> BodyRecord:
    """The body at one level of detail as the kernel's ``sm_body``."""
    surface, dofs = body.surfaces[level], body.dofs
    joints, segments = len(body.joint_names), len(body.segment_names)
    begins = np.repeat(surface.vertex_starts[:-1], np.diff(surface.triangle_starts))
    corners = (surface.triangles - begins[:, None]).astype(np.int32)
    pieces = [
        edge_records(corners[begin:end])
        for begin, end in zip(
            surface.triangle_starts[:-1], surface.triangle_starts[1:], strict=True
        )
    ]
    record_starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces)]).astype(np.int32)
    columns = surface.vertices.T
    arrays = {
        "parents": body.parents,
        "offsets": body.offsets,
        "dof_starts": np.searchsorted(dofs.joints, np.arange(joints + 1)).astype(np.int32),
        "dof_kinds": dofs.kinds,
        "dof_axes": dofs.axes,
        "segment_joints": body.segment_joints,
        "spheres": enclosing_spheres(surface.vertices, surface.vertex_starts),
        "vertex_starts": surface.vertex_starts,
        "face_starts": surface.triangle_starts,
        "record_starts": record_starts,
        "x": columns[0], "y": columns[1], "z": columns[2],
        "corners": corners,
        "record_vertices": np.concatenate([piece.vertices for piece in pieces]),
        "record_faces": np.concatenate([piece.faces for piece in pieces]),
        "record_signs": np.concatenate([piece.signs for piece in pieces]),
    }  # fmt: skip
    counts = (joints, len(dofs), segments, len(surface.vertices), len(corners), record_starts[-1])
    return _filled(BodyRecord(*(int(count) for count in counts)), arrays)


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


def views_record(cameras: Sequence[Camera], processor: int) -> ViewsRecord:
    """The cameras as the kernel's ``sm_views``, computed by the given code path."""
    sizes = np.array([camera.size for camera in cameras], np.int32)
    width, height = sizes.astype(np.int64).T

    def starts(counts: np.ndarray) -> np.ndarray:
        return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)

    arrays = {
        "sizes": sizes,
        "projections": np.stack([camera.projection for camera in cameras]),
        "planes": np.stack([clipping_planes(camera) for camera in cameras]),
        "word_starts": starts(height * ((width + 63) // 64)),
        "map_starts": starts(height * width),
        "sum_starts": starts(height * (width + 1)),
    }
    return _filled(ViewsRecord(len(cameras), processor, NEAR), arrays)
