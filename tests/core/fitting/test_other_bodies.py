"""A dog is scored, tracked and recorded by its own limbs and points."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from dog import dog
from silhouette_mocap.core.body.body import POINT_NAMES
from silhouette_mocap.core.body.file import read_body, write_body
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.body.templates import template
from silhouette_mocap.core.fitting.limbs import (
    LIMB_NAMES,
    POINT_LIMBS,
    limb_names,
    limb_segments,
    point_limbs,
    points_of,
)
from silhouette_mocap.core.fitting.scores import frame_scores
from silhouette_mocap.core.fitting.search import Search
from silhouette_mocap.core.fitting.tracker import Past
from silhouette_mocap.core.fitting.tracking import History, track
from silhouette_mocap.core.motion.motion import read_motion, write_motion
from silhouette_mocap.core.motion.recording import recorded
from synthetic import evaluator, filmed, small_studio

LEGS = ("fore_thigh_l", "fore_thigh_r", "hind_thigh_l", "hind_thigh_r")


@pytest.fixture(scope="module")
def walking():
    """(T, D) poses in which the legs swing, two and two."""
    body, poses = dog(), np.zeros((5, len(dog().dofs)))
    swing = np.linspace(0, 0.5, len(poses))
    for leg, way in zip(LEGS, (1, -1, -1, 1), strict=True):
        row = int(np.flatnonzero(body.dofs.joints == body.joint_names.index(leg))[0])
        poses[:, row] = way * swing
    poses[:, 1] = -swing / 4
    return poses


@pytest.fixture(scope="module")
def fits(walking):
    body, cameras = dog(), small_studio()
    tracker = Search().made(body, cameras, evaluator)
    frames = ((k, filmed(body, cameras, pose)) for k, pose in enumerate(walking))
    return {fit.frame: fit for fit in track(tracker, History(body, walking[0]), frames)}


def test_a_template_has_the_limbs_and_points_of_a_person():
    for name in ("performer", "sixteen_segment"):
        body = template(name)
        assert limb_names(body) == LIMB_NAMES
        assert body.point_names == POINT_NAMES
        assert point_limbs(body) == POINT_LIMBS


def test_a_dog_has_its_own_limbs_and_the_trunk_is_what_none_of_them_moves():
    body = dog()
    assert limb_names(body) == ("torso", *LEGS, "tail", "neck")
    assert limb_segments(body)[0] == (0,)
    own = [body.point_names[k] for k in points_of(body, "neck")]
    assert own == ["end of neck", "end of head"]
    assert points_of(body, "torso") == [0]


def test_where_a_limb_begins_belongs_to_the_trunk():
    body = dog()
    begins = replace(body, point_offsets=np.zeros_like(body.point_offsets))
    found = dict(zip(body.joint_names, point_limbs(begins), strict=True))
    assert found["neck"] == found["tail"] == found["fore_thigh_l"] == 0
    assert limb_names(body)[found["head"]] == "neck"


def test_a_leg_that_is_off_is_told_by_its_own_scores(walking):
    body, cameras = dog(), small_studio()
    pose = walking[0].copy()
    pose[np.flatnonzero(body.dofs.joints == body.joint_names.index("hind_thigh_r"))[0]] = 0.9
    scores = frame_scores(evaluator(body, cameras), pose, filmed(body, cameras, walking[0]))
    assert scores.limb_residual.shape == scores.lumps.shape == (7,)
    assert limb_names(body)[np.argmax(scores.limb_residual)] == "hind_thigh_r"
    assert limb_names(body)[np.argmax(scores.unexplained)] == "hind_thigh_r"
    assert scores.confidence.shape == (len(body.point_names),)
    assert np.argmin(scores.confidence) in points_of(body, "hind_thigh_r")


def test_a_dog_is_tracked(walking, fits):
    found = np.stack([fits[k].pose for k in range(len(walking))])
    off = np.linalg.norm(points(dog(), found) - points(dog(), walking), axis=2)
    # 33 mm per px, perfect silhouettes: half a pixel on average
    assert off.mean() < 0.017
    assert not any(fit.scores.lost for fit in fits.values())


def test_a_pose_is_found_from_another_alone(walking):
    body, cameras = dog(), small_studio()
    tracker = Search().made(body, cameras, evaluator)
    found = tracker.fit(filmed(body, cameras, walking[1]), Past.still(walking[0])).pose
    off = np.linalg.norm(np.diff(points(body, np.stack([found, walking[1]])), axis=0)[0], axis=1)
    assert off.mean() < 0.017


def test_body_and_motion_of_a_dog_come_back_from_their_files(fits, tmp_path):
    body = dog()
    write_body(tmp_path / "body.npz", body)
    assert read_body(tmp_path / "body.npz").point_names == body.point_names
    motion = recorded(fits, body, [c.name for c in small_studio()], Fraction(15))
    write_motion(tmp_path / "motion.npz", motion)
    back = read_motion(tmp_path / "motion.npz")
    assert back.limb_names == limb_names(body) and back.point_limbs == point_limbs(body)
    assert back.limb_residual.shape == (5, 7) and back.points.shape == (5, 12, 3)


def test_files_of_old_hold_people(fits, tmp_path):
    write_body(tmp_path / "body.npz", template("sixteen_segment"))
    stored = dict(np.load(tmp_path / "body.npz"))
    del stored["point_names"]
    np.savez(tmp_path / "old.npz", **stored)
    assert read_body(tmp_path / "old.npz").point_names == POINT_NAMES
    motion = recorded(fits, dog(), [c.name for c in small_studio()], Fraction(15))
    write_motion(tmp_path / "motion.npz", motion)
    stored = dict(np.load(tmp_path / "motion.npz"))
    del stored["limb_names"], stored["point_limbs"]
    np.savez(tmp_path / "old_motion.npz", **stored)
    old = read_motion(tmp_path / "old_motion.npz")
    assert old.limb_names == LIMB_NAMES and old.point_limbs == POINT_LIMBS
