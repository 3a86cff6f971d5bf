import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import joint_positions
from silhouette_mocap.core.fitting.part_search import (
    first_steps,
    leaves_window,
    metres_per_pixel,
    part_windows,
)
from silhouette_mocap.core.fitting.torso_volume import TorsoVolume
from synthetic import dof_values, evaluator, small_body, small_studio


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
    assert not leaves_window(np.array([[0, 0, 10, 10], [6, 6, 8, 8]]), windows)
    assert leaves_window(np.array([[0, 0, 10, 10], [6, 6, 16, 8]]), windows)
    assert leaves_window(np.array([[0, -1, 10, 10], [6, 6, 8, 8]]), windows)


@pytest.mark.parametrize("name", ["performer", "sixteen_segment"])
def test_a_hand_inside_the_chest_is_noticed_and_one_beside_it_is_not(name):
    body, cameras = small_body(name), small_studio(2)
    torso, part = TorsoVolume.of(body), part_of(body, "left_arm")
    inside = dof_values(body, left_shoulder_twist=-0.9, left_elbow_flexion=2.2)
    rest = body.rest_pose
    chest = evaluator(body, cameras).transforms(np.stack([rest, rest]))
    shoulder, wrist = (body.joint_names.index(f"left_{j}") for j in ("shoulder", "wrist"))
    chest[1, wrist, :, 3] = chest[1, shoulder, :, 3] - [0.17, 0.0, 0.2]
    assert torso.holds_limb(chest, part).tolist() == [False, True]
    assert np.isfinite(inside).all()
