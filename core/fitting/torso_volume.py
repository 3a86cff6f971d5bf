"""Whether a limb has entered the torso.

The torso is taken as one ellipsoid per torso segment, inscribed in the segment's box. Points of a
limb beyond its first joint may not lie inside (SPEC §5: such candidates are dropped before any
evaluation).
"""

from dataclasses import dataclass, field

import numpy as np

from ..body.body import Body, Part

_SHARE = 0.75
"""Size of the forbidden core relative to the segment's box: flesh gives way, ribs do not."""


@dataclass(frozen=True, eq=False)
class TorsoVolume:
    """Ellipsoids of the torso's segments, in the spaces of their joints.

    Attributes:
        body: whose torso.
        joints: (K,) joint of each ellipsoid.
        centres: (K, 3) metres.
        radii: (K, 3) metres.
    """

    body: Body
    joints: np.ndarray
    centres: np.ndarray
    radii: np.ndarray
    _chains: dict[Part, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, body: Body) -> "TorsoVolume":
        """The torso of ``body``: every segment that belongs to no limb and no end."""
        moving = {s for part in body.parts if part.role in ("limb", "end") for s in part.segments}
        torso = [s for s in range(len(body.segment_names)) if s not in moving]
        surface = body.surfaces[0]
        boxes = [_box(surface.vertices[slice(*surface.vertex_starts[s : s + 2])]) for s in torso]
        centres = np.array([(low + high) / 2 for low, high in boxes]).reshape(-1, 3)
        radii = np.array([_SHARE * (high - low) / 2 for low, high in boxes]).reshape(-1, 3)
        return cls(body, body.segment_joints[torso], centres, radii)

    def holds_part(self, transforms: np.ndarray, part: Part) -> np.ndarray:
        """(N,) bool: whether a bone of the part, beyond its first joint, reaches inside.

        Asked of the bones' joints, middles and ends; ``transforms`` (N, J, 3, 4) are
        world_from_joint of the candidates.
        """
        chain, tips = self._chain(part)
        carried = transforms[:, chain]
        tails = (carried[..., :3] @ tips)[..., 0] + carried[..., 3]
        joints = carried[:, 1:, :, 3]
        points = np.concatenate([joints, (joints + tails[:, 1:]) / 2, tails], axis=1)
        torso = transforms[:, self.joints]
        # rows times the rotation: the inverse turn
        local = (points[:, None] - torso[:, :, None, :, 3]) @ torso[..., :3]
        depths = (((local - self.centres[:, None]) / self.radii[:, None]) ** 2).sum(axis=3)
        return depths.min(axis=(1, 2)) < 1.0

    def _chain(self, part: Part) -> tuple[np.ndarray, np.ndarray]:
        """The part's joints, and the ends of their bones as columns (n, 3, 1)."""
        known = self._chains.get(part)
        if known is None:
            chain = np.unique(self.body.segment_joints[list(part.segments)])
            known = self._chains[part] = chain, self.body.tails[chain][..., None]
        return known


def _box(vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return vertices.min(axis=0), vertices.max(axis=0)
