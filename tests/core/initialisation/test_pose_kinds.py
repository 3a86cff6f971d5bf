import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import points, within_limits
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.initialisation.pose_kinds import (
    POSE_KINDS,
    STANDING,
    all_stances,
    pose_of_kind,
    stance,
)
from synthetic import small_body

BODIES = ["performer", "sixteen_segment", "eleven_segment", "nine_joint"]


def place(body, pose, name):
    return points(body, pose[None])[0, body.point_names.index(name)]


@pytest.mark.parametrize("name", BODIES)
def test_the_kinds_put_the_arms_where_they_say(name):
    body = small_body(name)
    for kind, elbow_drop, wrist_drop in (("A", 0.707, 0.707), ("T", 0.0, 0.0), ("elbows", 0.17, 1)):
        found = points(body, pose_of_kind(body, kind)[None])[0]
        shoulder, elbow, wrist = found[[2, 4, 6]]
        upper, fore = elbow - shoulder, wrist - elbow
        assert -upper[2] / np.linalg.norm(upper) == pytest.approx(elbow_drop, abs=0.03)
        assert -fore[2] / np.linalg.norm(fore) == pytest.approx(wrist_drop, abs=0.03)
        mirrored = found[7] * [-1, 1, 1]
        assert np.allclose(wrist, mirrored, atol=1e-3)


def test_an_unknown_kind_names_the_known_ones():
    with pytest.raises(MocapError, match="A, T, elbows"):
        pose_of_kind(small_body("performer"), "Y")


@pytest.mark.parametrize("name", BODIES)
def test_all_stances_are_within_the_limits_and_differ(name):
    body = small_body(name)
    poses = np.stack([stance(body, *names) for names in all_stances()])
    assert within_limits(body, poses).all()
    shapes = {pose.tobytes() for pose in poses}
    # legs that are one cannot step
    assert len(shapes) == len(poses) // (4 if name == "nine_joint" else 1)
    assert set(POSE_KINDS) <= {arms for arms, _ in all_stances()}


def test_stances_step_swing_and_sit_as_they_say():
    body = small_body("performer")
    step = stance(body, "swinging", "stepping")
    assert place(body, step, "left_ankle")[1] < -0.1 < 0.2 < place(body, step, "right_ankle")[1]
    assert place(body, step, "left_wrist")[1] < -0.2 < 0.1 < place(body, step, "right_wrist")[1]
    seat = stance(body, "bent", "sitting")
    assert place(body, seat, "right_knee")[1] < -0.35
    assert place(body, seat, "right_knee")[2] > 0.75
    assert place(body, stance(body, "up", STANDING), "left_wrist")[2] > 1.75
