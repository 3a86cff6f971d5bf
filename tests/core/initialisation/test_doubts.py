"""First fits that may be wrong are told."""

import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import rest_height
from silhouette_mocap.core.initialisation.first_pose import PoseRequest, initialised
from silhouette_mocap.core.initialisation.pose_kinds import pose_of_kind
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import evaluator, filmed, small_body, small_studio

BODY = small_body("performer")
CAMERAS = small_studio()


def first(silhouettes):
    return initialised(BODY, CAMERAS, (silhouettes,), PoseRequest("A"), evaluator)


def test_an_initial_pose_that_is_found_raises_no_doubt():
    assert not first(filmed(BODY, CAMERAS, pose_of_kind(BODY, "A"))).doubts


def test_raised_arms_in_what_should_be_an_a_pose_are_told():
    pose = pose_of_kind(BODY, "A")
    for side in ("left", "right"):
        pose[BODY.dofs.names.index(f"{side}_shoulder_abduction")] = np.radians(125)
    doubts = first(filmed(BODY, CAMERAS, pose)).doubts
    assert any("of each silhouette unexplained and may be wrong" in doubt for doubt in doubts)


def test_legs_that_no_view_observes_are_told_and_do_not_shrink_the_performer():
    def without_feet(silhouette):
        rows = np.flatnonzero(silhouette.foreground.any(axis=1))
        observed = silhouette.observed.copy()
        observed[rows[0] + round(0.85 * len(rows)) :] = False
        return Silhouette(silhouette.foreground & observed, observed)

    found = first(tuple(map(without_feet, filmed(BODY, CAMERAS, pose_of_kind(BODY, "A")))))
    assert rest_height(found.body) == pytest.approx(rest_height(BODY), rel=0.03)
    assert any("fewer than two cameras see the whole performer" in doubt for doubt in found.doubts)
