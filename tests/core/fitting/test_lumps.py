import numpy as np
import pytest
from silhouette_mocap.core.fitting.limbs import LIMB_NAMES, limb_segments
from silhouette_mocap.core.fitting.lumps import (
    THICK_M,
    Lumps,
    dropped,
    first_joint_and_length,
)
from silhouette_mocap.core.fitting.scores import metres_at
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import dof_values, evaluator, filmed, small_body, small_studio


@pytest.fixture(scope="module")
def scene():
    body, cameras = small_body("performer"), small_studio()
    return body, cameras, evaluator(body, cameras)


def lumps_by_limb(scene, pose, silhouettes, weights=None):
    body, cameras, drawn = scene
    found = Lumps.of(drawn.silhouettes(pose), silhouettes, metres_at(drawn, pose))
    weights = np.ones(len(cameras)) if weights is None else weights
    areas = found.of_limbs(drawn, pose, limb_segments(body), weights).sum(axis=0)
    return dict(zip(LIMB_NAMES, areas, strict=True))


def squares(side_px):
    """A silhouette with a square, and a model with nothing, 1 cm per px."""
    mask = np.zeros((60, 80), bool)
    mask[20 : 20 + side_px, 30 : 30 + side_px] = True
    return Silhouette(mask, np.ones_like(mask)), np.zeros_like(mask)


def test_what_is_thinner_than_a_wrist_is_no_lump():
    for side, lumpy in ((round(THICK_M * 100) - 2, False), (round(THICK_M * 100) + 2, True)):
        seen, empty = squares(side)
        assert bool(Lumps.of([empty], [seen], np.array([0.01]))) == lumpy
        # the other way round it is a surplus of the model
        blank = Silhouette(empty, np.ones_like(empty))
        assert bool(Lumps.of([seen.foreground], [blank], np.array([0.01]))) == lumpy


def test_beside_a_camera_nothing_is_as_thick_as_a_wrist():
    seen, empty = squares(12)
    for model in (empty, seen.foreground):
        assert not Lumps.of([model], [seen], np.array([1e-7]))


def test_a_lump_keeps_its_area_and_place():
    seen, empty = squares(12)
    lumps = Lumps.of([empty], [seen], np.array([0.01]))
    assert not len(lumps.surplus[0])
    columns, rows = lumps.missing[0].T
    assert seen.foreground[rows, columns].all()
    assert len(rows) > 0.9 * seen.foreground.sum()


def test_what_was_not_observed_is_no_lump():
    seen, empty = squares(12)
    hidden = Silhouette(seen.foreground, ~seen.foreground)
    assert not Lumps.of([empty], [hidden], np.array([0.01]))


def test_a_pose_that_fits_leaves_nothing(scene):
    body, cameras, _ = scene
    pose = dof_values(body, left_elbow_flexion=0.5)
    assert set(lumps_by_limb(scene, pose, filmed(body, cameras, pose)).values()) == {0.0}


def test_a_raised_arm_is_missed_where_an_arm_reaches_and_no_leg(scene):
    body, cameras, _ = scene
    truth = dof_values(body, left_shoulder_abduction=2.2)
    found = lumps_by_limb(scene, body.rest_pose, filmed(body, cameras, truth))
    assert found["left_arm"] > 0.02
    assert found["left_arm"] >= max(found.values())
    assert found["left_leg"] < 0.6 * found["left_arm"]
    assert found["right_leg"] < 0.6 * found["left_arm"]


def test_views_count_by_their_weights(scene):
    body, cameras, _ = scene
    seen = filmed(body, cameras, dof_values(body, left_shoulder_abduction=2.2))
    whole = lumps_by_limb(scene, body.rest_pose, seen)["left_arm"]
    views = [
        lumps_by_limb(scene, body.rest_pose, seen, np.eye(len(cameras))[v])["left_arm"]
        for v in range(len(cameras))
    ]
    assert sum(views) == pytest.approx(whole)


def test_a_limb_is_as_long_as_its_bones(scene):
    body = scene[0]
    arm = limb_segments(body)[LIMB_NAMES.index("left_arm")]
    joint, length = first_joint_and_length(body, arm)
    assert body.joint_names[joint].startswith("left_")
    assert 0.5 < length < 1.0


def test_what_is_missing_and_what_is_surplus_are_told_apart(scene):
    body, cameras, drawn = scene
    raised = dof_values(body, left_shoulder_abduction=2.2)
    arm = LIMB_NAMES.index("left_arm")
    seen = filmed(body, cameras, raised)
    found = Lumps.of(drawn.silhouettes(body.rest_pose), seen, metres_at(drawn, body.rest_pose))
    missing, surplus = found.of_limbs(
        drawn, body.rest_pose, limb_segments(body), np.ones(len(cameras))
    )
    assert min(missing[arm], surplus[arm]) > 0.01
    # what the model covers in vain is drawn by the arm alone
    assert surplus[LIMB_NAMES.index("right_leg")] == 0


def test_a_view_has_dropped_a_limb_where_most_of_it_is_gone(scene):
    body, cameras, drawn = scene
    arm = limb_segments(body)[LIMB_NAMES.index("left_arm")]
    pose = dof_values(body, left_shoulder_abduction=1.4)
    others = [s for s in range(len(body.segment_names)) if s not in arm]
    bare = drawn.silhouettes(pose, others)
    seen = [
        s if view % 2 else Silhouette(bare[view], s.observed)
        for view, s in enumerate(filmed(body, cameras, pose))
    ]
    limb = drawn.silhouettes(pose, arm)
    for view, picture in enumerate(dropped(drawn, pose, arm, seen, metres_at(drawn, pose))):
        assert (picture is None) == bool(view % 2)
        if picture is not None:
            assert picture[limb[view]].all()
            assert picture.sum() < 6 * limb[view].sum()
