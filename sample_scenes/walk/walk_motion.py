"""The sample's motion: standing in the A-pose, then walking along a curve.

The feet are planned first: footprints along the path, each stance rolling over heel, sole and ball,
each swing a smooth arc between two stances; the legs follow by two-bone inverse kinematics, so the
feet do not slide. Pelvis, spine, clavicles, arms and head swing with the phase of the gait:
theta = 0 in the middle of a right swing, pi in the middle of a left one.
"""

from dataclasses import dataclass

import numpy as np
from walk_figure import SIDES, Performer

FPS = 15.0
FRAMES = 60
STILL_FRAMES = 8
START = STILL_FRAMES / FPS
BLEND = 0.5
STEP, SWING, FIRST_SWING = 0.58, 0.43, START + 0.36
SPEED, SPEED_RAMP = 0.95, 1.2
RADIUS = 1.75
STANDING_HALF_WIDTH, WALKING_HALF_WIDTH = 0.155, 0.055

POINTS = {
    "head": "head", "neck": "neck",
    "left_shoulder": "left_upper_arm", "right_shoulder": "right_upper_arm",
    "left_elbow": "left_forearm", "right_elbow": "right_forearm",
    "left_wrist": "left_hand", "right_wrist": "right_hand",
    "left_hip": "left_thigh", "right_hip": "right_thigh",
    "left_knee": "left_shank", "right_knee": "right_shank",
    "left_ankle": "left_foot", "right_ankle": "right_foot",
}  # fmt: skip
SKULL_CENTRE = np.array([0.0, -0.008, 0.092])


def turn(axis: str, degrees: float) -> np.ndarray:
    """(3, 3) right-handed rotation about a coordinate axis."""
    angle = np.deg2rad(degrees)
    c, s = np.cos(angle), np.sin(angle)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    rotation = np.eye(3)
    rotation[i, i], rotation[i, j], rotation[j, i], rotation[j, j] = c, -s, s, c
    return rotation


def eased(x: float) -> float:
    """Smooth step from 0 at x <= 0 to 1 at x >= 1."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def mixed(a: float, b: float, weight: float) -> float:
    """The value between ``a`` (weight 0) and ``b`` (weight 1)."""
    return a + (b - a) * weight


def distance_walked(time: float) -> float:
    """Arc length of the pelvis along the path, m; the speed is eased in."""
    x = max(time - START, 0.0) / SPEED_RAMP
    if x < 1.0:
        return SPEED * SPEED_RAMP * (x**3 - x**4 / 2.0)
    return SPEED * SPEED_RAMP * (x - 0.5)


def on_path(distance: float, left: float = 0.0) -> tuple[np.ndarray, float]:
    """Ground point (3,) ``left`` of the path, and the heading there in degrees from -Y to the left.

    The path is an arc that turns left, its chord centred on the world's origin.
    """
    angle = distance / RADIUS
    half = distance_walked(FRAMES / FPS) / RADIUS / 2.0
    middle = np.array([np.sin(half), -np.cos(half), 0.0])
    centre = -RADIUS * np.sin(half) * middle
    forward = np.array([np.sin(angle), -np.cos(angle), 0.0])
    sideways = np.array([np.cos(angle), np.sin(angle), 0.0])
    point = RADIUS * np.array([1.0 - np.cos(angle), -np.sin(angle), 0.0]) + centre
    return point + left * sideways, float(np.rad2deg(np.arctan2(forward[0], -forward[1])))


@dataclass(frozen=True, eq=False)
class Stance:
    """One foot on the ground from ``begin`` to ``end``.

    Attributes:
        begin, end: times, s.
        place: (3,) the ankle over the flat foot, m.
        heading: degrees from -Y to the left.
        landing: whether the heel comes first (not where the walk begins).
    """

    begin: float
    end: float
    place: np.ndarray
    heading: float
    landing: bool


def stances(side: str, ankle_height: float) -> list[Stance]:
    """All stances of one foot in order; right steps first."""
    sign = 1.0 if side == "left" else -1.0
    first = FIRST_SWING + (STEP if side == "left" else 0.0)
    up = np.array([0.0, 0.0, ankle_height])
    place, heading = on_path(0.0, sign * STANDING_HALF_WIDTH)
    found = [Stance(first - 0.80, first, place + up, heading + sign * 9.0, False)]
    while found[-1].end < FRAMES / FPS:
        begin = found[-1].end + SWING
        end = found[-1].end + 2.0 * STEP
        passed = distance_walked(begin + 0.44 * (end - begin))
        place, heading = on_path(passed, sign * WALKING_HALF_WIDTH)
        found.append(Stance(begin, end, place + up, heading + sign * 6.0, True))
    return found


def _rolled(stance: Stance, time: float, performer: Performer) -> tuple[np.ndarray, float]:
    """Ankle (3,) and pitch (toes up, degrees) of a foot that rolls over heel, sole and ball."""
    u = (time - stance.begin) / (stance.end - stance.begin)
    landing = 20.0 * (1.0 - eased(u / 0.16)) if stance.landing else 0.0
    pitch = landing - 52.0 * max((u - 0.55) / 0.45, 0.0) ** 1.8
    toes = performer.offsets["left_toes"]
    pivot = np.array([0.0, 0.05 if pitch > 0.0 else toes[1], -performer.ankle_height])
    flat = turn("z", stance.heading)
    return stance.place + flat @ (pivot - turn("x", -pitch) @ pivot), pitch


def foot(side: str, time: float, performer: Performer) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ankle (3,), world rotation of the foot and of the toes (3, 3) at one time."""
    plan = stances(side, performer.ankle_height)
    now = next((s for s in plan if time <= s.end), plan[-1])
    if time >= now.begin or now is plan[0]:
        ankle, pitch = _rolled(now, time, performer)
        bend, heading = max(-pitch, 0.0), now.heading
    else:
        before = plan[plan.index(now) - 1]
        v = (time - before.end) / SWING
        ankle, pitch = _swung(before, now, v, performer)
        heading = mixed(before.heading, now.heading, eased(v))
        bend = 52.0 * (1.0 - eased(v / 0.35))
    flat = turn("z", heading)
    return ankle, flat @ turn("x", -pitch), flat @ turn("x", -pitch - bend)


def _swung(before: Stance, after: Stance, v: float, performer) -> tuple[np.ndarray, float]:
    """Ankle and pitch at the fraction ``v`` of the swing between two stances: a Hermite arc."""
    p0, a0 = _rolled(before, before.end, performer)
    p1, a1 = _rolled(after, after.begin, performer)
    h = 0.01
    m0 = (p0 - _rolled(before, before.end - h, performer)[0]) / h * SWING
    m1 = (_rolled(after, after.begin + h, performer)[0] - p1) / h * SWING
    ankle = (
        (2 * v**3 - 3 * v**2 + 1) * p0 + (v**3 - 2 * v**2 + v) * m0
        + (3 * v**2 - 2 * v**3) * p1 + (v**3 - v**2) * m1
    )  # fmt: skip
    ankle[2] += 0.035 * np.sin(np.pi * v) ** 2
    return ankle, mixed(a0 - 8.0 * np.sin(np.pi * min(v / 0.5, 1.0)), a1, eased(v / 0.85))


def upper_body(time: float) -> dict[str, np.ndarray]:
    """Local rotations (3, 3) of pelvis (without heading), spine, head, clavicles and arms."""
    w = eased((time - START) / BLEND)
    theta = np.pi * (time - FIRST_SWING - SWING / 2.0) / STEP
    sway = w * np.sin(theta)
    lift = w * np.cos(theta + 0.5)
    yaw, drop = 5.0 * sway, -4.0 * lift
    back = w * 0.5 * np.cos(2.0 * theta)
    bones = {
        "pelvis": turn("z", yaw) @ turn("y", drop) @ turn("x", 3.0 * w),
        "lumbar": turn("z", -3.2 * sway) @ turn("y", -0.45 * drop) @ turn("x", 1.0 * w + 2 * back),
        "waist": turn("z", -3.4 * sway) @ turn("y", -0.40 * drop - 1.0 * w) @ turn("x", -1.0 * w),
        "chest": turn("z", -3.2 * sway) @ turn("y", -0.35 * drop - 1.0 * w) @ turn("x", w - back),
        "neck": turn("z", 2.4 * sway + 4.0 * w) @ turn("x", 4.0 - 3.0 * w),
        "head": turn("z", 2.4 * sway + 5.0 * w) @ turn("y", 1.5 * w) @ turn("x", -3.0 + back),
    }
    return bones | _arm("left", w, theta) | _arm("right", w, theta)


def _arm(side: str, w: float, theta: float) -> dict[str, np.ndarray]:
    """Local rotations (3, 3) of one arm: A-pose at ``w`` = 0, swinging against the leg at 1."""
    sign = 1.0 if side == "left" else -1.0
    swing = sign * w * np.sin(theta - 0.15)
    bend = sign * w * np.sin(theta - 0.45)
    lift, spread = mixed(9.0, 1.5, w), mixed(39.0, 9.0, w)
    upper = turn("x", -mixed(4.0, 1.0, w) - 21.0 * swing) @ turn("y", -sign * spread)
    elbow = mixed(6.0, 24.0, w) + 15.0 * bend
    return {
        f"{side}_clavicle": turn("z", -sign * 5.0 * swing) @ turn("y", -sign * lift),
        f"{side}_upper_arm": upper @ turn("z", -sign * 12.0 * w),
        f"{side}_forearm": turn("x", -elbow) @ turn("z", -sign * 10.0 * w),
        f"{side}_hand": turn("x", -6.0 * w - 4.0 * bend) @ turn("y", sign * 4.0 * w),
    }


def _leg(hip, ankle, forward, lengths) -> tuple[np.ndarray, np.ndarray]:
    """World rotations of thigh and shank whose knee points ``forward``, by the law of cosines."""
    to_ankle = ankle - hip
    reach = np.linalg.norm(to_ankle)
    axis = to_ankle / reach
    ahead = forward - axis * (forward @ axis)
    ahead /= np.linalg.norm(ahead)
    thigh, shank = lengths
    cosine = (thigh**2 + reach**2 - shank**2) / (2.0 * thigh * reach)
    knee = hip + thigh * (cosine * axis + np.sqrt(1.0 - min(cosine, 1.0) ** 2) * ahead)
    sideways = np.cross(ahead, axis)
    rotations = []
    for start, end in ((hip, knee), (knee, ankle)):
        up = (start - end) / np.linalg.norm(start - end)
        rotations.append(np.stack([sideways, np.cross(up, sideways), up], 1))
    return rotations[0], rotations[1]


def _pelvis(time: float, turned: np.ndarray, performer: Performer, ankles) -> np.ndarray:
    """Centre of the pelvis (3,): along the path, swaying over the standing foot, within reach."""
    w = eased((time - START) / BLEND)
    theta = np.pi * (time - FIRST_SWING - SWING / 2.0) / STEP
    reach = sum(np.linalg.norm(performer.offsets[f"left_{bone}"]) for bone in ("shank", "foot"))
    place, _ = on_path(distance_walked(time), w * 0.022 * np.cos(theta))
    height = performer.ankle_height + reach * mixed(0.988, 0.967 + 0.013 * np.cos(2.0 * theta), w)
    for side in SIDES:
        hip = place + turned @ performer.offsets[f"{side}_thigh"]
        flat = ankles[side][:2] - hip[:2]
        height = min(height, ankles[side][2] - hip[2] + np.sqrt((0.995 * reach) ** 2 - flat @ flat))
    return place + np.array([0.0, 0.0, height])


def posed(performer: Performer, frame: int) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """World rotations (3, 3) and joint positions (3,) of all bones at one frame.

    Positions are rounded to a micrometre and rotations to 1e-7, so that the last bit of a
    platform's sine cannot reach a mask.
    """
    time = frame / FPS
    local = upper_body(time)
    _, heading = on_path(distance_walked(time))
    feet = {side: foot(side, time, performer) for side in SIDES}
    rotations = {"pelvis": turn("z", heading) @ local["pelvis"]}
    centre = _pelvis(time, rotations["pelvis"], performer, {s: feet[s][0] for s in SIDES})
    positions = {"pelvis": centre}
    for bone in performer.bones[1:]:
        parent = performer.parents[bone]
        positions[bone] = positions[parent] + rotations[parent] @ performer.offsets[bone]
        if bone in local:
            rotations[bone] = rotations[parent] @ local[bone]
            continue
        side, part = bone.split("_", 1)
        if part == "thigh":
            ankle, *ends = feet[side]
            forward = -rotations["pelvis"][:, 1] - 1.2 * ends[0][:, 1] * [1.0, 1.0, 0.0]
            lengths = [np.linalg.norm(performer.offsets[f"{side}_{b}"]) for b in ("shank", "foot")]
            legs = _leg(positions[bone], ankle, forward / np.linalg.norm(forward), lengths)
            below = dict(zip(("thigh", "shank", "foot", "toes"), (*legs, *ends), strict=True))
            rotations |= {f"{side}_{name}": rotation for name, rotation in below.items()}
    return (
        {bone: np.round(rotations[bone], 7) for bone in performer.bones},
        {bone: np.round(positions[bone], 6) for bone in performer.bones},
    )


def truth_points(rotations: dict, positions: dict) -> tuple[np.ndarray, np.ndarray]:
    """Points (14, 3) in world metres and the rotations (14, 3, 3) of the bones that carry them."""
    points = np.array([positions[bone] for bone in POINTS.values()])
    points[0] += rotations["head"] @ SKULL_CENTRE
    return points, np.array([rotations[bone] for bone in POINTS.values()])
