import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import points
from silhouette_mocap.core.fitting.contour import ContourTracker
from silhouette_mocap.core.fitting.recovery import restarts
from silhouette_mocap.core.fitting.tracker import Past
from silhouette_mocap.core.silhouettes.place import performer_centre, visual_hull
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import dof_values, evaluator, filmed, point_errors, small_body, small_studio

PIXEL_M = 0.033


@pytest.fixture(scope="module")
def scene():
    body, cameras = small_body("performer"), small_studio()
    truth = dof_values(
        body,
        root_x=0.5,
        root_y=-0.4,
        root_yaw=2.5,
        left_shoulder_abduction=0.9,
        left_hip_flexion=0.5,
    )
    return body, cameras, truth, filmed(body, cameras, truth)


def empty(silhouette):
    blank = np.zeros_like(silhouette.foreground)
    return Silhouette(blank, ~blank)


def test_the_hull_holds_the_body_and_little_else(scene):
    body, cameras, truth, seen = scene
    hull = visual_hull(cameras, seen, performer_centre(cameras, seen), 1.2, 0.06)
    places = points(body, truth[None])[0]
    gaps = np.linalg.norm(hull[:, None] - places, axis=2).min(axis=0)
    assert gaps.max() < 0.15
    assert 0.03 < len(hull) * 0.06**3 < 0.3


def test_one_view_of_many_may_show_nothing(scene):
    _, cameras, _, seen = scene
    whole = visual_hull(cameras, seen, performer_centre(cameras, seen), 1.2, 0.06)
    dead = (empty(seen[0]), *seen[1:])
    hull = visual_hull(cameras, dead, performer_centre(cameras, dead), 1.2, 0.06)
    assert 0.5 * len(whole) < len(hull) <= len(whole)
    assert np.linalg.norm(hull.mean(axis=0) - whole.mean(axis=0)) < 0.1


def test_restarts_stand_in_the_middle_of_the_hull_facing_all_round(scene):
    body, cameras, truth, seen = scene
    starts = restarts(body, cameras, seen, body.rest_pose)
    middle = points(body, truth[None])[0].mean(axis=0)
    found = points(body, starts).mean(axis=1)
    assert np.linalg.norm(found - middle, axis=1).max() < 0.15
    yaw = body.dofs.names.index("root_yaw")
    turned = np.sort(np.unique(np.round(starts[:, yaw] % (2 * np.pi), 6)))
    assert np.diff(turned).max() < 0.6


def test_where_nobody_is_seen_there_is_nowhere_to_begin(scene):
    body, cameras, _, seen = scene
    assert restarts(body, cameras, tuple(map(empty, seen)), body.rest_pose).shape[0] == 0


def test_a_body_that_comes_back_elsewhere_is_found(scene):
    body, cameras, truth, seen = scene
    last = dof_values(body, root_x=-0.6, root_y=0.5)
    fit = ContourTracker(body, cameras, evaluator).fit(seen, Past.still(last))
    assert np.mean(list(point_errors(body, fit.pose, truth).values())) < PIXEL_M
