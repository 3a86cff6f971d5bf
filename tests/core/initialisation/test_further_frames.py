import numpy as np
from silhouette_mocap.core.initialisation.further_frames import most_different, straight_joints
from synthetic import dof_values, small_body

BODY = small_body("performer")


def bent(**degrees):
    return dof_values(BODY, **{name: np.radians(value) for name, value in degrees.items()})


def test_poses_unlike_all_others_are_chosen_first():
    poses = np.stack(
        [
            bent(),
            bent(left_elbow_flexion=5),
            bent(left_elbow_flexion=90),
            bent(left_elbow_flexion=85),
            bent(right_knee_flexion=60),
        ]
    )
    usable = np.ones(5, bool)
    assert most_different(BODY, poses, usable, [0], 2) == [0, 2]
    assert most_different(BODY, poses, usable, [0], 3) == [0, 2, 4]
    assert most_different(BODY, poses, usable, [0], 9) == [0, 1, 2, 3, 4]


def test_lost_frames_and_mere_walking_away_are_not_chosen():
    away = bent(left_elbow_flexion=1)
    away[:3] = 5.0
    poses = np.stack([bent(), away, bent(left_elbow_flexion=90), bent(left_elbow_flexion=20)])
    usable = np.array([True, True, False, True])
    assert most_different(BODY, poses, usable, [0], 2) == [0, 3]


def test_joints_that_no_frame_bends_are_named():
    poses = np.stack([bent(left_elbow_flexion=40), bent(right_knee_flexion=20)])
    assert straight_joints(BODY, poses) == ("knee",)
    assert straight_joints(BODY, poses[1:]) == ("elbow", "knee")
