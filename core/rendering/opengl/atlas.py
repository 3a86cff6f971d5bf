"""One large picture of words on the device, drawn into and added up."""

import ctypes

import numpy as np

from ..model import NEAR
from .canvas import DeviceMesh, Range, address, drawing_range, new_buffer, new_texture
from .context import GlThread, no_opengl
from .gpu_shaders import (
    CANDIDATES,
    CUT_GEOMETRY,
    CUT_VERTEX,
    FRAGMENT,
    LANES,
    LOW_BITS,
    ROWS,
    SUMS,
    WHOLE_VERTEX,
)
from .meshes import Mesh
from .placing import CUT, WHOLE, Placement
from .shaders import program, uniforms
from .tiles import Tiles

_MOST_PX = 1 << 24
_ROWS, _STATES, _ITEMS, _TILES, _PIECES, _SUMS = range(6)
"""Bindings of the buffers in the shaders."""


class DeviceTiles:
    """Tiles of some views, and their weights, in buffers of the device.

    Args:
        thread: the context's thread, in which this is made.
        reach: what can be drawn.
        tiles: where the views lie.
        maps: V weight maps (H, W) int16; None where nothing is to be added up.
    """

    def __init__(
        self,
        thread: GlThread,
        reach: Range,
        tiles: Tiles,
        maps: tuple[np.ndarray, ...] | None,
    ):
        self.tiles, self.weights = tiles, 0
        records = np.zeros((len(tiles.views), 12), np.float32)
        low, high = tiles.windows[:, :2], tiles.windows[:, 2:]
        records[:, 0:2] = low - reach.margin
        records[:, 2:4] = high + reach.margin
        records[:, 4:8] = tiles.areas.astype(np.int32).view(np.float32)
        # half a px: the first centre lies at 0.5 in OpenGL
        records[:, 8:10] = tiles.places - low + 0.5 + reach.margin - reach.side / 2
        self.records = new_buffer(thread, self, records)
        self._pieces = self._cut_up()
        if maps is not None:
            self.weights = self._texture(thread, maps)

    def pieces(self, reach: np.ndarray) -> np.ndarray:
        """(n, 8) int32: x0, y0, x1, y1 in the block, and the view among the tiles.

        Args:
            reach: (k, 4) px of each view's picture; pieces without any of them are left out.
        """
        shift = self.tiles.places - self.tiles.windows[:, :2]
        places = (reach + np.tile(shift, 2))[self._pieces[:, 4]]
        met = (self._pieces[:, :2] < places[:, 2:]) & (self._pieces[:, 2:4] > places[:, :2])
        return self._pieces[met.all(axis=1)]

    def _cut_up(self) -> np.ndarray:
        """(n, 8) all `pieces`."""
        found = []
        for number, (x0, y0, x1, y1) in enumerate(self.tiles.areas.tolist()):
            for y in range(y0, y1, ROWS):
                for x in range(x0, x1, LANES):
                    end = (min(x + LANES, x1), min(y + ROWS, y1))
                    found.append((x, y, *end, number, 0, 0, 0))
        return np.array(found, np.int32)

    def _texture(self, thread: GlThread, maps: tuple[np.ndarray, ...]) -> int:
        width, height = self.tiles.size
        block = np.zeros((height, width), np.int16)
        for view, (x0, y0, x1, y1), (left, top, right, bottom) in zip(
            self.tiles.views, self.tiles.areas, self.tiles.windows, strict=True
        ):
            block[y0:y1, x0:x1] = maps[view][top:bottom, left:right]
        gl = thread.gl
        name = new_texture(gl, gl.GL_R16I, (width, height))
        thread.forget_with(self, "glDeleteTextures", name)
        gl.glPixelStorei(gl.GL_UNPACK_ALIGNMENT, 2)
        gl.glTexSubImage2D(
            gl.GL_TEXTURE_2D, 0, 0, 0, width, height, gl.GL_RED_INTEGER, gl.GL_SHORT, address(block)
        )
        return name


class Atlas:
    """The picture, and the programs that draw into it and add it up.

    Args:
        thread: the context's thread, in which all of this is called.
    """

    most_px = _MOST_PX

    def __init__(self, thread: GlThread):
        self._gl, self._reach = thread.gl, drawing_range(thread.gl)
        self._size, self._texture = (0, 0), 0
        gl = self._gl
        whole = program(gl, vertex=WHOLE_VERTEX, fragment=FRAGMENT)
        cut = program(gl, vertex=CUT_VERTEX, geometry=CUT_GEOMETRY, fragment=FRAGMENT)
        sums = program(gl, compute=SUMS)
        drawing = ("candidates", "segments", "blocks", "block", "wanted")
        self._drawing = {
            state: (handle, uniforms(gl, handle, *drawing, "half_side", "near"))
            for state, handle in ((WHOLE, whole), (CUT, cut))
        }
        self._sums = sums, uniforms(gl, sums, "views", "blocks", "block")
        self._buffers = [int(name) for name in gl.glGenBuffers(6)]
        self._frame = int(gl.glGenFramebuffers(1))

    def most_groups(self, block: tuple[int, int]) -> int:
        """How many blocks of that size fit at once, at least one."""
        across, down = (self._reach.largest // side for side in block)
        return max(1, min(across * down, self.most_px // (block[0] * block[1])))

    def draw(self, mesh: DeviceMesh, tiles: DeviceTiles, placement: Placement) -> None:
        """Sets the bits of all candidates; all others are 0 in the blocks used."""
        gl, (views, candidates, segments) = self._gl, placement.states.shape
        across = self._begin(tiles.tiles.size, candidates)
        self._upload(_ROWS, placement.rows)
        self._upload(_STATES, placement.states)
        gl.glBindBufferBase(gl.GL_SHADER_STORAGE_BUFFER, _TILES, tiles.records)
        gl.glBindVertexArray(mesh.array)
        counts = {"candidates": candidates, "segments": segments, "blocks": across}
        cut = np.flatnonzero((placement.states == CUT).any(axis=2)).astype(np.uint32)
        everything = np.arange(views * candidates, dtype=np.uint32)
        for state, items in ((WHOLE, everything), (CUT, cut)):
            if len(items):
                self._upload(_ITEMS, items)
                self._use(state, counts, tiles.tiles.size)
                self._draw_triangles(mesh.mesh, state, len(items))
        gl.glBindVertexArray(0)

    def _use(self, state: int, counts: dict[str, int], block: tuple[int, int]) -> None:
        """Switches to the program that draws segments of that state."""
        gl, (handle, places) = self._gl, self._drawing[state]
        gl.glUseProgram(handle)
        for name, value in counts.items():
            gl.glUniform1i(places[name], value)
        gl.glUniform1ui(places["wanted"], state)
        gl.glUniform2i(places["block"], *block)
        gl.glUniform1f(places["half_side"], self._reach.side / 2)
        gl.glUniform1f(places["near"], NEAR)

    def _draw_triangles(self, mesh: Mesh, state: int, instances: int) -> None:
        """Of closed segments that are whole the front faces, of all others all."""
        gl = self._gl
        closed = mesh.closed if state == WHOLE else 0
        for begin, end, front in ((0, closed, True), (closed, len(mesh.corners), False)):
            if end > begin:
                (gl.glEnable if front else gl.glDisable)(gl.GL_CULL_FACE)
                first, count = ctypes.c_void_p(12 * begin), 3 * (end - begin)
                gl.glDrawElementsInstanced(
                    gl.GL_TRIANGLES, count, gl.GL_UNSIGNED_INT, first, instances
                )

    def sums(self, tiles: DeviceTiles, placement: Placement) -> np.ndarray:
        """(N, k) int64 sums of weights over what each drawn candidate covers of each tile."""
        gl, (views, candidates, _) = self._gl, placement.states.shape
        pieces = tiles.pieces(placement.reach)
        if not len(pieces):
            return np.zeros((candidates, views), np.int64)
        groups, across = self._layout(tiles.tiles.size, candidates)
        halves = np.zeros((groups * CANDIDATES, views, 2), np.int32)
        self._upload(_PIECES, pieces)
        self._upload(_SUMS, halves)
        for unit, texture in enumerate((self._texture, tiles.weights)):
            gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
            gl.glBindTexture(gl.GL_TEXTURE_2D, texture)
        handle, places = self._sums
        gl.glUseProgram(handle)
        gl.glUniform1i(places["views"], views)
        gl.glUniform1i(places["blocks"], across)
        gl.glUniform2i(places["block"], *tiles.tiles.size)
        gl.glMemoryBarrier(gl.GL_TEXTURE_FETCH_BARRIER_BIT | gl.GL_FRAMEBUFFER_BARRIER_BIT)
        gl.glDispatchCompute(len(pieces), groups, 1)
        gl.glMemoryBarrier(gl.GL_BUFFER_UPDATE_BARRIER_BIT)
        gl.glGetBufferSubData(gl.GL_SHADER_STORAGE_BUFFER, 0, halves.nbytes, address(halves))
        wide = halves[:candidates].astype(np.int64)
        return wide[..., 0] + (wide[..., 1] << LOW_BITS)

    def _upload(self, binding: int, values: np.ndarray) -> None:
        """Hands values to the shaders; the buffer stays bound."""
        gl = self._gl
        gl.glBindBuffer(gl.GL_SHADER_STORAGE_BUFFER, self._buffers[binding])
        gl.glBufferData(
            gl.GL_SHADER_STORAGE_BUFFER, values.nbytes, address(values), gl.GL_STREAM_DRAW
        )
        gl.glBindBufferBase(gl.GL_SHADER_STORAGE_BUFFER, binding, self._buffers[binding])

    def _layout(self, block: tuple[int, int], candidates: int) -> tuple[int, int]:
        """Number of blocks, and how many stand in a row."""
        groups = -(-candidates // CANDIDATES)
        across = max(1, min(groups, self._reach.largest // block[0]))
        return groups, across

    def _begin(self, block: tuple[int, int], candidates: int) -> int:
        """Empties as many blocks as there are groups of candidates; how many stand in a row."""
        gl, (groups, across) = self._gl, self._layout(block, candidates)
        width, height = across * block[0], -(-groups // across) * block[1]
        self._grow(width, height)
        side, margin = self._reach.side, self._reach.margin
        gl.glBindFramebuffer(gl.GL_FRAMEBUFFER, self._frame)
        gl.glViewport(-margin, -margin, side, side)
        gl.glDisable(gl.GL_DEPTH_TEST)
        gl.glDisable(gl.GL_STENCIL_TEST)
        gl.glEnable(gl.GL_SCISSOR_TEST)
        gl.glScissor(0, 0, width, height)
        gl.glDisable(gl.GL_COLOR_LOGIC_OP)
        gl.glClearBufferuiv(gl.GL_COLOR, 0, (ctypes.c_uint * 4)())
        gl.glEnable(gl.GL_COLOR_LOGIC_OP)
        gl.glLogicOp(gl.GL_OR)
        return across

    def _grow(self, width: int, height: int) -> None:
        """Makes the picture at least that large."""
        if width <= self._size[0] and height <= self._size[1]:
            return
        gl = self._gl
        if self._texture:
            gl.glDeleteTextures(1, [self._texture])
            self._texture = 0
        self._size = max(width, self._size[0]), max(height, self._size[1])
        if self._size[0] * self._size[1] > 2 * self.most_px:
            self._size = width, height
        self._texture = new_texture(self._gl, gl.GL_R32UI, self._size)
        gl.glBindFramebuffer(gl.GL_FRAMEBUFFER, self._frame)
        gl.glFramebufferTexture2D(
            gl.GL_FRAMEBUFFER, gl.GL_COLOR_ATTACHMENT0, gl.GL_TEXTURE_2D, self._texture, 0
        )
        if gl.glCheckFramebufferStatus(gl.GL_FRAMEBUFFER) != gl.GL_FRAMEBUFFER_COMPLETE:
            self._size = (0, 0)
            raise no_opengl("it cannot draw into words of 32 bits")

    def words(self, tiles: DeviceTiles) -> np.ndarray:
        """(H, W) uint32, the first block."""
        gl, (width, height) = self._gl, tiles.tiles.size
        words = np.empty((height, width), np.uint32)
        gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 4)
        gl.glReadPixels(0, 0, width, height, gl.GL_RED_INTEGER, gl.GL_UNSIGNED_INT, address(words))
        return words
