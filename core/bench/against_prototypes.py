"""Our kernel beside the frozen prototypes, on their body, in their cameras, in one run."""

from collections.abc import Callable

import numpy as np

from ..energy.weight_maps import xor_weight_maps
from ..errors import MocapError
from ..rendering.native import NativeEvaluator
from ..silhouettes.silhouette import Silhouette
from .machine import code_path
from .prototypes import LISTS, PARITY, WINDING, Asked, Prototypes, their_poses
from .rows import EXACT, LOD
from .stage import PART_SPREAD, WHOLE_SPREAD, candidates_about
from .turns import Rates, Turns, Variant, measured

V3, ON_V3 = 3, "_v3"
"""The code path for x86-64-v3, which many processors have at best, and the ending of its rows."""
PARTS = {"whole": tuple(range(16)), "limb": (4, 5, 6), "hand": (6,)}
WINDOW_SIDES = {"whole": None, "limb": 128, "hand": 64}
METHODS = {"winding": WINDING, "parity": PARITY, "lists": LISTS}
GL_EVAL = "prototype_gl_eval_paper"
KERN_EXACT = "prototype_kern_c_full_winding"
KERN_COARSE = tuple(f"prototype_kern_c_coarse_{method}" for method in METHODS)
_SEEN, _POSE = 10, 12


def prototype_rates(
    prototypes: Prototypes,
    size: tuple[int, int],
    part: str,
    turns: Turns,
    note: Callable[[str], None],
) -> Rates:
    """All rows for one of `PARTS` at one size (width, height)."""
    return _Comparison(prototypes, size, part).rates(turns, note)


def title(name: str) -> str:
    """A row's name in tables."""
    for level, mesh in ((EXACT, "full"), (LOD, "coarse")):
        if name == level + ON_V3:
            return f"native, {mesh} mesh, x86-64-v3"
    words = name.removeprefix("prototype_").replace("kern_c_", "kern.c, ").replace("_", " ")
    if name == GL_EVAL:
        return "prototype gl_eval.py, as in the paper, full mesh"
    mesh, _, method = words.removeprefix("kern.c, ").partition(" ")
    return f"prototype kern.c, {mesh} mesh, {method}"


class _Comparison:
    """One part at one size: the silhouettes, and every row's way to the energies."""

    def __init__(self, prototypes: Prototypes, size: tuple[int, int], part: str):
        self.prototypes, self.part = prototypes, part
        self.body, self.cameras = prototypes.body(), prototypes.cameras(size)
        self.native = {
            EXACT: NativeEvaluator(self.body, self.cameras, 1),
            LOD: NativeEvaluator(self.body, self.cameras, 0),
        }
        if code_path() > V3:
            self.native |= {
                EXACT + ON_V3: NativeEvaluator(self.body, self.cameras, 1, processor=V3),
                LOD + ON_V3: NativeEvaluator(self.body, self.cameras, 0, processor=V3),
            }
        seen, self.pose = (their_poses(prototypes.scene.pose(t)) for t in (_SEEN, _POSE))
        rest = [s for s in range(16) if s not in PARTS[part]]
        fixed = self._drawn(self.pose, rest) if rest else None
        self.asked = Asked(size, self._drawn(seen), fixed, PARTS[part])

    def rates(self, turns: Turns, note: Callable[[str], None]) -> Rates:
        whole = self.part == "whole"
        moved = range(35) if whole else self.prototypes.dofs_of(self.asked.segments)
        spread = WHOLE_SPREAD if whole else PART_SPREAD
        variants = [*self._native_variants(), *self._kernel_variants()]
        try:
            variants.append(self._paper_variant())
        except MocapError as error:
            note(str(error))
        return measured(variants, candidates_about(self.pose, moved, spread, turns.poses), turns)

    def _native_variants(self) -> list[Variant]:
        seen = np.ones(self.asked.observed.shape[1:], bool)
        maps = xor_weight_maps([Silhouette(p.view(bool), seen) for p in self.asked.observed])
        found = []
        for name, evaluator in self.native.items():
            weights, segments = evaluator.prepared(maps), None
            if self.asked.fixed is not None:
                segments = self.asked.segments
                weights = evaluator.masked(weights, self.pose, segments)
            found.append(
                Variant(
                    name,
                    lambda poses, e=evaluator, w=weights, s=segments: e.energies(w, poses, s).sum(
                        axis=1
                    ),
                )
            )
        return found

    def _kernel_variants(self) -> list[Variant]:
        found = []
        for mesh in ("full", "coarse"):
            for name, method in METHODS.items():
                energies, ready = self.prototypes.energies(mesh, method, self.asked)
                middle = their_poses(self.pose)
                found.append(
                    Variant(
                        f"prototype_kern_c_{mesh}_{name}",
                        energies,
                        lambda poses: their_poses(poses).astype(np.float32),
                        (lambda r=ready, q=middle: r(q)) if method == LISTS else tuple,
                    )
                )
        return found

    def _paper_variant(self) -> Variant:
        exact, side = self.native[EXACT], WINDOW_SIDES[self.part]
        windows = None
        if side is not None:
            box = exact.bounds(self.pose[None], self.asked.segments)[0]
            half = side * self.asked.size[1] // 480
            middles = (box[:, :2] + box[:, 2:]) // 2
            windows = np.concatenate([middles - half, middles + half], axis=1)

        def transforms(pose: np.ndarray) -> np.ndarray:
            return exact.transforms(their_poses(pose)[None])[0]

        energies = self.prototypes.paper_energies(self.asked, windows, transforms)
        return Variant(GL_EVAL, energies, their_poses)

    def _drawn(self, pose: np.ndarray, segments=None) -> np.ndarray:
        """(8, H, W) uint8 silhouettes of the full mesh."""
        return np.stack(self.native[EXACT].silhouettes(pose, segments)).astype(np.uint8)
