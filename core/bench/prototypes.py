"""Frozen prototypes as a measuring stick: their mesh as a body, their kernels as callables.

They lie in a folder of their own, which is no part of this product; without it their rows are left
out. ``kern.c`` is compiled into a temporary folder. ``scene.py`` asks for numba, for a rasteriser
that is not called here: a stand-in is enough.
"""

import ctypes
import importlib
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np

from ..body.body import Body, Dofs, Surface
from ..cameras.camera import Camera
from ..errors import MocapError

FILES = ("kern.c", "scene.py", "ck.py", "gl_eval.py")
WINDING, PARITY, LISTS = 2, 3, 4
_FLAGS = ("-O3", "-march=x86-64-v3", "-ffast-math", "-shared", "-fPIC")
_ROOT_ORDER = [0, 1, 2, 5, 4, 3]  # they turn about z, then y, then x, but store x, y, z
_LIST_REACH = 0.2
_BITS = 0  # their reduction by counting bits


def are_in(folder: Path | None) -> bool:
    """Whether ``folder`` holds the prototypes."""
    return folder is not None and all((folder / name).is_file() for name in FILES)


@dataclass(frozen=True, eq=False)
class Asked:
    """What is compared.

    Attributes:
        size: (width, height) px.
        observed: (8, H, W) uint8 silhouettes.
        fixed: likewise, of what stands still; None for nothing.
        segments: that move.
    """

    size: tuple[int, int]
    observed: np.ndarray
    fixed: np.ndarray | None
    segments: Sequence[int]


class Prototypes:
    """The prototypes' modules, imported from ``folder``; what they write goes to ``scratch``.

    Raises:
        MocapError: no compiler, or one that cannot compile them.
    """

    def __init__(self, folder: Path, scratch: Path):
        # -ffast-math makes the processor flush subnormals from when the library is loaded on
        for kind in (np.float32, float):
            np.finfo(kind)
        self.folder, self.scratch = folder.resolve(), scratch
        _compile(self.folder / "kern.c", scratch / "kern_native.so")
        with self._imports():
            self.scene = importlib.import_module("scene")
            self.kernel = importlib.import_module("ck")
        self.meshes = {"full": self.scene.build(), "coarse": self.scene.build(True)}

    def energies(self, mesh: str, method: int, asked: "Asked"):
        """``kern.c`` as a function of (n, 35) float32 poses, and what readies its lists.

        Args:
            mesh: full or coarse.
            method: `WINDING`, `PARITY` or `LISTS`.
            asked: what is compared.
        """
        # all meshes share the lists that the first one asks for: the full mesh must be the first
        with _working_folder(self.scratch):
            kernel = self.kernel.Ev(self.meshes[mesh], *asked.size, asked.observed, asked.fixed)
        chosen = np.array(asked.segments, np.int32)
        total = np.zeros(1, np.int64)

        def ready(pose: np.ndarray) -> None:
            middle = np.ascontiguousarray(pose, np.float32)
            kernel.lib.build_lists(
                kernel.pc, middle.ctypes.data_as(ctypes.c_void_p), ctypes.c_float(_LIST_REACH),
                total.ctypes.data_as(ctypes.c_void_p),
            )  # fmt: skip

        def energies(poses: np.ndarray) -> np.ndarray:
            return kernel.batch(poses, chosen, method, _BITS)

        return energies, ready

    def paper_energies(
        self, asked: "Asked", windows: np.ndarray | None, transforms: Callable
    ) -> Callable[[np.ndarray], np.ndarray]:
        """``gl_eval.py`` as in the paper: stencil, read-back and windows on the full mesh.

        Args:
            asked: what is compared.
            windows: (8, 4) corners in px; None for whole pictures.
            transforms: a pose (35,) to (16, 3, 4), in place of their own, which needs numba.

        Raises:
            MocapError: OpenGL does not work here.
        """
        setattr(self.scene, "fk", transforms)  # noqa: B010
        boxes = None
        if windows is not None:
            sides = [(x0, y0, x1 - x0, y1 - y0) for x0, y0, x1, y1 in windows.tolist()]
            boxes = [_inside(box, asked.size) for box in sides]
        try:
            with self._imports():
                gl = importlib.import_module("gl_eval")
            gl.init()
            compared = asked.observed, asked.fixed, boxes
            paper = gl.Paper(self.meshes["full"], *asked.size, *compared)
        except Exception as error:
            raise MocapError(f"gl_eval.py fails ({type(error).__name__}: {error})") from error
        chosen = np.array(asked.segments, np.int32)
        return lambda poses: np.array([paper.eval(pose, chosen) for pose in poses])

    def body(self) -> Body:
        """The prototypes' body, coarse surface first."""
        scene = self.scene
        count = scene.NDOF
        joints = np.repeat(np.arange(scene.NSEG), np.diff(scene.dstart))
        dofs = Dofs(
            names=tuple(f"dof_{i}" for i in range(count)),
            joints=np.concatenate([np.zeros(6, int), joints]),
            kinds=np.array([0] * 3 + [1] * (count - 3)),
            axes=np.concatenate([np.eye(3), np.eye(3)[::-1], scene.axes[6:]]),
            limits=np.tile([-np.inf, np.inf], (count, 1)),
            rest_spread=np.full(count, np.inf),
            directions=("",) * count,
        )
        names = tuple(segment[0] for segment in scene.SEG)
        return Body(
            name="prototype",
            joint_names=names,
            parents=scene.parent,
            offsets=scene.off,
            tails=np.zeros((scene.NSEG, 3)),
            dofs=dofs,
            cones={},
            segment_names=names,
            segment_joints=np.arange(scene.NSEG),
            surfaces=tuple(_surface(self.meshes[level]) for level in ("coarse", "full")),
            point_joints=np.zeros(14, int),
            point_offsets=np.zeros((14, 3)),
            parts=(),
        )

    def cameras(self, size: tuple[int, int]) -> tuple[Camera, ...]:
        """The prototypes' eight cameras, whose first pixel's centre lies at (0.5, 0.5)."""
        width, height = size
        focal = 366 * height / 240
        matrix = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]])
        shifted = matrix - np.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])
        return tuple(
            Camera(f"cam{i}", size, shifted, np.linalg.solve(matrix, projection))
            for i, projection in enumerate(self.scene.cameras(*size)[0])
        )

    def dofs_of(self, segments: Sequence[int]) -> range:
        """The DOFs, in their order and ours, of segments that follow each other."""
        starts = self.scene.dstart
        return range(int(starts[segments[0]]), int(starts[segments[-1] + 1]))

    @contextmanager
    def _imports(self) -> Iterator[None]:
        """Within, modules come from the folder, which is left as it is."""
        before, bytecode = sys.modules.get("numba"), sys.dont_write_bytecode
        stand_in = ModuleType("numba")
        stand_in.njit = _unchanged  # pyright: ignore[reportAttributeAccessIssue]
        sys.modules["numba"] = stand_in
        sys.path.insert(0, str(self.folder))
        sys.dont_write_bytecode = True
        try:
            yield
        finally:
            sys.path.remove(str(self.folder))
            sys.dont_write_bytecode = bytecode
            if before is None:
                del sys.modules["numba"]
            else:
                sys.modules["numba"] = before


def their_poses(poses: np.ndarray) -> np.ndarray:
    """(n, 35) poses of `Prototypes.body` in the prototypes' own order; and the other way."""
    order = [*_ROOT_ORDER, *range(6, poses.shape[-1])]
    return np.ascontiguousarray(poses[..., order])


def _unchanged(*words, **settings):
    """What stands in for numba's ``njit``, with arguments or without."""
    if len(words) == 1 and callable(words[0]):
        return words[0]
    return lambda function: function


def _compile(source: Path, library: Path) -> None:
    compiler = ["gcc"] if shutil.which("gcc") else [sys.executable, "-m", "ziglang", "cc"]
    words = [*compiler, *_FLAGS, str(source), "-o", str(library), "-lm"]
    run = subprocess.run(words, capture_output=True, text=True, check=False)
    if run.returncode:
        line = next(iter(run.stderr.splitlines()), f"exit code {run.returncode}")
        raise MocapError(f"cannot be compiled ({line})", "install gcc", file=source)


def _inside(box: tuple[int, int, int, int], size: tuple[int, int]) -> tuple[int, int, int, int]:
    """A window x, y, width, height, moved into the picture."""
    x, y, width, height = box
    width, height = min(width, size[0]), min(height, size[1])
    return min(max(x, 0), size[0] - width), min(max(y, 0), size[1] - height), width, height


def _surface(mesh) -> Surface:
    return Surface(mesh.V, mesh.F, mesh.vo, mesh.fo)


@contextmanager
def _working_folder(path: Path) -> Iterator[None]:
    """Within, relative paths start at ``path``: ck.py loads its library that way."""
    here = Path.cwd()
    os.chdir(path)
    try:
        yield
    finally:
        os.chdir(here)
