"""The benchmark of the skeleton from the contour: how far its joints are from the body's own.

The template `performer` stands in the pose of Jaume-i-Capó et al. 2012, upper arms lifted and
forearms hanging, before a stereo pair 30° apart as there, and before rings of more cameras;
silhouettes are disturbed as far as the noise ladder goes. The rules' fixed shifts were chosen with
this body, so that undisturbed errors tell how well views agree, not how alike people are.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ..body.body import POINT_NAMES, Body
from ..body.kinematics import points, rest_height
from ..body.templates import template
from ..cameras.camera import Camera
from ..cameras.presets import Ring, ring
from ..errors import MocapError
from ..initialisation.contour_rules.from_frames import ContourSettings, contour_skeleton
from ..initialisation.contour_rules.skeleton import JOINT_NAMES, ContourSkeleton, measured
from ..initialisation.pose_kinds import pose_of_kind
from ..motion.point_track import PointTrack
from ..progress import Progress
from ..rendering.native import NativeEvaluator
from .disturbances.ladder import LEVELS, noise_ladder
from .disturbances.recording import Recording, disturbed
from .stage import filmed

KIND = "elbows"
STEREO_DEG = 30.0
"""Between the two cameras of the pair."""
UNDISTURBED = "none"
JITTER = "boundary jitter"
KINDS_OF_NOISE = (JITTER, "erosion", "dilation", "holes", "limb dropout", "speckle")
"""The ladder's kinds that are wrong with silhouettes and do not move cameras."""


@dataclass(frozen=True)
class SkeletonSettings:
    """How much to measure.

    Attributes:
        counts: of cameras; 2 are the stereo pair.
        levels: of the noise ladder.
        frames: of each trial, their noise drawn anew.
        size: (width, height) of the pictures, px.
        focal_px: focal length.
    """

    counts: tuple[int, ...] = (2, 4, 8)
    levels: tuple[int, ...] = tuple(range(1, LEVELS + 1))
    frames: int = 6
    size: tuple[int, int] = (640, 480)
    focal_px: float = 500.0


QUICK = SkeletonSettings(counts=(2, 8), levels=(2,), frames=2)


@dataclass(frozen=True, eq=False)
class SkeletonTrial:
    """What became of one kind of noise at one level before some cameras.

    Attributes:
        count: of cameras.
        noise: its kind, or `UNDISTURBED`.
        level: 0 without.
        amount: in words.
        recording: what the cameras saw.
        skeleton: None where no frame showed the pose.
        fault: why not, in words.
        errors: (F, 9) mm from the truth; NaN in frames that do not show the pose.
    """

    count: int
    noise: str
    level: int
    amount: str
    recording: Recording
    skeleton: ContourSkeleton | None
    fault: str
    errors: np.ndarray

    @property
    def shown(self) -> int:
        """Frames that showed the pose."""
        return 0 if self.skeleton is None else int(self.skeleton.shown.sum())


@dataclass(frozen=True, eq=False)
class SkeletonFigures:
    """Everything that was measured.

    Attributes:
        trials: in the order of noise, level and cameras.
        true_measures: the body's own, metres, by name.
    """

    trials: tuple[SkeletonTrial, ...]
    true_measures: dict[str, float]


def skeleton_figures(settings: SkeletonSettings, progress: Progress) -> SkeletonFigures:
    """Measures all of it."""
    body = template("performer")
    pose = pose_of_kind(body, KIND)
    trials = [trial for count in settings.counts for trial in _trials(body, pose, count, settings)]
    progress.begin("skeleton", len(trials))
    found = []
    for trial in sorted(trials, key=lambda t: (_place(t.noise), t.level, t.count)):
        found.append(_measured(trial, body, pose))
        progress.advance(None)
    own = measured(true_joints(body, pose)[None])
    return SkeletonFigures(tuple(found), {name: one.mean for name, one in own.items()})


def true_joints(body: Body, pose: np.ndarray) -> np.ndarray:
    """(9, 3) where the body's own `JOINT_NAMES` are in ``pose`` (D,), world metres."""
    places = points(body, pose[None])[0]
    known: dict[str, np.ndarray] = dict(zip(POINT_NAMES, places, strict=True))
    known["back"] = (known["left_hip"] + known["right_hip"]) / 2
    known["virtual_foot"] = (known["left_ankle"] + known["right_ankle"]) / 2
    return np.array([known[name] for name in JOINT_NAMES])


def _place(noise: str) -> int:
    return (UNDISTURBED, *KINDS_OF_NOISE).index(noise)


def _cameras(count: int, settings: SkeletonSettings) -> tuple[Camera, ...]:
    """A ring that no camera of looks exactly from the front; 2 are a pair before the performer."""
    of_ring = 12 if count == 2 else count
    first = -STEREO_DEG / 2 if count == 2 else 180.0 / (2 * count)
    layout = Ring(
        of_ring, heights=(1.0, 1.6), first_angle_deg=first, size=settings.size,
        focal_px=settings.focal_px,
    )  # fmt: skip
    return ring(layout)[:count]


def _recording(body: Body, pose: np.ndarray, cameras: tuple[Camera, ...], frames: int) -> Recording:
    seen = filmed(NativeEvaluator(body, cameras), pose)
    still = np.repeat(points(body, pose[None]), frames, axis=0)
    return Recording(
        cameras=cameras,
        frames=tuple(range(frames)),
        look=lambda frame, view: seen[view],
        truth=PointTrack(POINT_NAMES, np.arange(frames), still),
        fps=Fraction(15),
        floor=0.0,
    )


def _trials(
    body: Body, pose: np.ndarray, count: int, settings: SkeletonSettings
) -> Iterator[SkeletonTrial]:
    """What is to be measured with ``count`` cameras."""
    clean = _recording(body, pose, _cameras(count, settings), settings.frames)
    unknown = np.full((settings.frames, len(JOINT_NAMES)), np.nan)
    yield SkeletonTrial(count, UNDISTURBED, 0, "", clean, None, "", unknown)
    for rung in noise_ladder(clean, 0):
        if rung.kind in KINDS_OF_NOISE and rung.level in settings.levels:
            noisy = disturbed(clean, rung.level, *rung.disturbances)
            yield SkeletonTrial(count, rung.kind, rung.level, rung.amount, noisy, None, "", unknown)


def _measured(trial: SkeletonTrial, body: Body, pose: np.ndarray) -> SkeletonTrial:
    recording = trial.recording
    frames = tuple(recording.silhouettes(frame) for frame in recording.frames)
    known = ContourSettings(floor=recording.floor, height_m=rest_height(body))
    try:
        skeleton = contour_skeleton(recording.cameras, frames, KIND, settings=known)
    except MocapError as error:
        return replace(trial, fault=str(error))
    apart = np.linalg.norm(skeleton.joints - true_joints(body, pose), axis=2)
    return replace(trial, skeleton=skeleton, errors=1000 * apart)
