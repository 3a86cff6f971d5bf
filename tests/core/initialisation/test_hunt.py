import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.fitting.contour import ContourTracker
from silhouette_mocap.core.fitting.turns import heading_dof
from silhouette_mocap.core.initialisation.hunt import Hunt, all_round, hung, stood
from silhouette_mocap.core.initialisation.pose_kinds import stance
from synthetic import dof_values, evaluator, filmed, point_errors, small_body, small_studio

BODY = small_body("performer")


@pytest.fixture(scope="module")
def hunted():
    truth = dof_values(
        BODY, root_x=0.3, root_yaw=2.0, left_shoulder_abduction=0.4, right_elbow_flexion=1.2
    )
    cameras = small_studio(5)
    hunt = Hunt(ContourTracker(BODY, cameras, evaluator), filmed(BODY, cameras, truth))
    return hunt, truth


def test_shapes_are_turned_all_round_one_after_the_other():
    shapes = np.stack([stance(BODY, arms, "standing") for arms in ("A", "T")])
    poses = all_round(BODY, shapes)
    headings = np.degrees(poses[:, heading_dof(BODY)]).reshape(2, -1)
    assert np.allclose(np.diff(headings, axis=1), 15) and headings.shape == (2, 24)
    others = np.delete(poses, heading_dof(BODY), axis=1).reshape(2, 24, -1)
    assert (others == np.delete(shapes, heading_dof(BODY), axis=1)[:, None]).all()


@pytest.mark.parametrize("legs", ["standing", "sitting"])
def test_stood_poses_have_their_feet_on_the_floor_and_their_middle_over_a_place(legs):
    poses = all_round(BODY, stance(BODY, "A", legs)[None])
    places = points(BODY, stood(BODY, poses, np.array([0.4, -0.2, 7.0]), 0.5))
    ankle = points(BODY, BODY.rest_pose[None])[0, :, 2].min()
    assert np.allclose(places[..., 2].min(axis=1), 0.5 + ankle)
    assert np.allclose(places[..., :2].mean(axis=1), (0.4, -0.2))
    middles = points(BODY, hung(BODY, poses, np.array([0.4, -0.2, 1.1]))).mean(axis=1)
    assert np.allclose(middles, (0.4, -0.2, 1.1))


def test_energies_are_the_px_that_differ(hunted):
    hunt, truth = hunted
    drawn = hunt.evaluator.silhouettes(BODY.rest_pose)
    differing = sum((a ^ b.foreground).sum() for a, b in zip(drawn, hunt.silhouettes, strict=True))
    assert hunt.energies(np.stack([truth, BODY.rest_pose])).tolist() == [0, differing]


def test_descents_begin_at_the_best_starts_apart_from_each_other(hunted):
    hunt, truth = hunted
    near = np.repeat(truth[None], 6, axis=0)
    near[:, 3] += np.radians([0, 5, 10, 15, 60, 180])
    bent = truth.copy()
    bent[BODY.dofs.names.index("right_elbow_flexion")] += 0.9
    starts = np.concatenate([near, bent[None]])
    chosen = hunt._chosen(starts, 9)
    assert chosen[:2] == [0, 6] and set(chosen[2:]) == {4, 5}
    assert hunt._chosen(starts, 1) == [0]


def test_the_pose_is_found_from_a_stance_and_no_past(hunted):
    hunt, truth = hunted
    starts = all_round(BODY, np.stack([stance(BODY, "A", "standing")]))
    ends = hunt.ends(stood(BODY, starts, np.array([0.3, 0.0, 0.0]), 0.0), 3)
    assert [end.energy for end in ends] == sorted(end.energy for end in ends)
    found = hunt.complete(ends[0].pose)
    # half a px of 33 mm
    assert np.mean(list(point_errors(BODY, found.pose, truth).values())) < 0.017
    assert hunt.scores(found.pose).confidence.min() > hunt.scores(ends[-1].pose).confidence.min()
