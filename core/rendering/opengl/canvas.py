"""The range of coordinates in which both modes draw, and meshes on the graphics processor."""

import ctypes
from dataclasses import dataclass
from typing import Any

import numpy as np

from .context import GlThread, no_opengl
from .meshes import Mesh

_LARGEST_VIEWPORT = 1 << 14
"""px; 256 times this, and a sign, fit the 24 bits of single precision. All drivers have as much."""


@dataclass(frozen=True)
class Range:
    """What can be drawn without OpenGL's clipping.

    Attributes:
        side: px, a power of two: the viewport.
        margin: px round a picture that vertices may lie in.
        largest: px, the most that a picture may be wide or high.
    """

    side: int
    margin: int
    largest: int


def drawing_range(gl: Any) -> Range:
    """The range of the current context: a quarter is margin at either end.

    Raises:
        MocapError: it snaps vertices to less than 1/256 px.
    """
    if gl.glGetIntegerv(gl.GL_SUBPIXEL_BITS) < 8:
        raise no_opengl("it snaps vertices to less than 1/256 px")
    most = min(_LARGEST_VIEWPORT, *(int(n) for n in gl.glGetIntegerv(gl.GL_MAX_VIEWPORT_DIMS)))
    side = 1 << (most.bit_length() - 1)
    texture = int(gl.glGetIntegerv(gl.GL_MAX_TEXTURE_SIZE))
    return Range(side, side // 4, min(side // 2, texture))


def address(array: np.ndarray) -> ctypes.c_void_p:
    """The array's memory, for OpenGL to read at once."""
    return ctypes.c_void_p(array.ctypes.data)


def new_buffer(thread: GlThread, owner: object, values: np.ndarray) -> int:
    """A buffer of the device that holds the values as long as ``owner`` lives."""
    gl = thread.gl
    name = int(gl.glGenBuffers(1))
    thread.forget_with(owner, "glDeleteBuffers", name)
    gl.glBindBuffer(gl.GL_COPY_WRITE_BUFFER, name)
    gl.glBufferData(gl.GL_COPY_WRITE_BUFFER, values.nbytes, address(values), gl.GL_STATIC_DRAW)
    return name


def new_texture(gl: Any, form: Any, size: tuple[int, int]) -> int:
    """A texture of one level, left bound; nobody deletes it."""
    name = int(gl.glGenTextures(1))
    gl.glBindTexture(gl.GL_TEXTURE_2D, name)
    gl.glTexStorage2D(gl.GL_TEXTURE_2D, 1, form, *size)
    for side in (gl.GL_TEXTURE_MIN_FILTER, gl.GL_TEXTURE_MAG_FILTER):
        gl.glTexParameteri(gl.GL_TEXTURE_2D, side, gl.GL_NEAREST)
    return name


class DeviceMesh:
    """A mesh in buffers of the graphics processor; made and drawn in the context's thread.

    Args:
        thread: the context's thread.
        mesh: the mesh.
    """

    def __init__(self, thread: GlThread, mesh: Mesh):
        gl, self.mesh = thread.gl, mesh
        bounds = zip(mesh.starts[:-1].tolist(), mesh.starts[1:].tolist(), strict=True)
        # of each column: where its corners begin (a pointer, in bytes) and how many there are
        self.pieces = {
            column: (ctypes.c_void_p(12 * begin), 3 * (end - begin))
            for column, (begin, end) in zip(mesh.order.tolist(), bounds, strict=True)
        }
        self.array = int(gl.glGenVertexArrays(1))
        thread.forget_with(self, "glDeleteVertexArrays", self.array)
        gl.glBindVertexArray(self.array)
        for place, values in enumerate((mesh.points, mesh.columns)):
            gl.glBindBuffer(gl.GL_ARRAY_BUFFER, new_buffer(thread, self, values))
            gl.glEnableVertexAttribArray(place)
            if place:
                gl.glVertexAttribIPointer(place, 1, gl.GL_UNSIGNED_INT, 0, None)
            else:
                gl.glVertexAttribPointer(place, 3, gl.GL_FLOAT, False, 0, None)
        gl.glBindBuffer(gl.GL_ELEMENT_ARRAY_BUFFER, new_buffer(thread, self, mesh.corners))
        gl.glBindVertexArray(0)
