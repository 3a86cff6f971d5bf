"""First fits that cannot be a performer, and cameras that do not fit the others."""

import numpy as np
import pytest
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.initialisation.first_pose import FirstFit, PoseRequest, initialised
from silhouette_mocap.core.initialisation.plausibility import check_first_fit
from silhouette_mocap.core.initialisation.pose_kinds import pose_of_kind
from synthetic import evaluator, filmed, small_body, small_studio

CAMERAS = small_studio(4)


def first_fit(iou, scale=1.0) -> FirstFit:
    body = small_body("sixteen_segment", scale)
    return FirstFit(body, body.rest_pose, np.array(iou), ())


def test_a_good_fit_raises_no_doubt():
    assert check_first_fit(first_fit([0.9, 0.85, np.nan, 0.5]), CAMERAS) == ()


@pytest.mark.parametrize("scale", [0.25, 1.6, 1000.0])
def test_a_height_that_nobody_has_names_units_floor_and_height(scale):
    with pytest.raises(MocapError, match=r"m tall.*units.*floor.*height_m"):
        check_first_fit(first_fit([0.9] * 4, scale), CAMERAS)


@pytest.mark.parametrize("iou", [[0.3, 0.3, 0.3, 0.1], [np.nan] * 4])
def test_a_fit_unlike_the_silhouettes_is_refused(iou):
    with pytest.raises(MocapError, match=r"does not fit the silhouettes.*units.*floor"):
        check_first_fit(first_fit(iou), CAMERAS)


def test_a_camera_far_below_the_others_is_named():
    notes = check_first_fit(first_fit([0.9, 0.8, 0.35, 0.85]), CAMERAS)
    assert len(notes) == 1
    assert f"camera {CAMERAS[2].name} fits far worse" in notes[0]
    assert "IoU 0.35, theirs 0.85" in notes[0]


def test_a_floor_above_the_head_is_told():
    body = small_body("sixteen_segment")
    silhouettes = filmed(body, CAMERAS, pose_of_kind(body, "A"))
    request = PoseRequest("A", floor=2.5)
    with pytest.raises(MocapError, match=r"below the floor.*check floor under \[world\]"):
        initialised(body, CAMERAS, (silhouettes,), request, evaluator)
