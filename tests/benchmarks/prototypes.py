"""The frozen prototypes as a measuring stick: their mesh as a body, their kernels as callables.

The folder of prototypes is not part of this repository. ``kern.c`` is compiled at run time into a
temporary folder; ``scene.py`` needs numba, ``gl_eval.py`` EGL.
"""

import ctypes
import importlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from silhouette_mocap.core.body.body import Body, Dofs, Surface
from silhouette_mocap.core.cameras.camera import Camera

ROOT_ORDER = [0, 1, 2, 5, 4, 3]
"""The prototypes turn the root about z, then y, then x, but store x, y, z."""


class Prototypes:
    """The prototypes' modules, imported from ``folder`` what they write goes to ``scratch``."""

    def __init__(self, folder: Path, scratch: Path):
        flags = ["-O3", "-march=x86-64-v3", "-ffast-math", "-shared", "-fPIC"]
        library = scratch / "kern_native.so"
        subprocess.run(
            ["gcc", *flags, str(folder / "kern.c"), "-o", str(library), "-lm"], check=True
        )
        os.environ.setdefault("NUMBA_CACHE_DIR", str(scratch))
        sys.dont_write_bytecode = True
        sys.path.insert(0, str(folder))
        here = Path.cwd()
        os.chdir(scratch)  # ck.py loads its library from the working folder
        try:
            self.scene = importlib.import_module("scene")
            self.kernel = importlib.import_module("ck")
            ctypes.CDLL(str(library))
        finally:
            os.chdir(here)
        self.scratch = scratch
        self.meshes = {"full": self.scene.build(), "coarse": self.scene.build(True)}

    def evaluator(self, mesh: str, size: tuple[int, int], observed, fixed):
        """kern.c with the given silhouettes (V, H, W) and pre-rendered fixed parts."""
        here = Path.cwd()
        os.chdir(self.scratch)
        try:
            return self.kernel.Ev(self.meshes[mesh], *size, observed, fixed)
        finally:
            os.chdir(here)

    def gl_evaluator(self, size, observed, fixed, window_px: int | None, pose, segments):
        """gl_eval.py as in the paper: stencil, read-back, windows; full mesh."""
        gl = importlib.import_module("gl_eval")
        gl.init()
        mesh, (projections, _) = self.meshes["full"], self.scene.cameras(*size)
        windows = window_px and gl.windows(
            mesh, self.scene.fk(pose), projections, *size, segments, window_px
        )
        return gl.Paper(mesh, *size, observed, fixed, windows)

    def silhouettes(self, size, pose, segments=None) -> np.ndarray:
        """(V, H, W) uint8 by the prototypes' reference."""
        projections, _ = self.scene.cameras(*size)
        transforms = self.scene.fk(pose)
        return self.scene.ref_masks(self.meshes["full"], transforms, projections, *size, segments)

    def body(self) -> Body:
        """The prototypes' body, coarse surface first."""
        scene = self.scene
        axes = np.concatenate([np.eye(3), np.eye(3)[::-1], scene.axes[6:]])
        joints = np.repeat(np.arange(scene.NSEG), np.diff(scene.dstart))
        count = scene.NDOF
        dofs = Dofs(
            names=tuple(f"dof_{i}" for i in range(count)),
            joints=np.concatenate([np.zeros(6, int), joints]),
            kinds=np.array([0] * 3 + [1] * (count - 3)),
            axes=axes,
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
            surfaces=tuple(self._surface(self.meshes[level]) for level in ("coarse", "full")),
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

    @staticmethod
    def our_poses(poses: np.ndarray) -> np.ndarray:
        """Poses in the order of `body`'s DOF table."""
        return np.ascontiguousarray(np.concatenate([poses[:, ROOT_ORDER], poses[:, 6:]], axis=1))

    @staticmethod
    def _surface(mesh) -> Surface:
        return Surface(mesh.V, mesh.F, mesh.vo, mesh.fo)
