"""The stencil buffer that paper mode draws into: a byte per pixel, one camera to a bit."""

import ctypes
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ..model import NEAR
from .canvas import DeviceMesh, address, drawing_range, new_texture
from .context import GlThread, no_opengl
from .paper_shaders import CUT_GEOMETRY, CUT_VERTEX, FRAGMENT, WHOLE_VERTEX
from .placing import CUT, HIDDEN, WHOLE, Placement
from .shaders import program, uniforms
from .tiles import Tiles

PLANES = 8
_MOST_SIZES = 16
_MATRIX_BYTES = 3 * 4 * 4


class StencilPrograms:
    """What draws into the stencil buffer, and framebuffers of all sizes in use.

    Args:
        thread: the context's thread, in which all of this is called.
    """

    def __init__(self, thread: GlThread):
        self.gl, self.reach = thread.gl, drawing_range(thread.gl)
        whole = program(self.gl, vertex=WHOLE_VERTEX, fragment=FRAGMENT)
        cut = program(self.gl, vertex=CUT_VERTEX, geometry=CUT_GEOMETRY, fragment=FRAGMENT)
        names = "rows", "shift", "half_side", "region", "near"
        self.programs = {
            state: (handle, uniforms(self.gl, handle, *names))
            for state, handle in ((WHOLE, whole), (CUT, cut))
        }
        for handle, places in self.programs.values():
            self.gl.glUseProgram(handle)
            self.gl.glUniform1f(places["half_side"], self.reach.side / 2)
            self.gl.glUniform1f(places["near"], NEAR)
        self._frames: dict[tuple[int, int], Frames] = {}

    def frames(self, size: tuple[int, int]) -> "Frames":
        """Framebuffers of that size."""
        if size not in self._frames:
            if len(self._frames) >= _MOST_SIZES:
                self._frames.pop(next(iter(self._frames))).delete()
            self._frames[size] = Frames(self.gl, size)
        return self._frames[size]


class Frames:
    """Two framebuffers: one that keeps what is written each time, and one to draw into.

    Args:
        gl: PyOpenGL's functions.
        size: (width, height) in px.
    """

    def __init__(self, gl: Any, size: tuple[int, int]):
        self._gl, self.size = gl, size
        self._observed: np.ndarray | None = None
        self.kept, self.kept_texture = _framebuffer(gl, size)
        self.drawn, self.drawn_texture = _framebuffer(gl, size)

    def keep(self, observed: np.ndarray) -> None:
        """Bit planes (H, W) uint8, to be written each time; they must not change any more."""
        if observed is self._observed:
            return
        # PyOpenGL's own wrapper does not know this type of pixels
        from OpenGL.raw.GL.VERSION.GL_1_1 import glTexSubImage2D

        gl = self._gl
        # depth 1, the farthest, lies in the upper 24 bits
        packed = observed.astype(np.uint32) | 0xFFFFFF00
        gl.glBindTexture(gl.GL_TEXTURE_2D, self.kept_texture)
        gl.glPixelStorei(gl.GL_UNPACK_ALIGNMENT, 4)
        form = gl.GL_DEPTH_STENCIL, gl.GL_UNSIGNED_INT_24_8
        glTexSubImage2D(gl.GL_TEXTURE_2D, 0, 0, 0, *self.size, *form, address(packed))
        self._observed = observed

    def delete(self) -> None:
        """Gives their memory back."""
        self._gl.glDeleteFramebuffers(2, [self.kept, self.drawn])
        self._gl.glDeleteTextures(2, [self.kept_texture, self.drawn_texture])


class StencilDrawing:
    """Draws candidates into the bit planes of up to eight views; in the thread only.

    Args:
        shared: programs and framebuffers.
        tiles: the views' windows, all in the buffer's corner.
        observed: (H, W) uint8, the bit planes that are written before each drawing.
    """

    def __init__(self, shared: StencilPrograms, tiles: Tiles, observed: np.ndarray):
        self._gl, self._programs, reach = shared.gl, shared.programs, shared.reach
        self._tiles, self._frames = tiles, shared.frames(tiles.size)
        low, high = tiles.windows[:, :2], tiles.windows[:, 2:]
        # half a px: the first centre lies at 0.5 in OpenGL
        self._shifts = (0.5 - low + reach.margin - reach.side / 2).tolist()
        self._regions = np.hstack([low - reach.margin, high + reach.margin]).tolist()
        self._frames.keep(observed)
        gl = self._gl
        gl.glViewport(-reach.margin, -reach.margin, reach.side, reach.side)
        for unused in (gl.GL_CULL_FACE, gl.GL_COLOR_LOGIC_OP):
            gl.glDisable(unused)
        for used in (gl.GL_DEPTH_TEST, gl.GL_STENCIL_TEST, gl.GL_SCISSOR_TEST):
            gl.glEnable(used)
        gl.glDepthFunc(gl.GL_LESS)
        gl.glStencilFunc(gl.GL_ALWAYS, 0, 0xFF)
        gl.glStencilOp(gl.GL_KEEP, gl.GL_KEEP, gl.GL_INVERT)

    def write(self) -> None:
        """Puts the observed silhouettes into the stencil buffer, and the depth far away."""
        gl, (width, height) = self._gl, self._tiles.size
        gl.glScissor(0, 0, width, height)
        gl.glStencilMask(0xFF)
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self._frames.kept)
        gl.glBindFramebuffer(gl.GL_DRAW_FRAMEBUFFER, self._frames.drawn)
        box, both = (0, 0, width, height), gl.GL_DEPTH_BUFFER_BIT | gl.GL_STENCIL_BUFFER_BIT
        gl.glBlitFramebuffer(*box, *box, both, gl.GL_NEAREST)

    def invert(
        self, mesh: DeviceMesh, placement: Placement, candidate: int, segments: Sequence[int]
    ) -> None:
        """Draws the segments of one candidate for one view after the other."""
        gl = self._gl
        rows = np.ascontiguousarray(placement.rows[:, :, candidate].swapaxes(1, 2))
        states = placement.states[:, candidate].tolist()
        gl.glBindVertexArray(mesh.array)
        for view, (width, height) in enumerate(self._tiles.sizes.tolist()):
            gl.glScissor(0, 0, width, height)
            gl.glStencilMask(1 << view)
            if view:
                gl.glClear(gl.GL_DEPTH_BUFFER_BIT)
            pieces = [mesh.pieces[segment] for segment in segments]
            self._draw_segments(view, zip(states[view], _matrices(rows[view]), pieces, strict=True))
        gl.glBindVertexArray(0)

    def _draw_segments(self, view: int, segments: Iterator[tuple[int, Any, Any]]) -> None:
        """One draw call for every segment: its state, its matrix and where its corners are."""
        gl, used, places = self._gl, HIDDEN, {}
        for state, matrix, (begin, count) in segments:
            if state == HIDDEN:
                continue
            if state != used:
                handle, places = self._programs[state]
                gl.glUseProgram(handle)
                gl.glUniform2f(places["shift"], *self._shifts[view])
                if state == CUT:
                    gl.glUniform4f(places["region"], *self._regions[view])
                used = state
            gl.glUniform4fv(places["rows"], 3, matrix)
            gl.glDrawElements(gl.GL_TRIANGLES, count, gl.GL_UNSIGNED_INT, begin)

    def read(self) -> np.ndarray:
        """(H, W) uint8, the stencil buffer."""
        gl, (width, height) = self._gl, self._tiles.size
        planes = np.empty((height, width), np.uint8)
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self._frames.drawn)
        gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 1)
        form = gl.GL_STENCIL_INDEX, gl.GL_UNSIGNED_BYTE
        gl.glReadPixels(0, 0, width, height, *form, address(planes))
        return planes


def _matrices(rows: np.ndarray) -> Iterator[Any]:
    """Pointers to the matrices (S, 3, 4) float32, which must outlive them."""
    kind = ctypes.POINTER(ctypes.c_float)
    for number in range(len(rows)):
        yield ctypes.cast(rows.ctypes.data + number * _MATRIX_BYTES, kind)


def _framebuffer(gl: Any, size: tuple[int, int]) -> tuple[int, int]:
    texture = new_texture(gl, gl.GL_DEPTH24_STENCIL8, size)
    frame = int(gl.glGenFramebuffers(1))
    gl.glBindFramebuffer(gl.GL_FRAMEBUFFER, frame)
    gl.glFramebufferTexture2D(
        gl.GL_FRAMEBUFFER, gl.GL_DEPTH_STENCIL_ATTACHMENT, gl.GL_TEXTURE_2D, texture, 0
    )
    gl.glDrawBuffer(gl.GL_NONE)
    gl.glReadBuffer(gl.GL_NONE)
    if gl.glCheckFramebufferStatus(gl.GL_FRAMEBUFFER) != gl.GL_FRAMEBUFFER_COMPLETE:
        raise no_opengl("it has no stencil buffer off-screen")
    return frame, texture
