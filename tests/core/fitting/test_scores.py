from dataclasses import replace

import numpy as np
from silhouette_mocap.core.fitting.limbs import LIMB_NAMES, limb_segments
from silhouette_mocap.core.fitting.scores import frame_scores
from silhouette_mocap.core.fitting.sights import contour_pairs
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import dof_values, evaluator, filmed, small_body, small_studio


def test_the_true_pose_scores_perfectly():
    body, cameras = small_body("performer"), small_studio()
    pose = dof_values(body, left_elbow_flexion=0.5)
    scores = frame_scores(evaluator(body, cameras), pose, filmed(body, cameras, pose))
    assert not scores.xor_px.any()
    assert (scores.iou == 1).all()
    assert scores.contour_px == 0
    assert not scores.limb_residual.any()
    assert (scores.confidence > 0.7).all()
    assert not scores.unexplained.any()
    assert not scores.lost


def test_a_lost_arm_shows_in_its_own_residual_and_confidence():
    body, cameras = small_body("performer"), small_studio()
    truth = dof_values(body, left_shoulder_abduction=1.2)
    scores = frame_scores(evaluator(body, cameras), body.rest_pose, filmed(body, cameras, truth))
    assert int(np.argmax(scores.limb_residual)) == LIMB_NAMES.index("left_arm")
    assert scores.limb_residual[LIMB_NAMES.index("right_leg")] == 0
    assert scores.confidence.argmin() in (4, 6)
    assert scores.lost


def test_xor_and_iou_are_counted_where_something_was_observed():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    pose = body.rest_pose
    seen = filmed(body, cameras, pose)
    left = np.zeros_like(seen[0].observed)
    left[:, : left.shape[1] // 2] = True
    cut = (replace(seen[0], foreground=seen[0].foreground & left, observed=left), seen[1])
    scores = frame_scores(evaluator(body, cameras), pose, cut)
    assert scores.xor_px.tolist() == [0, 0]
    whole = (replace(cut[0], observed=np.ones_like(left)), seen[1])
    scores = frame_scores(evaluator(body, cameras), pose, whole)
    missing = np.count_nonzero(seen[0].foreground & ~left)
    assert scores.xor_px[0] == missing
    assert scores.iou[0] == 1 - missing / np.count_nonzero(seen[0].foreground)


def test_every_segment_belongs_to_one_limb():
    for name in ("performer", "sixteen_segment", "eleven_segment"):
        body = small_body(name)
        held = sorted(s for segments in limb_segments(body) for s in segments)
        assert held == list(range(len(body.segment_names)))


def test_both_legs_are_the_one_segment_that_carries_them_where_a_body_has_no_others():
    body = small_body("nine_joint")
    torso, left_arm, _, *legs = limb_segments(body)
    names = [[body.segment_names[s] for s in segments] for segments in (*legs, torso, left_arm)]
    assert names[:2] == [["virtual_leg"]] * 2
    assert names[2:] == [["trunk", "head"], ["left_arm", "left_forearm", "left_hand"]]


def test_the_contour_of_a_grown_square_runs_round_it():
    square = np.zeros((40, 40), bool)
    square[10:30, 10:30] = True
    everywhere = np.ones_like(square)
    distance = Silhouette(square, everywhere).distances.ravel()
    assert not distance[contour_pairs(square, everywhere)].sum(axis=0).any()
    grown = np.zeros_like(square)
    grown[8:32, 8:32] = True
    pairs = contour_pairs(grown, everywhere)
    assert pairs.shape == (2, 4 * 24)
    assert (grown.ravel()[pairs].sum(axis=0) == 1).all()
    distances = distance[pairs].sum(axis=0) / 2
    # Along the sides two px, nearer the diagonal at the corners.
    assert np.median(distances) == 2
    assert (distances <= np.hypot(2, 2)).all()
    left = np.zeros_like(square)
    left[:, :12] = True
    assert left.ravel()[pairs].any(axis=0).sum() == 24 + 2 * 4
    assert contour_pairs(grown, ~left).shape == (2, 24 + 2 * 20)


def test_a_view_that_saw_nothing_tells_nothing_of_contours():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    seen = filmed(body, cameras, body.rest_pose)
    black = replace(seen[0], foreground=np.zeros_like(seen[0].foreground))
    scores = frame_scores(evaluator(body, cameras), body.rest_pose, (black, seen[1]))
    assert not scores.limb_residual.any()
    assert scores.iou.tolist() == [0, 1]


def test_a_body_that_no_view_shows_is_lost():
    body, cameras = small_body("sixteen_segment"), small_studio(2)
    away = dof_values(body, root_z=-50.0)
    scores = frame_scores(evaluator(body, cameras), away, filmed(body, cameras, body.rest_pose))
    assert scores.lost
    assert not scores.iou.any()
