"""The performer's own shape: lengths and girths that explain the silhouettes of several frames.

Pose and shape are solved for together: Gauss-Newton steps in all poses and the one shape, of whose
normal equations the poses are eliminated frame by frame (Schur complement), in turns with descents
of the poses alone. Silhouettes alone leave much open, above all where a joint lies in a straight
limb; there the covariance of human shapes decides (`shape_model`). The frames' distances weigh as
so many independent ones: neighbours along an outline, and frames alike, err alike.

After Carranza, Theobalt, Magnor, Seidel: Free-viewpoint video of human actors, 2003, section 5,
who alternate between the two.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..body.body import Body
from ..body.kinematics import clamped
from ..cameras.camera import Camera
from ..energy.evaluator import Evaluator
from ..fitting.contour_descent import Descent, DescentSettings
from ..fitting.contour_targets import ContourTargets
from ..fitting.scores import metres_at
from ..fitting.tracker import EvaluatorFactory
from ..fitting.view_trust import view_weights
from ..silhouettes.silhouette import Silhouette
from .shape_equations import FrameEquations, ShapeEquations, Sighting
from .shape_model import ShapeModel

_ENOUGH = 3
"""Rounds at the narrowest reach, at least."""
_DECIMALS = 6
"""Of logarithms and poses: sums in another order, on more processors, shall not change the body."""


@dataclass(frozen=True)
class ShapeSettings:
    """How a shape is sought.

    Attributes:
        descent: of the poses alone.
        steps: of these in a round.
        reaches_m: of the first and of the last round.
        rounds: most of them.
        evidence: independent distances that all frames are worth together.
        longest: change of a logarithm in one round.
        still: logarithm; a round that changes less is the last one.
    """

    descent: DescentSettings = field(default_factory=DescentSettings)
    steps: int = 2
    reaches_m: tuple[float, float] = (0.1, 0.02)
    rounds: int = 12
    evidence: float = 300.0
    longest: float = 0.08
    still: float = 2e-3


@dataclass(frozen=True, eq=False)
class ShapeFit:
    """A body fitted to F frames.

    Attributes:
        template: what was begun with.
        body: the performer's.
        poses: (F, D).
        model: of the shape's S factors.
        logs: (S,) logarithms of the factors against the body that was begun with.
        deviations: (S,) how uncertain they are, standard deviations.
    """

    template: Body
    body: Body
    poses: np.ndarray
    model: ShapeModel
    logs: np.ndarray
    deviations: np.ndarray


def fitted_shape(
    body: Body,
    cameras: tuple[Camera, ...],
    frames: Sequence[Sequence[Silhouette]],
    poses: np.ndarray,
    make_evaluator: EvaluatorFactory,
    settings: ShapeSettings | None = None,
) -> ShapeFit:
    """The shape of the performer in F frames of V silhouettes, from ``body`` in ``poses`` (F, D).

    Raises:
        ValueError: no frame.
    """
    if not len(frames):
        raise ValueError("expected at least one frame")
    settings = settings or ShapeSettings()
    search = _Search(body, cameras, frames, poses, make_evaluator, settings)
    first, last = settings.reaches_m
    reaches = np.geomspace(first, last, settings.rounds - _ENOUGH).tolist()
    for reach in [*reaches, *([last] * _ENOUGH)]:
        longest = search.step(reach)
        if longest < settings.still:
            break
    return search.fit


class _Search:
    """The shape and the poses so far."""

    def __init__(
        self,
        body: Body,
        cameras: tuple[Camera, ...],
        frames: Sequence[Sequence[Silhouette]],
        poses: np.ndarray,
        make_evaluator: EvaluatorFactory,
        settings: ShapeSettings,
    ):
        self._template, self._model, self._settings = body, ShapeModel(body), settings
        self._make = lambda body: make_evaluator(body, cameras)
        self._evaluator = self._make(body)
        self._poses = list(np.round(poses, _DECIMALS))
        self._sightings = [
            _sighting(frame, metres_at(self._evaluator, pose), settings.descent.spacing_m)
            for frame, pose in zip(frames, self._poses, strict=True)
        ]
        self._targets = [
            ContourTargets(body, cameras, sighting.contours, sighting.metres)
            for sighting in self._sightings
        ]
        self._frames = frames
        self._logs = np.zeros(len(self._model))
        self._matrix = self._model.precision

    @property
    def fit(self) -> ShapeFit:
        """What was found."""
        deviations = np.sqrt(np.diag(np.linalg.inv(self._matrix)))
        body, poses = self._evaluator.body, np.stack(self._poses)
        return ShapeFit(self._template, body, poses, self._model, self._logs, deviations)

    def step(self, reach_m: float) -> float:
        """Moves the poses, then all together; returns the largest change of a logarithm."""
        descent = Descent(self._evaluator.body, self._evaluator, self._settings.descent)
        equations = ShapeEquations(self._model, self._evaluator, self._settings.descent)
        self._poses = [self._descended(descent, k, reach_m) for k in range(len(self._poses))]
        found = [
            equations.of(sighting, pose, targets.shares, reach_m)
            for sighting, targets, pose in zip(
                self._sightings, self._targets, self._poses, strict=True
            )
        ]
        solved = [
            _Eliminated.of(descent, pose, equations)
            for pose, equations in zip(self._poses, found, strict=True)
        ]
        share = self._settings.evidence / max(1, sum(e.count for e in found))
        self._matrix = self._model.precision + share * sum(s.matrix for s in solved)
        slope = self._model.precision @ self._logs + share * sum(s.slope for s in solved)
        change = -np.linalg.solve(self._matrix, slope)
        change /= max(1.0, np.abs(change).max() / self._settings.longest)
        change = np.round(change, _DECIMALS)
        poses = np.round([s.pose_after(change) for s in solved], _DECIMALS)
        body = self._evaluator.body
        self._poses = list(clamped(body, poses))
        self._logs = self._logs + change
        self._evaluator = self._make(self._model.changed(body, change))
        return float(np.abs(change).max())

    def _descended(self, descent: Descent, index: int, reach_m: float) -> np.ndarray:
        spacing_px = float((self._settings.descent.spacing_m / self._sightings[index].metres).max())
        pose, reaches = self._poses[index], np.full(self._settings.steps, reach_m)
        pose = descent.run(self._targets[index], spacing_px, pose, pose, reaches)
        self._targets[index].shares = _trust(self._evaluator, pose, self._frames[index])
        return pose


def _trust(evaluator: Evaluator, pose: np.ndarray, frame: Sequence[Silhouette]) -> np.ndarray:
    """(V,) how far each view is trusted, as far as a pose (D,) explains it, `view_weights`."""
    drawn = [p & s.observed for p, s in zip(evaluator.silhouettes(pose), frame, strict=True)]
    seen = [silhouette.foreground & silhouette.observed for silhouette in frame]
    apart = [np.count_nonzero(a ^ b) for a, b in zip(drawn, seen, strict=True)]
    shown = [np.count_nonzero(a) + np.count_nonzero(b) for a, b in zip(drawn, seen, strict=True)]
    return view_weights(np.array(apart), np.array(shown))


def _sighting(frame: Sequence[Silhouette], metres: np.ndarray, spacing_m: float) -> Sighting:
    spacings = (spacing_m / metres).tolist()
    return Sighting([s.contour.thinned(px) for s, px in zip(frame, spacings, strict=True)], metres)


@dataclass(frozen=True, eq=False)
class _Eliminated:
    """A frame's equations in the shape alone, its pose always the best for the shape.

    Attributes:
        pose: (D,) where they were made.
        best: (D,) change of the pose, the shape as it is.
        following: (D, S) change of the pose with the shape.
        matrix: (S, S).
        slope: (S,).
    """

    pose: np.ndarray
    best: np.ndarray
    following: np.ndarray
    matrix: np.ndarray
    slope: np.ndarray

    @classmethod
    def of(cls, descent: Descent, pose: np.ndarray, equations: FrameEquations) -> "_Eliminated":
        """Of a pose (D,); what would leave its limits is held."""
        count = len(pose)
        stiffness, force = descent.priors(pose, pose, equations.count)
        own = equations.matrix[:count, :count] + np.diag(stiffness)
        mixed, slopes = equations.matrix[:count, count:], equations.slope[:count] + force
        sought = -np.column_stack([slopes, mixed])
        free, change = np.ones(count, bool), np.zeros(sought.shape)
        while True:
            change[:] = 0
            change[free] = np.linalg.solve(own[np.ix_(free, free)], sought[free])
            to = pose + change[:, 0]
            stopped = free & (np.abs(clamped(descent.body, to[None])[0] - to) > 1e-9)
            if not stopped.any():
                break
            free &= ~stopped
        best, following = change[:, 0], change[:, 1:]
        return cls(
            pose=pose,
            best=best,
            following=following,
            matrix=equations.matrix[count:, count:] + mixed.T @ following,
            slope=equations.slope[count:] + mixed.T @ best,
        )

    def pose_after(self, logs: np.ndarray) -> np.ndarray:
        """(D,) the best pose once the shape's logarithms have changed by ``logs`` (S,)."""
        return self.pose + self.best + self.following @ logs
