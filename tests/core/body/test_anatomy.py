"""The bodies against what anyone can check on himself, and against published proportions."""

import numpy as np
import pytest
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.body.kinematics import points, rest_height, within_limits, world_vertices
from silhouette_mocap.core.body.templates.landmarks import PALM, UP
from silhouette_mocap.core.body.templates.skeleton import hanging_cone, swing_axes

STATURE = 1.75


def posed(body, **degrees):
    pose = body.rest_pose
    for name, value in degrees.items():
        pose[body.dofs.names.index(name)] = np.radians(value)
    return pose


def place(body, pose, name):
    return points(body, pose[None])[0, POINT_NAMES.index(name)]


def shift(body, point, **degrees):
    """How far a point moves from the rest pose to another."""
    return place(body, posed(body, **degrees), point) - place(body, body.rest_pose, point)


def tip(body, segment, pose, direction):
    """The vertex of a segment that is farthest in the rest pose along a direction, in a pose."""
    s = body.segment_names.index(segment)
    starts = body.surfaces[-1].vertex_starts
    chosen = slice(starts[s], starts[s + 1])
    rest = world_vertices(body, body.rest_pose)[chosen]
    farthest = np.argmax(rest @ direction)
    return world_vertices(body, pose)[chosen][farthest] - rest[farthest]


@pytest.mark.parametrize("side", ["left", "right"])
def test_arms_move_the_way_their_dofs_are_called(body, side):
    out = 1 if side == "left" else -1
    wrist = f"{side}_wrist"

    def moved(point, **degrees):
        return shift(body, point, **{f"{side}_{name}": v for name, v in degrees.items()})

    assert moved(wrist, elbow_flexion=60)[1] < -0.15
    assert moved(wrist, elbow_flexion=60)[2] > 0.05
    assert moved(wrist, shoulder_flexion=30)[1] < -0.2
    assert moved(wrist, shoulder_abduction=30)[2] > 0.15
    assert moved(wrist, shoulder_abduction=-45)[0] * out < -0.3
    bent = place(body, posed(body, **{f"{side}_elbow_flexion": 90}), wrist)
    turned = posed(body, **{f"{side}_elbow_flexion": 90, f"{side}_shoulder_twist": 40})
    assert (place(body, turned, wrist) - bent)[0] * out < -0.05


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("name", ["performer", "sixteen_segment", "eleven_segment"])
def test_legs_move_the_way_their_dofs_are_called(bodies, name, side):
    body, out = bodies[name], 1 if side == "left" else -1
    knee, ankle = f"{side}_knee", f"{side}_ankle"

    def moved(point, **degrees):
        return shift(body, point, **{f"{side}_{name}": v for name, v in degrees.items()})

    assert moved(knee, hip_flexion=60)[1] < -0.3
    assert moved(knee, hip_flexion=60)[2] > 0.15
    assert moved(knee, hip_abduction=30)[0] * out > 0.15
    assert moved(ankle, knee_flexion=60)[1] > 0.3
    assert moved(ankle, knee_flexion=60)[2] > 0.15


def test_spine_and_head_move_the_way_their_dofs_are_called(performer_body):
    body = performer_body
    for joint in ("waist", "chest", "neck"):
        assert shift(body, "head", **{f"{joint}_flexion": 20})[1] < -0.02
        assert shift(body, "head", **{f"{joint}_lateral": 20})[0] > 0.02
    for joint in ("waist", "chest"):
        assert shift(body, "left_shoulder", **{f"{joint}_twist": 20})[1] > 0.04
    nose = np.array([0.0, -1.0, 0.0])
    assert tip(body, "head", posed(body, head_turn=30), nose)[0] > 0.03
    assert tip(body, "head", posed(body, head_nod=20), nose)[2] < -0.02
    assert tip(body, "head", posed(body, neck_twist=30), nose)[0] > 0.03
    assert shift(body, "left_shoulder", left_clavicle_elevation=20)[2] > 0.04
    assert shift(body, "right_shoulder", right_clavicle_protraction=20)[1] < -0.04


@pytest.mark.parametrize("side", ["left", "right"])
def test_hands_and_feet_move_the_way_their_dofs_are_called(performer_body, side):
    body, out = performer_body, np.array([1 if side == "left" else -1, 1, 1])
    hand = out * (1, 0, -1)
    palm = out * PALM
    thumb = np.array([0.0, -1.0, 0.0])

    def moved(segment, direction, **degrees):
        pose = posed(body, **{f"{side}_{name}": v for name, v in degrees.items()})
        return tip(body, f"{side}_{segment}", pose, direction)

    assert moved("hand", hand, wrist_flexion=40) @ palm > 0.05
    assert moved("hand", hand, wrist_deviation=20)[1] > 0.03
    assert moved("hand", thumb, forearm_twist=60) @ palm > 0.02
    assert moved("foot", thumb, ankle_flexion=20)[2] > 0.02
    assert moved("foot", -out * (1, 0, 0), ankle_inversion=20)[2] > 0.005
    assert moved("toes", thumb, toes_extension=30)[2] > 0.02


@pytest.mark.parametrize("side", ["left", "right"])
def test_joints_of_three_angles_move_the_way_their_dofs_are_called(bodies, side):
    body, out = bodies["eleven_segment"], np.array([1 if side == "left" else -1, 1, 1])
    out_down, front = out * (1, 0, -1), np.array([0.0, -1.0, 0.0])

    def moved(segment, direction, **degrees):
        pose = posed(body, **{f"{side}_{name}": v for name, v in degrees.items()})
        return tip(body, f"{side}_{segment}", pose, direction)

    assert moved("lower_arm", out_down, elbow_lateral=5) @ (out * (1, 0, 1)) > 0.02
    assert moved("lower_arm", front, forearm_twist=60) @ (out * PALM) > 0.02
    assert (moved("lower_leg", -UP, knee_lateral=5) * out)[0] > 0.02
    assert (moved("lower_leg", front, knee_twist=20) * out)[0] < -0.02
    assert shift(body, "head", waist_lateral=20)[0] > 0.1
    assert shift(body, "left_shoulder", waist_twist=20)[1] > 0.04
    twisted = posed(bodies["nine_joint"], **{f"{side}_elbow_twist": 5})
    assert tip(bodies["nine_joint"], f"{side}_hand", twisted, front) @ (out * PALM) > 0.002


def test_the_root_turns_left_and_tilts_left_and_forwards(body):
    assert shift(body, "left_shoulder", root_yaw=30)[1] > 0.05
    assert shift(body, "head", root_roll=30)[0] > 0.2
    assert shift(body, "head", root_pitch=30)[1] < -0.2


def test_the_rest_pose_is_an_a_pose_on_the_floor_looking_along_minus_y(body):
    rest = body.rest_pose
    upper = place(body, rest, "left_elbow") - place(body, rest, "left_shoulder")
    fore = place(body, rest, "left_wrist") - place(body, rest, "left_elbow")
    np.testing.assert_allclose(upper / np.linalg.norm(upper), (0.5**0.5, 0, -(0.5**0.5)), atol=1e-9)
    np.testing.assert_allclose(np.cross(upper, fore), 0, atol=1e-12)
    vertices = world_vertices(body, rest)
    assert vertices[:, 2].min() == pytest.approx(0, abs=1e-6)
    feet = vertices[vertices[:, 2] < 0.02]
    assert feet[:, 1].min() < -0.15 < 0.04 < feet[:, 1].max()


@pytest.mark.parametrize(
    ("point", "low", "high"),
    [
        ("head", 0.93, 0.96),
        ("neck", 0.84, 0.87),
        ("left_shoulder", 0.79, 0.82),
        ("left_hip", 0.52, 0.54),
        ("left_knee", 0.28, 0.30),
        ("left_ankle", 0.039, 0.047),
    ],
)
def test_joint_heights_are_an_adults(body, point, low, high):
    assert low < place(body, body.rest_pose, point)[2] / STATURE < high


@pytest.mark.parametrize(
    ("a", "b", "share"),
    [
        # Joint centre distances of de Leva 1996, means of men and women, per stature.
        ("left_shoulder", "left_elbow", 0.160),
        ("left_elbow", "left_wrist", 0.153),
        ("left_hip", "left_knee", 0.227),
        ("left_knee", "left_ankle", 0.251),
        ("left_hip", "right_hip", 0.100),
        ("left_shoulder", "right_shoulder", 0.200),
    ],
)
def test_bone_lengths_are_an_adults(body, a, b, share):
    distance = np.linalg.norm(place(body, body.rest_pose, a) - place(body, body.rest_pose, b))
    assert distance / STATURE == pytest.approx(share, rel=0.08)


def test_the_average_adult_is_175_cm_tall_and_displaces_about_70_litres(body):
    assert rest_height(body) == pytest.approx(STATURE, abs=0.002)
    rng = np.random.default_rng(6)
    vertices = world_vertices(body, body.rest_pose, 0)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    samples = rng.uniform(low, high, (4000, 3))
    share = (winding_numbers(vertices, body.surfaces[0].triangles, samples) > 0.5).mean()
    assert 60 < 1000 * share * np.prod(high - low) < 80


def winding_numbers(vertices, triangles, samples):
    """How often closed meshes enclose points: signed crossings of rays along +z."""
    counts = np.zeros(len(samples))
    for (ax, ay, az), (bx, by, bz), (cx, cy, cz) in vertices[triangles]:
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0:
            continue
        v = ((samples[:, 0] - ax) * (cy - ay) - (samples[:, 1] - ay) * (cx - ax)) / area
        w = ((bx - ax) * (samples[:, 1] - ay) - (by - ay) * (samples[:, 0] - ax)) / area
        above = az + v * (bz - az) + w * (cz - az) > samples[:, 2]
        counts += np.sign(area) * ((v >= 0) & (w >= 0) & (v + w < 1) & above)
    return counts


def both(**degrees):
    """The same values on the left and on the right."""
    return {f"{side}_{n}": v for n, v in degrees.items() for side in ("left", "right")}


def test_everyday_poses_are_within_the_limits(performer_body):
    body = performer_body
    poses = {
        "hanging": both(shoulder_abduction=-42),
        "T": both(shoulder_abduction=45),
        "overhead": both(shoulder_abduction=130),
        "forward": both(shoulder_flexion=88),
        "elbows": both(shoulder_abduction=40, shoulder_twist=90, elbow_flexion=90),
        "squat": both(hip_flexion=110, hip_abduction=15, knee_flexion=130, ankle_flexion=20),
        "bow": {"waist_flexion": 40, "chest_flexion": 30},
        "glance": {"neck_twist": 35, "head_turn": 30},
    }
    for name, degrees in poses.items():
        assert within_limits(body, posed(body, **degrees)[None]).all(), name


def test_broken_poses_are_beyond_the_limits(performer_body):
    body = performer_body
    poses = [
        {"left_elbow_flexion": -5},
        {"left_knee_flexion": -5},
        {"left_shoulder_flexion": -75, "left_shoulder_abduction": -75},
        {"left_hip_abduction": 80},
        {"left_wrist_flexion": 75, "left_wrist_deviation": 28},
    ]
    for degrees in poses:
        assert not within_limits(body, posed(body, **degrees)[None]).any(), degrees


def test_a_hanging_bone_gets_back_its_own_ranges():
    down = np.array([0.0, 0.0, -1.0])
    axes = swing_axes(down, np.array([0.0, -1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
    cone = np.degrees(hanging_cone(down, axes, (-30, 120), (-20, 40)))
    np.testing.assert_allclose(cone.min(axis=0), (-30, -20))
    np.testing.assert_allclose(cone.max(axis=0), (120, 40))


def test_bone_turned_by_abduction_shifts_the_abduction_range():
    for spread in (0.0, 30.0, 45.0):
        angle = np.radians(spread)
        bone = np.array([np.sin(angle), 0.0, -np.cos(angle)])
        axes = swing_axes(bone, np.array([0.0, -1.0, 0.0]), np.array([1.0, 0.0, 0.0]))
        cone = np.degrees(hanging_cone(bone, axes, (0, 1), (-30, 90)))
        assert cone[:, 1].min() == pytest.approx(-30 - spread, abs=0.2)
        assert cone[:, 1].max() == pytest.approx(90 - spread, abs=0.2)
