from dataclasses import fields

import numpy as np
import pytest
from moving import motion_with, stepping, swaying
from silhouette_mocap.core.body.kinematics import clamped, joint_positions, joint_transforms, points
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.motion.cleaning.cleaned import cleaned, undone
from silhouette_mocap.core.motion.cleaning.settings import CleanSettings
from silhouette_mocap.core.motion.cleaning.soles import Soles
from silhouette_mocap.core.motion.motion import Motion
from silhouette_mocap.core.progress import SILENCE
from synthetic import small_body

BODY = small_body("performer")
EVERYTHING = CleanSettings(keys_mm=5.0)


@pytest.fixture(scope="module")
def raw():
    """A noisy step with three lost frames and a locked one."""
    poses, _ = stepping(BODY, 30.0)
    noise = np.random.default_rng(9).normal(0, 0.006, poses.shape)
    noise[:, :3] *= 0.2
    soles = Soles.of(BODY).places(joint_transforms(BODY, poses))
    poses[:, 2] -= soles[..., 2].min()
    count = len(poses)
    return motion_with(
        BODY,
        clamped(BODY, poses + noise),
        lost=np.isin(np.arange(count), (60, 61, 62)),
        locked=np.arange(count) == 20,
        confidence=np.full((count, 14), 0.99),
        confidence_raw=np.full((count, 14), 0.99),
    )


@pytest.fixture(scope="module")
def found(raw):
    return cleaned(BODY, raw, EVERYTHING, 0.0, SILENCE)


def differing(one: Motion, other: Motion) -> set[str]:
    names = [field.name for field in fields(Motion)]
    return {n for n in names if not np.array_equal(getattr(one, n), getattr(other, n))}


def test_cleaning_changes_these_and_undoing_it_gives_them_back_to_the_bit(raw, found):
    changed = {"pose", "joints", "points", "confidence", "keyed"}
    assert differing(raw, found.motion) == changed
    assert not differing(raw, undone(BODY, found.motion))


def test_cleaning_what_is_clean_gives_the_same_bits(found):
    again = cleaned(BODY, found.motion, EVERYTHING, 0.0, SILENCE)
    assert not differing(again.motion, found.motion) and again.as_dict() == found.as_dict()


def test_cleaning_otherwise_starts_from_the_raw_poses(raw, found):
    settings = CleanSettings("butterworth", 4.0, contacts=False)
    again = cleaned(BODY, found.motion, settings, 0.0, SILENCE)
    assert not differing(again.motion, cleaned(BODY, raw, settings, 0.0, SILENCE).motion)


def test_joints_and_points_are_those_of_the_poses(found):
    motion = found.motion
    assert np.array_equal(motion.joints, joint_positions(BODY, motion.pose))
    assert np.array_equal(motion.points, points(BODY, motion.pose))


def test_filled_frames_are_told_and_little_trusted(raw, found):
    confidence = found.motion.confidence
    assert found.as_dict()["filled_frames"] == [60, 61, 62]
    assert (confidence[60:63] <= 0.25).all() and (
        np.delete(confidence, [60, 61, 62], 0) == 0.99
    ).all()
    assert found.motion.lost[60:63].all()


def test_locked_frames_keep_their_poses(raw, found):
    assert np.array_equal(found.motion.pose[20], raw.pose_raw[20])


def test_the_report_tells_what_was_done(found):
    told = found.as_dict()
    assert told["settings"] == {
        "filter": "refit",
        "smooth_hz": 6.0,
        "contacts": True,
        "keys_mm": 5.0,
    }
    assert told["acceleration"]["clean"] < 0.5 * told["acceleration"]["raw"]
    assert {contact["foot"] for contact in told["feet"]["contacts"]} == {"left", "right"}
    slide = told["feet"]["slide_mm"]
    assert slide["after"]["max"] < 1.0 < slide["before"]["max"]
    assert told["keys"]["error_mm"]["max"] <= 5.0


def test_feet_and_keys_may_be_left_alone(raw):
    told = cleaned(BODY, raw, CleanSettings(contacts=False), 0.0, SILENCE)
    assert told.feet is None and told.keys is None and told.motion.keyed.all()


def test_a_motion_without_any_good_frame_is_refused():
    motion = motion_with(BODY, swaying(BODY, 0.2, 30.0), lost=np.ones(6, bool))
    with pytest.raises(MocapError, match=r"all frames are lost, .*; fit the take again"):
        cleaned(BODY, motion, CleanSettings(), 0.0, SILENCE)


@pytest.mark.parametrize("count", [1, 2])
def test_the_shortest_motions_can_be_cleaned(raw, count):
    short = motion_with(BODY, raw.pose_raw[:count])
    assert len(cleaned(BODY, short, EVERYTHING, 0.0, SILENCE).motion.pose) == count
