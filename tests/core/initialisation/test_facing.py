import numpy as np
import pytest
from silhouette_mocap.core.fitting.contour import ContourTracker
from silhouette_mocap.core.fitting.turns import heading_dof, turned_about
from silhouette_mocap.core.initialisation import facing
from silhouette_mocap.core.initialisation.facing import Facing, faced
from silhouette_mocap.core.initialisation.hunt import Hunt
from silhouette_mocap.core.initialisation.pose_kinds import pose_of_kind
from synthetic import evaluator, filmed, small_body, small_studio

BODY = small_body("performer")
HEADING = 0.7
FRONT = np.array([np.sin(HEADING), -np.cos(HEADING)])


@pytest.fixture(scope="module")
def hunted():
    truth = pose_of_kind(BODY, "A")
    truth[heading_dof(BODY)] = HEADING
    truth[BODY.dofs.names.index("root_pitch")] = 0.1
    cameras = small_studio(4)
    return Hunt(ContourTracker(BODY, cameras, evaluator), filmed(BODY, cameras, truth)), truth


def still():
    return np.array([0.02, -0.1])


def off_by(found, truth):
    return np.degrees(np.arccos(np.cos(found.fit.pose[3] - truth[3])))


@pytest.mark.parametrize("turned", [False, True])
def test_a_body_that_faces_the_wrong_way_is_turned_about(hunted, turned):
    hunt, truth = hunted
    start = hunt.complete(turned_about(BODY, truth) if turned else truth)
    assert (abs(start.pose[3] - HEADING) > 2) == turned
    found = faced(hunt, start, still)
    assert off_by(found, truth) < 5
    assert found.margin > facing.CLEARLY and found.told_by == "the silhouettes"
    assert (
        found.words.startswith("Facing the other way the performer would fit")
        and "worse" in found.words
    )


@pytest.mark.parametrize("forwards", [True, False])
def test_where_silhouettes_leave_it_open_people_walk_where_they_face(hunted, monkeypatch, forwards):
    hunt, truth = hunted
    monkeypatch.setattr(facing, "CLEARLY", np.inf)
    found = faced(hunt, hunt.complete(truth), lambda: FRONT * (0.5 if forwards else -0.5))
    assert (off_by(found, truth) < 90) == forwards
    assert (found.margin > 0) == forwards
    assert found.words.startswith("Which side is left is in doubt")
    assert "the way they walk decided." in found.words
    assert ("better" in found.words) != forwards


@pytest.mark.parametrize("way", [still, lambda: None, lambda: FRONT[::-1] * (0.5, -0.5)])
def test_the_feet_of_whoever_does_not_walk_forwards_tell(hunted, monkeypatch, way):
    hunt, truth = hunted
    monkeypatch.setattr(facing, "CLEARLY", np.inf)
    found = faced(hunt, hunt.complete(turned_about(BODY, truth)), way)
    assert off_by(found, truth) < 5
    words = found.told_by.split()
    assert words[:2] == ["the", "feet,"] and int(words[2]) < int(words[5])


def test_px_count_for_the_feet_near_the_ankles_of_either_pose(hunted):
    hunt, truth = hunted
    poses = (truth, turned_about(BODY, truth))
    assert facing._feet_px(hunt, poses, 0) == 0
    drawn = hunt.evaluator.silhouettes(poses[1])
    differing = sum((a ^ b.foreground).sum() for a, b in zip(drawn, hunt.silhouettes, strict=True))
    assert 0 < facing._feet_px(hunt, poses, 1) < differing


def test_no_doubt_is_told_in_words_with_figures(hunted):
    hunt, truth = hunted
    fit = hunt.complete(truth)
    assert Facing(fit, 0.47, "the silhouettes").words == (
        "Facing the other way the performer would fit 47% worse."
    )
    assert Facing(fit, -0.012, "the way they walk").words == (
        "Which side is left is in doubt: facing the other way the performer would fit 1.2% "
        "better; the way they walk decided."
    )
