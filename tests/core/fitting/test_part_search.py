import numpy as np
import pytest
from scipy.optimize import least_squares
from silhouette_mocap.core.body.kinematics import joint_positions, joint_transforms
from silhouette_mocap.core.body.limits import Limits
from silhouette_mocap.core.energy.weight_maps import xor_weight_maps
from silhouette_mocap.core.fitting.part_search import (
    FORBIDDEN,
    PartEnergy,
    first_steps,
    leave_windows,
    metres_per_pixel,
    part_windows,
)
from silhouette_mocap.core.fitting.torso_volume import TorsoVolume
from silhouette_mocap.core.fitting.tracker import Tally
from synthetic import dof_values, evaluator, filmed, small_body, small_studio


def part_of(body, name):
    return next(part for part in body.parts if part.name == name)


def test_a_first_step_moves_the_tip_by_two_pixels():
    body, cameras = small_body("sixteen_segment"), small_studio()
    pose = dof_values(body, left_elbow_flexion=0.4)
    part = part_of(body, "left_arm")
    steps = first_steps(evaluator(body, cameras), pose, part, tip_px=2.0)
    hand = body.joint_names.index("left_wrist")
    for dof, step in zip(part.dofs, steps, strict=True):
        moved = pose.copy()
        moved[dof] += step
        ends = joint_positions(body, np.stack([pose, moved]))[:, hand]
        # The wrist lies inside the part, so it moves less than the fingertips.
        assert np.linalg.norm(ends[1] - ends[0]) < 2.02 * metres_per_pixel(cameras, ends[0])
    root = part_of(body, "torso")
    translation = first_steps(evaluator(body, cameras), pose, root, tip_px=2.0)[:3]
    assert translation == pytest.approx(2 * metres_per_pixel(cameras, np.array([0, 0, 1])), rel=0.2)


def test_windows_are_centred_on_the_part_and_grow_with_the_picture():
    body, cameras = small_body("sixteen_segment"), small_studio()
    renderer = evaluator(body, cameras)
    part = part_of(body, "left_hand")
    windows = part_windows(renderer, body.rest_pose, part, side=64)
    assert (windows[:, 2:] - windows[:, :2] == 32).all()
    hand = body.segment_names.index("left_hand")
    for window, picture in zip(windows, renderer.silhouettes(body.rest_pose, [hand]), strict=True):
        rows, columns = np.nonzero(picture)
        assert abs(columns.mean() - window[[0, 2]].mean()) < 2
        assert abs(rows.mean() - window[[1, 3]].mean()) < 2


def test_leaving_a_window_in_one_view_is_noticed():
    windows = np.array([[0, 0, 10, 10], [5, 5, 15, 15]])
    bounds = np.array(
        [
            [[0, 0, 10, 10], [6, 6, 8, 8]],
            [[0, 0, 10, 10], [6, 6, 16, 8]],
            [[0, -1, 10, 10], [6, 6, 8, 8]],
        ]
    )
    assert leave_windows(bounds, windows).tolist() == [False, True, True]


def arm_pose(body, values):
    names = ("shoulder_flexion", "shoulder_abduction", "shoulder_twist", "elbow_flexion")
    return dof_values(body, **{f"left_{n}": v for n, v in zip(names, values, strict=True)})


def hand_in_trunk(body):
    """A pose whose left fingertips lie in the middle of the trunk, whatever the limits say."""
    wrist = body.joint_names.index("left_wrist")

    def miss(values):
        transform = joint_transforms(body, arm_pose(body, values)[None])[0, wrist]
        return transform[:, :3] @ body.tails[wrist] + transform[:, 3] - [0.0, 0.0, 1.2]

    found = least_squares(miss, np.full(4, 0.3))
    assert np.linalg.norm(found.fun) < 0.02
    return arm_pose(body, found.x)


@pytest.mark.parametrize("name", ["performer", "sixteen_segment"])
def test_a_hand_inside_the_trunk_is_noticed_and_one_beside_it_is_not(name):
    body, cameras = small_body(name), small_studio(2)
    poses = np.stack([body.rest_pose, hand_in_trunk(body)])
    transforms = evaluator(body, cameras).transforms(poses)
    for part in ("left_arm", "left_hand"):
        held = TorsoVolume.of(body).holds_part(transforms, part_of(body, part))
        assert held.tolist() == [False, True]


@pytest.mark.parametrize("name", ["performer", "sixteen_segment"])
def test_no_part_is_inside_the_torso_at_rest(name):
    body, cameras = small_body(name), small_studio(2)
    transforms = evaluator(body, cameras).transforms(body.rest_pose[None])
    for part in body.parts:
        if part.role in ("limb", "end"):
            assert not TorsoVolume.of(body).holds_part(transforms, part).any(), part.name


def test_candidates_inside_the_torso_are_never_rendered():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    renderer, part, tally = evaluator(body, cameras), part_of(body, "left_arm"), Tally()
    weights = renderer.prepared(xor_weight_maps(filmed(body, cameras, body.rest_pose)))
    endless = np.full(len(part.dofs), np.inf)
    free = Limits(-endless, endless, np.zeros((0, len(endless))), np.zeros(0))
    energy = PartEnergy(
        renderer,
        weights,
        body.rest_pose,
        part,
        free,
        TorsoVolume.of(body),
        None,
        0.0,
        tally,
        part.segments,
    )
    values = np.stack([body.rest_pose, hand_in_trunk(body)])[:, list(part.dofs)]
    assert (energy(values) == FORBIDDEN).tolist() == [False, True]
    assert tally.evaluated == 1
