import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import points, rest_height
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.initialisation import facing, first_pose
from silhouette_mocap.core.initialisation.first_pose import PoseRequest, initialised
from silhouette_mocap.core.initialisation.pose_kinds import pose_of_kind
from silhouette_mocap.core.initialisation.standing import body_centre, standing_height
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import evaluator, filmed, point_errors, small_body, small_studio


def standing(name, kind, scale, heading):
    body = small_body(name, scale)
    pose = pose_of_kind(body, kind)
    pose[:4] = [0.25, -0.3, 0.0, heading]
    return body, pose


@pytest.mark.parametrize(
    ("kind", "scale", "heading"), [("A", 0.93, 2.3), ("T", 1.05, -1.2), ("elbows", 1.0, 0.4)]
)
def test_position_heading_and_scale_are_found_from_silhouettes_alone(kind, scale, heading):
    body, truth = standing("sixteen_segment", kind, scale, heading)
    cameras = small_studio()
    silhouettes = filmed(body, cameras, truth)
    first = initialised(
        small_body("sixteen_segment"), cameras, (silhouettes,), PoseRequest(kind), evaluator
    )
    # One px of 33 mm at the crown and one at the feet, of 1.75 m.
    assert rest_height(first.body) == pytest.approx(rest_height(body), rel=0.02)
    turn = (first.pose[3] - heading + np.pi) % (2 * np.pi) - np.pi
    assert abs(turn) < np.radians(5)
    found = points(first.body, first.pose[None])[0]
    error = np.linalg.norm(found - points(body, truth[None])[0], axis=1)
    assert error.mean() < 0.035
    assert first.iou.min() > 0.85
    assert "m tall" in first.notes[0]


def test_a_given_height_is_kept():
    body, truth = standing("sixteen_segment", "A", 1.0, 0.0)
    cameras = small_studio(4)
    request = PoseRequest("A", height_m=1.8)
    first = initialised(body, cameras, (filmed(body, cameras, truth),), request, evaluator)
    assert rest_height(first.body) == pytest.approx(1.8)


def test_doubt_about_left_and_right_is_no_mere_note(monkeypatch):
    body, truth = standing("sixteen_segment", "A", 1.0, 0.0)
    cameras = small_studio(4)
    frames = (filmed(body, cameras, truth),)
    clear = initialised(body, cameras, frames, PoseRequest("A"), evaluator)
    assert not clear.doubts and "other way" in clear.notes[1]
    for module in (facing, first_pose):
        monkeypatch.setattr(module, "CLEARLY", np.inf)
    (doubt,) = initialised(body, cameras, frames, PoseRequest("A"), evaluator).doubts
    assert doubt.startswith("Which side is left is in doubt") and "the feet" in doubt


def test_centre_and_height_of_a_standing_body():
    body, truth = standing("performer", "A", 1.0, 1.0)
    cameras = small_studio()
    silhouettes = filmed(body, cameras, truth)
    centre = body_centre(cameras, silhouettes)
    assert np.abs(centre[:2] - truth[:2]).max() < 0.05
    # The crown is as wide as a skull: tilted views see its near or far rim.
    assert standing_height(cameras, silhouettes, centre, 0.0) == pytest.approx(
        rest_height(body), abs=0.06
    )


def test_one_camera_that_shows_something_else_is_outvoted():
    body, truth = standing("performer", "A", 1.0, 1.0)
    cameras = small_studio()
    silhouettes = filmed(body, cameras, truth)
    other = np.zeros((120, 160), bool)
    other[10:110, 5:25] = True
    fooled = (Silhouette(other, np.ones_like(other)), *silhouettes[1:])
    speckled = [Silhouette(s.foreground.copy(), s.observed) for s in fooled]
    for silhouette in speckled[1:]:
        silhouette.foreground[2, 30] = True
    centre = body_centre(cameras, tuple(speckled))
    assert np.abs(centre[:2] - truth[:2]).max() < 0.05
    assert standing_height(cameras, tuple(speckled), centre, 0.0) == pytest.approx(
        rest_height(body), abs=0.06
    )


def test_silhouettes_that_show_nobody_are_refused():
    cameras = small_studio(2)
    nothing = np.zeros((120, 160), bool)
    with pytest.raises(MocapError, match="0 of 2 views show the performer"):
        body_centre(cameras, (Silhouette(nothing, ~nothing),) * 2)


def test_point_errors_name_what_moved():
    body = small_body("performer")
    pose = body.rest_pose.copy()
    pose[body.dofs.names.index("left_elbow_flexion")] = 0.5
    errors = point_errors(body, pose, body.rest_pose)
    assert [name for name, error in errors.items() if error > 1e-6] == ["left_wrist"]


@pytest.mark.parametrize(("shown", "told"), [("T", "A"), ("A", "T"), ("elbows", "A")])
def test_a_pose_of_another_kind_than_named_is_found_and_told(shown, told):
    body, truth = standing("performer", shown, 1.0, 0.7)
    cameras = small_studio()
    silhouettes = filmed(body, cameras, truth)
    first = initialised(body, cameras, (silhouettes,), PoseRequest(told), evaluator)
    error = np.linalg.norm(
        points(first.body, first.pose[None])[0] - points(body, truth[None])[0], axis=1
    )
    # of a px of 33 mm
    assert error.max() < 0.066
    assert any(f'more like "{shown}"' in doubt for doubt in first.doubts)
    right = initialised(body, cameras, (silhouettes,), PoseRequest(shown), evaluator)
    assert not any("more like" in doubt for doubt in right.doubts)
