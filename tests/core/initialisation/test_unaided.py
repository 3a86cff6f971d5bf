"""Takes that name no initial pose, rendered from poses that are known."""

import re
from dataclasses import replace

import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import rest_height
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.fitting.contour import ContourTracker
from silhouette_mocap.core.initialisation import unaided
from silhouette_mocap.core.initialisation.first_pose import PoseRequest
from silhouette_mocap.core.initialisation.hunt import Hunt
from silhouette_mocap.core.initialisation.pose_kinds import stance
from silhouette_mocap.core.initialisation.sightings import Footage, sightings
from silhouette_mocap.core.initialisation.unaided import found_unaided
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import evaluator, filmed, point_errors, small_body, small_studio

BODY, CAMERAS = small_body("performer", 0.97), small_studio(5)
HUDDLED = ("bent", "sitting")


def posed(arms, legs, x=0.0, heading=0.9):
    pose = stance(BODY, arms, legs)
    pose[[0, 3]] = x, heading
    return pose


def footage_of(poses):
    seen = [filmed(BODY, CAMERAS, pose) for pose in poses]
    return Footage(CAMERAS, seen.__getitem__, (0, len(poses) - 1), 2.0)


def found_in(footage):
    frames, template = range(footage.frames[1] + 1), small_body("performer")
    return found_unaided(template, footage, frames, PoseRequest(None), evaluator)


def cut(silhouette):
    """Its lower half lies beyond the picture."""
    observed = silhouette.observed.copy()
    observed[60:] = False
    return Silhouette(silhouette.foreground & observed, observed)


def test_the_frame_with_its_limbs_apart_is_chosen_and_its_pose_found():
    poses = [posed(*HUDDLED), posed(*HUDDLED, heading=2.0), posed("T", "standing", 0.2)]
    frame, first = found_in(footage_of(poses))
    assert frame == 2
    assert rest_height(first.body) == pytest.approx(rest_height(BODY), rel=0.02)
    # a px of 33 mm
    assert np.mean(list(point_errors(first.body, first.pose, poses[2]).values())) < 0.033
    chosen, tall, facing = first.notes
    assert not first.doubts
    assert "m tall" in tall and "worse" in facing
    assert chosen.startswith("No initial pose is given: frame 2 was chosen, starting from standing")
    assert re.search(r"right within 50 mm with a probability of [789]\d%\.$", chosen)


def test_where_standing_poses_do_not_convince_the_visual_hull_is_searched(monkeypatch, caplog):
    monkeypatch.setattr(unaided, "_CONVINCING", 1.1)
    caplog.set_level("INFO")
    _, first = found_in(footage_of([posed("A", "standing")]))
    assert len(first.doubts) == 1 and "frame 0 was chosen" in first.doubts[0]
    sought = [record.getMessage() for record in caplog.records if "likely" in record.getMessage()]
    assert sought[0].startswith("frame 0 from standing poses")
    assert sought[1].startswith("frame 0 from 36 poses in the visual hull")


def test_from_the_visual_hull_whoever_jumps_is_found():
    truth = posed("forward", "sitting")
    truth[2] = 0.4
    hunt = Hunt(ContourTracker(BODY, CAMERAS, evaluator), filmed(BODY, CAMERAS, truth))
    starts = unaided._hull_starts(small_body("performer"), BODY)
    end = hunt.ends(starts.place(hunt, starts.poses), starts.descents)[0]
    assert np.mean(list(point_errors(BODY, end.pose, truth).values())) < 0.033


def test_whoever_is_cut_off_in_all_views_but_one_is_not_sought():
    footage = footage_of([posed("A", "standing")])
    whole, *others = footage.look(0)
    footage = replace(footage, look=lambda frame: (whole, *map(cut, others)))
    with pytest.raises(MocapError, match=r"fewer than two cameras see the whole.*initial_pose = "):
        found_in(footage)
    several = replace(footage, look=lambda frame: (whole, others[0], *map(cut, others[1:])))
    assert len(sightings(several, [0], 0.0)) == 1


def test_frames_without_anybody_are_passed_over():
    footage = footage_of([posed("A", "standing")] * 2)
    shown = footage.look(0)
    blank = np.zeros_like(shown[0].foreground)
    nobody = (Silhouette(blank, ~blank),) * len(CAMERAS)
    footage = replace(footage, look=lambda frame: shown if frame else nobody)
    assert [seen.frame for seen in sightings(footage, [0, 1], 0.0)] == [1]
    assert footage.way(0) is None


def test_half_a_body_is_refused():
    def upper(silhouette):
        rows = np.flatnonzero(silhouette.foreground.any(axis=1))
        half = silhouette.foreground.copy()
        half[(rows[0] + rows[-1]) // 2 :] = False
        return replace(silhouette, foreground=half)

    footage = footage_of([posed("A", "standing")])
    seen = tuple(map(upper, footage.look(0)))
    with pytest.raises(
        MocapError, match=r"none was found: the best, in frame 0, .*initial_pose = "
    ):
        found_in(replace(footage, look=lambda frame: seen))


def test_what_is_not_likely_is_refused(monkeypatch):
    monkeypatch.setattr(unaided, "LEAST_LIKELY", 0.999)
    with pytest.raises(MocapError, match=r"right within 50 mm with a probability of \d+%"):
        found_in(footage_of([posed("A", "standing")]))


def test_the_way_is_where_the_middle_of_the_body_goes():
    poses = [posed("A", "standing", x) for x in (0.0, 0.3, 0.6)]
    # a third of a px
    assert footage_of(poses).way(1) == pytest.approx((0.6, 0.0), abs=0.012)
    assert footage_of(poses).way(0) == pytest.approx((0.3, 0.0), abs=0.012)
