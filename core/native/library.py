"""The native kernel as Python sees it: `kernel.h` declared to ctypes, and the library loaded.

Calls release the GIL. Nothing is checked here that the kernel checks itself; its error codes become
ValueErrors, as only a programmer's mistake makes them.
"""

import ctypes
from ctypes import POINTER, c_double, c_int32, c_int64, c_size_t, c_void_p
from functools import cache
from pathlib import Path

from ..errors import MocapError
from .build import TARGETS, fingerprint, host_target, library_name

ABI = 9
PLANES, MAPS = 0, 1
FOLDER = Path(__file__).resolve().parent
BUILD = f'build it: python -m pip install ziglang, then python "{FOLDER / "build.py"}"'
_ERRORS = {
    1: "sizes that do not fit together",
    2: "an index out of range",
    3: "too little scratch",
    4: "an unknown code path",
}


class BodyRecord(ctypes.Structure):
    """``sm_body`` of kernel.h; the arrays must outlive it."""

    _fields_ = (
        *((name, c_int32) for name in ("joints", "dofs", "segments")),
        *((name, c_int32) for name in ("vertices", "clusters", "records", "edge_clusters")),
        *((name, c_void_p) for name in ("parents", "offsets", "dof_starts", "dof_kinds")),
        *((name, c_void_p) for name in ("dof_axes", "segment_joints", "spheres")),
        *((name, c_void_p) for name in ("vertex_starts", "cluster_starts", "run_starts")),
        *((name, c_void_p) for name in ("x", "y", "z", "corners", "face_planes")),
        *((name, c_void_p) for name in ("cluster_planes", "record_vertices", "record_faces")),
        *((name, c_void_p) for name in ("skinned", "skin_joints", "skin_weights", "rests")),
        *((name, c_void_p) for name in ("edge_starts", "edge_cones")),
        *((name, c_void_p) for name in ("edge_sides", "edge_ends", "edge_corners")),
    )


class ViewsRecord(ctypes.Structure):
    """``sm_views`` of kernel.h."""

    _fields_ = (
        ("views", c_int32),
        ("processor", c_int32),
        ("near", c_double),
        *((name, c_void_p) for name in ("sizes", "projections", "planes", "optics")),
        *((name, c_void_p) for name in ("word_starts", "map_starts", "sum_starts")),
    )


class WeightsRecord(ctypes.Structure):
    """``sm_weights`` of kernel.h."""

    _fields_ = (
        ("kind", c_int32),
        *((name, c_void_p) for name in ("plus", "minus", "maps", "sums", "constants", "rows")),
    )


class PointsRecord(ctypes.Structure):
    """``sm_points`` of kernel.h."""

    _fields_ = (
        ("room", c_int64),
        *((name, c_void_p) for name in ("starts", "segments", "points", "px", "normals")),
    )


class TargetsRecord(ctypes.Structure):
    """``sm_targets`` of kernel.h."""

    _fields_ = (
        *((name, c_int32) for name in ("views", "processor")),
        *((name, c_void_p) for name in ("sizes", "fields", "starts", "px")),
        *((name, c_void_p) for name in ("normals", "projections", "metres")),
        *((name, c_double) for name in ("reach", "turn")),
    )


def _declare(library: ctypes.CDLL) -> None:
    body, views, weights = POINTER(BodyRecord), POINTER(ViewsRecord), POINTER(WeightsRecord)
    points, targets = POINTER(PointsRecord), POINTER(TargetsRecord)
    pointer, scratch = c_void_p, (c_void_p, c_size_t)
    poses, segments = (c_void_p, c_int64, c_int32), (c_void_p, c_int32)
    terms = (points, pointer, c_int32, pointer, pointer, pointer)
    outline = (pointer, c_int32, *segments, c_double, points)
    signatures = {
        "sm_abi": (c_int32, ()),
        "sm_sources": (ctypes.c_char_p, ()),
        "sm_processor": (c_int32, ()),
        "sm_check": (c_int32, (body, views)),
        "sm_scratch": (c_size_t, (body, views)),
        "sm_transforms": (c_int32, (body, pointer, c_int64, pointer)),
        "sm_twists": (c_int32, (body, pointer, pointer, pointer)),
        "sm_contour_terms": (c_int32, (targets, *terms)),
        "sm_prepare": (c_int32, (views, pointer, weights, pointer)),
        "sm_mask": (c_int32, (views, weights, pointer, pointer, weights, pointer)),
        "sm_energies": (c_int32, (body, views, weights, *poses, *segments, pointer, *scratch)),
        "sm_silhouettes": (c_int32, (body, views, pointer, c_int32, *segments, pointer, *scratch)),
        "sm_outline": (c_int32, (body, views, *outline, *scratch)),
        "sm_bounds": (c_int32, (body, views, *poses, *segments, pointer, *scratch)),
        "sm_snapped": (c_int32, (body, views, pointer, pointer, *scratch)),
    }  # fmt: skip
    for name, (result, arguments) in signatures.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments


@cache
def load() -> ctypes.CDLL:
    """The library, checked to fit this code.

    Raises:
        MocapError: there is none for this platform, or it is missing, cannot be loaded, or was
            built from other sources.
    """
    target = host_target()
    if target not in TARGETS:
        raise MocapError(
            f"there is no native kernel for {target}, only for {', '.join(TARGETS)}",
            "choose the reference evaluator, which is slow",
        )
    path = FOLDER / library_name(target)
    if not path.exists():
        raise MocapError("the native kernel is missing", BUILD, file=path)
    try:
        library = ctypes.CDLL(str(path))
        library.sm_sources.restype = ctypes.c_char_p
        current = library.sm_abi() == ABI and _is_current(library.sm_sources().decode())
    except (OSError, AttributeError) as error:
        raise MocapError(
            f"the native kernel cannot be loaded ({error})", BUILD, file=path
        ) from error
    if not current:
        raise MocapError("the native kernel was built from other sources", BUILD, file=path)
    _declare(library)
    return library


def _is_current(built_from: str) -> bool:
    """Whether the library fits the sources beside it; installed without sources, it does."""
    return fingerprint(FOLDER) in ("", built_from)


def check(code: int) -> None:
    """Raises a ValueError unless ``code`` is SM_OK."""
    if code:
        raise ValueError(
            f"the native kernel refuses {_ERRORS.get(code, f'the call (code {code})')}"
        )
