"""How a body's shape can change: lengths of bones, widths and depths along them, sizes of ends.

All changes are factors, kept as logarithms; left and right share theirs. A bone's length moves the
joints at its end and stretches its segment along it; widths and depths stretch a segment across its
bone, at its ends and in its middle as told, in between linearly. Head, hands and feet change as a
whole; a skinned body, whose vertices belong to several bones, does so altogether. Any jointed body
can change like that, whatever it was made by.

How people differ is told by a covariance of these logarithms, made of what they have in common:
stature, which all share; build, which the girths share; limbs, which their bones share; what the
girths of a segment share; and what each has of its own. Bones differ by 4 to 6 % at equal stature,
girths by 10 to 20 % (ANSUR II, 2012: standard deviations of limb lengths and circumferences).
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..body.body import Body, Surface, unsided
from ..body.kinematics import world_vertices
from ..body.templates.landmarks import FORWARD, UP

_STATIONS = 3
_STATURE, _BUILD, _LIMB, _SEGMENT = 0.12, 0.12, 0.05, 0.08
_LENGTH, _SPINE, _SIZE, _PLACE, _GIRTH = 0.04, 0.05, 0.06, 0.06, 0.05
_ACROSS_M = 1e-3
"""From the parent's bone, by which a joint must lie for a place of its own."""


@dataclass(frozen=True)
class Factor:
    """One of the ways to change.

    Attributes:
        name: such as ``forearm width 2``.
        kind: ``length``, ``place``, ``size`` or ``girth``.
        shared: what its siblings share with it: a limb for a length, else a segment; or nothing.
        deviation: of its logarithm among people, beside all that is shared.
    """

    name: str
    kind: str
    shared: str
    deviation: float


@dataclass(frozen=True, eq=False)
class _Girths:
    """Where a segment's girths apply.

    Attributes:
        axes: (3, 3) rows along its bone, to its side, to its front.
        range: along the bone, of the surface, in lengths of the bone.
        factors: (3, stations) indices: of widths, and of depths in front and behind.
    """

    axes: np.ndarray
    range: tuple[float, float]
    factors: np.ndarray

    def shares(self, along: np.ndarray) -> np.ndarray:
        """(n, stations) of the stations at places (n,) along the bone, in its lengths."""
        low, high = self.range
        places = np.clip((along - low) / (high - low), 0, 1) * (_STATIONS - 1)
        return np.maximum(0, 1 - np.abs(places[:, None] - np.arange(_STATIONS)))


class ShapeModel:
    """The S ways in which a body can change; those of all bodies made from it are the same.

    Args:
        template: the body.

    Attributes:
        factors: S of them.
        precision: (S, S) inverse of the covariance of their logarithms among people.
    """

    def __init__(self, template: Body):
        self.factors: list[Factor] = []
        self._indices: dict[str, int] = {}
        self._whole = _whole_joints(template)
        self._bones = np.array([self._bone(template, j) for j in range(len(self._whole))])
        self._places = np.array([self._place(template, j) for j in range(len(self._whole))])
        self._girths = {
            segment: self._girths_of(template, segment)
            for segment, joint in enumerate(template.segment_joints.tolist())
            if not self._whole[joint]
        }
        self.precision = np.linalg.inv(self._covariance())

    def __len__(self) -> int:
        return len(self.factors)

    def bones(self, body: Body) -> dict[int, float]:
        """Index of each factor of a bone's length or an end's size -> its metres in ``body``."""
        lengths = np.linalg.norm(body.tails, axis=1)
        return {
            factor: float(lengths[joint])
            for joint, factor in enumerate(self._bones.tolist())
            if factor >= 0 and lengths[joint] > 0
        }

    def changed(self, body: Body, logs: np.ndarray) -> Body:
        """The body with its factors multiplied by exp(``logs``), (S,).

        Its soles stay where they are. Limits and rest priors stay; so does how far coarse outlines
        lie from fine ones.
        """
        factors = np.exp(np.append(logs, 0.0))
        offsets, tails = np.array(body.offsets), body.tails * factors[self._bones][:, None]
        for joint, parent in enumerate(body.parents.tolist()):
            if parent >= 0:
                along, across = self._split(body, joint)
                offsets[joint] = along * factors[self._bones[parent]]
                offsets[joint] += across * factors[self._places[joint]]
        moved = replace(
            body,
            offsets=offsets,
            tails=tails,
            point_offsets=body.point_offsets * factors[self._bones[body.point_joints]][:, None],
            surfaces=tuple(self._stretched(body, s, factors) for s in body.surfaces),
        )
        offsets[0] += UP * (_sole(body) - _sole(moved))
        return replace(moved, offsets=offsets)

    def joint_rates(self, body: Body, transforms: np.ndarray) -> np.ndarray:
        """(J, 3, S) m by which joints move with the logarithms, where transforms (J, 3, 4) are."""
        rates = np.zeros((len(body.joint_names), 3, len(self)))
        for joint, parent in enumerate(body.parents.tolist()):
            if parent < 0:
                continue
            rates[joint] = rates[parent]
            turn, parts = transforms[parent, :, :3], self._split(body, joint)
            for factor, part in zip((self._bones[parent], self._places[joint]), parts, strict=True):
                if factor >= 0:
                    rates[joint, :, factor] += turn @ part
        return rates

    def point_rates(
        self, body: Body, segment: int, points: np.ndarray, slopes: np.ndarray
    ) -> np.ndarray:
        """(n, S) changes, with the logarithms, of what has slopes (n, 3) at points (n, 3).

        Both are in the space of the joint of their segment; the joint stays.
        """
        joint = int(body.segment_joints[segment])
        rates, bone = np.zeros((len(points), len(self))), self._bones[joint]
        if self._whole[joint]:
            rates[:, bone] = (points * slopes).sum(axis=1)
            return rates
        girths = self._girths[segment]
        places = points @ girths.axes.T
        moved = places * (slopes @ girths.axes.T)
        if bone >= 0:
            rates[:, bone] = moved[:, 0]
        shares = girths.shares(places[:, 0] / np.linalg.norm(body.tails[joint]))
        ahead = places[:, 2] > 0
        by_row = (moved[:, 1], moved[:, 2] * ahead, moved[:, 2] * ~ahead)
        for factors, change in zip(girths.factors, by_row, strict=True):
            np.add.at(rates.T, factors, (shares * change[:, None]).T)
        return rates

    def _stretched(self, body: Body, surface: Surface, factors: np.ndarray) -> Surface:
        vertices = np.array(surface.vertices, float)
        for segment, (begin, end) in enumerate(pairwise(surface.vertex_starts)):
            joint, part = int(body.segment_joints[segment]), slice(begin, end)
            if self._whole[joint]:
                vertices[part] *= factors[self._bones[joint]]
                continue
            girths = self._girths[segment]
            places = vertices[part] @ girths.axes.T
            shares = girths.shares(places[:, 0] / np.linalg.norm(body.tails[joint]))
            width, front, back = np.exp(np.log(factors[girths.factors]) @ shares.T)
            places[:, 0] *= factors[self._bones[joint]]
            places[:, 1] *= width
            places[:, 2] *= np.where(places[:, 2] > 0, front, back)
            vertices[part] = places @ girths.axes
        return replace(surface, vertices=vertices)

    def _split(self, body: Body, joint: int) -> tuple[np.ndarray, np.ndarray]:
        """A joint's offset: what goes with its parent's bone, and what with its own factor."""
        offset = body.offsets[joint]
        if self._places[joint] < 0:
            return offset, np.zeros(3)
        along = _along(offset, body.tails[body.parents[joint]])
        return along, offset - along

    def _factor(self, name: str, kind: str, shared: str, deviation: float) -> int:
        if name not in self._indices:
            self._indices[name] = len(self.factors)
            self.factors.append(Factor(name, kind, shared, deviation))
        return self._indices[name]

    def _bone(self, body: Body, joint: int) -> int:
        """Index of the factor along a joint's bone, or of its whole; -1 where it has no bone."""
        name = unsided(_segment_of(body, joint))
        if _is_skinned(body):
            return self._factor("size", "size", "", _SIZE)
        if self._whole[joint]:
            return self._factor(f"{name} size", "size", "", _SIZE)
        if not body.tails[joint].any():
            return -1
        limb = _limb_of(body, joint)
        deviation = _LENGTH if limb else _SPINE
        return self._factor(f"{name} length", "length", limb, deviation)

    def _place(self, body: Body, joint: int) -> int:
        """Index of the factor of how far a joint lies from its parent's bone; -1 where on it."""
        parent = int(body.parents[joint])
        if parent < 0 or self._whole[parent]:
            return -1
        offset, bone = body.offsets[joint], body.tails[parent]
        if np.linalg.norm(offset - _along(offset, bone)) < _ACROSS_M:
            return -1
        return self._factor(f"{unsided(body.joint_names[joint])} place", "place", "", _PLACE)

    def _girths_of(self, body: Body, segment: int) -> _Girths:
        own, joint = body.segment_names[segment], int(body.segment_joints[segment])
        name, bone = unsided(own), body.tails[joint]
        begin, end = body.surfaces[-1].vertex_starts[segment : segment + 2]
        axes = _axes(bone)
        along = body.surfaces[-1].vertices[begin:end] @ axes[0] / np.linalg.norm(bone)
        kinds = ("width", "front", "back") if name == own else ("width", "depth", "depth")
        factors = [
            [
                self._factor(f"{name} {kind} {k + 1}", "girth", f"{name} {kind}", _GIRTH)
                for k in range(_STATIONS)
            ]
            for kind in kinds
        ]
        return _Girths(axes, (float(along.min()), float(along.max())), np.array(factors))

    def _covariance(self) -> np.ndarray:
        kinds = np.array([factor.kind for factor in self.factors])
        shared = np.array([factor.shared for factor in self.factors])
        same = (shared[:, None] == shared) & (shared != "")
        girth = np.outer(kinds == "girth", kinds == "girth")
        common = _STATURE**2 + _BUILD**2 * girth + np.where(girth, _SEGMENT, _LIMB) ** 2 * same
        return common + np.diag([factor.deviation**2 for factor in self.factors])


def _whole_joints(body: Body) -> np.ndarray:
    """(J,) bool, which joints' segments change as a whole: what ends move, and what has no bone."""
    if _is_skinned(body):
        return np.ones(len(body.joint_names), bool)
    ends = [dof for part in body.parts if part.role == "end" for dof in part.dofs]
    whole = np.isin(np.arange(len(body.joint_names)), body.dofs.joints[ends])
    for joint, parent in enumerate(body.parents.tolist()):
        carries = joint in body.segment_joints
        whole[joint] |= (parent >= 0 and whole[parent]) or (carries and not body.tails[joint].any())
    return whole


def _is_skinned(body: Body) -> bool:
    return any(surface.skin is not None for surface in body.surfaces)


def _limb_of(body: Body, joint: int) -> str:
    """The limb, without its side, whose segments a joint carries; nothing for the trunk's."""
    for part in body.parts:
        if part.role == "limb" and joint in body.segment_joints[list(part.segments)]:
            return unsided(part.name)
    return ""


def _segment_of(body: Body, joint: int) -> str:
    """Name of the first segment that a joint carries, else its own."""
    carried = np.flatnonzero(body.segment_joints == joint)
    return body.segment_names[carried[0]] if len(carried) else body.joint_names[joint]


def _along(vector: np.ndarray, bone: np.ndarray) -> np.ndarray:
    return bone * (vector @ bone) / max(float(bone @ bone), 1e-12)


def _axes(bone: np.ndarray) -> np.ndarray:
    """(3, 3) rows: unit vectors along a bone (3,), to its side and to its front."""
    along = bone / np.linalg.norm(bone)
    front = FORWARD if abs(along @ FORWARD) < 0.9 else UP
    front = front - along * (along @ front)
    front = front / np.linalg.norm(front)
    return np.stack([along, np.cross(front, along), front])


def _sole(body: Body) -> float:
    """Height of the lowest vertex in the rest pose."""
    return float(world_vertices(body, body.rest_pose)[:, 2].min())
