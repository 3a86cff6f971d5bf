import numpy as np
import pytest
from silhouette_mocap.core.energy.evaluator import Outline
from silhouette_mocap.core.fitting.contour_targets import ContourTargets
from silhouette_mocap.core.fitting.twists import Twists
from silhouette_mocap.core.rendering.outline import NOWHERE
from silhouette_mocap.core.silhouettes.observed_contour import ObservedContour
from synthetic import evaluator, filmed, small_body, small_studio

REACH, TURN = 0.2, 0.09


def tilted(camera, rng):
    """A contour whose field is a plane, with a few points and their normals."""
    width, height = camera.size
    y, x = np.mgrid[:height, :width]
    slope = rng.normal(size=2)
    slope /= np.linalg.norm(slope)
    field = slope[0] * (x - width / 2) + slope[1] * (y - height / 2)
    px = rng.uniform((width / 4, height / 4), (3 * width / 4, 3 * height / 4), (30, 2))
    angles = rng.uniform(0, 2 * np.pi, 30)
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return ObservedContour(*(a.astype(np.float32) for a in (field, px, normals)))


def seen_from(cameras, body, outlines, transforms):
    """The outlines' points, fixed to their joints, where they are seen under other transforms."""
    seen = []
    for camera, outline in zip(cameras, outlines, strict=True):
        own = transforms[body.segment_joints[outline.segments]]
        world = (own[:, :, :3] @ outline.points[..., None])[..., 0] + own[:, :, 3]
        h = np.c_[world, np.ones(len(world))] @ camera.projection.T
        px = h[:, :2] / h[:, 2:]
        seen.append(Outline(outline.segments, outline.points, px, outline.normals))
    return seen


def test_slopes_are_half_the_gradient_of_the_robust_squares():
    body, cameras, rng = small_body("performer"), small_studio(3), np.random.default_rng(1)
    pose = rng.normal(0, 0.2, len(body.dofs))
    twists = Twists(body)
    metres = np.array([0.03, 0.031, 0.035])
    targets = ContourTargets(body, cameras, [tilted(c, rng) for c in cameras], metres)
    outlines = evaluator(body, cameras).outline(pose, None, 3.0)

    def terms_at(pose):
        transforms, joints = twists.at(pose)
        seen = seen_from(cameras, body, outlines, transforms)
        return targets.terms(seen, transforms, REACH, TURN), joints

    terms, joints = terms_at(pose)
    slope, step = terms.gathered(joints)[1], 1e-6
    assert np.abs(slope).max() > 0.1
    for dof in range(len(pose)):
        ahead, behind = pose.copy(), pose.copy()
        ahead[dof] += step
        behind[dof] -= step
        change = terms_at(ahead)[0].cost.sum() - terms_at(behind)[0].cost.sum()
        np.testing.assert_allclose(2 * slope[dof], change / (2 * step), rtol=1e-4, atol=1e-5)


def test_the_matrix_is_the_sum_of_the_slopes_products():
    body, cameras, rng = small_body("performer"), small_studio(1), np.random.default_rng(2)
    transforms, joints = Twists(body).at(body.rest_pose)
    targets = ContourTargets(body, cameras, [tilted(cameras[0], rng)], np.array([0.03]))
    whole = evaluator(body, cameras).outline(body.rest_pose, None, 9.0)[0]
    fields = ("segments", "points", "px", "normals")
    parts = [Outline(*(getattr(whole, f)[k : k + 1] for f in fields)) for k in range(len(whole.px))]
    matrices = []
    for part in parts:
        # beyond any reach nothing is drawn to the outline, and weights are those of squares
        terms = targets.terms([part], transforms, 1e-9, TURN)
        if terms.count.sum() != 1:
            continue
        terms = targets.terms([part], transforms, 1e9, TURN)
        assert terms.cost.sum() >= 0
        matrix, _ = terms.gathered(joints)
        assert np.linalg.eigvalsh(matrix).min() > -1e-9 * np.abs(matrix).max()
        matrices.append(matrix)
    assert len(matrices) > 5


def test_an_outline_on_its_contour_pulls_nowhere():
    body, cameras = small_body("performer"), small_studio()
    pose = body.rest_pose
    contours = [s.contour.thinned(1.0) for s in filmed(body, cameras, pose)]
    metres = np.full(len(cameras), 0.033)
    targets = ContourTargets(body, cameras, contours, metres)
    transforms, _ = Twists(body).at(pose)
    terms = targets.terms(evaluator(body, cameras).outline(pose), transforms, REACH, TURN)
    away = np.sqrt(terms.cost.sum() / terms.count.sum())
    assert away < 0.4 * 0.033
    assert (terms.count.sum(axis=1) > 200).all()


def test_views_without_contour_or_outline_say_nothing():
    body, cameras = small_body("performer"), small_studio(2)
    contours = [s.contour.thinned(1.0) for s in filmed(body, cameras, body.rest_pose)]
    unseen = np.full_like(contours[0].field, np.nan)
    nothing = ObservedContour(unseen, *(np.zeros((0, 2), np.float32),) * 2)
    outlines = evaluator(body, cameras).outline(body.rest_pose)
    transforms, _ = Twists(body).at(body.rest_pose)
    metres = np.array([0.03, 0.03])
    hidden = ContourTargets(body, cameras, [nothing, contours[1]], metres)
    terms = hidden.terms(outlines, transforms, REACH, TURN)
    assert not terms.count[0].any()
    assert terms.count[1].any()
    shown = ContourTargets(body, cameras, contours, metres)
    terms = shown.terms([NOWHERE, outlines[1]], transforms, REACH, TURN)
    assert not terms.count[0].any()


def test_what_was_not_observed_draws_no_point_of_the_outline():
    body, cameras = small_body("performer"), small_studio(1)
    contour = filmed(body, cameras, body.rest_pose)[0].contour
    blind = ObservedContour(
        np.full_like(contour.field, np.nan), contour.px[:1], contour.normals[:1]
    )
    transforms, _ = Twists(body).at(body.rest_pose)
    targets = ContourTargets(body, cameras, [blind], np.array([0.03]))
    outlines = evaluator(body, cameras).outline(body.rest_pose)
    assert targets.terms(outlines, transforms, REACH, TURN).count.sum() <= 1


def test_every_point_of_the_contour_draws_the_nearest_of_however_many_points():
    body, cameras, rng = small_body("performer"), small_studio(1), np.random.default_rng(3)
    transforms, _ = Twists(body).at(body.rest_pose)
    metre = 0.03
    for count in (1, 31, 32, 33, 100):
        px, at = rng.uniform(0, 30, (count, 2)), rng.uniform(0, 30, (25, 2)).astype(np.float32)
        angles = rng.uniform(0, 2 * np.pi, count + 25)
        normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        outline = Outline(np.zeros(count, np.int32), np.zeros((count, 3)), px, normals[:count])
        away, blind = normals[count:].astype(np.float32), np.full(cameras[0].size[::-1], np.nan)
        contour = ObservedContour(blind.astype(np.float32), at, away)
        targets = ContourTargets(body, cameras, [contour], np.array([metre]))
        terms = targets.terms([outline], transforms, REACH, TURN)
        turned = TURN / metre * (outline.normals - away[:, None])
        apart = ((px - at[:, None]) ** 2 + turned**2).sum(axis=2)
        nearest = apart.argmin(axis=1)
        near = apart.min(axis=1) < (3 * REACH / metre) ** 2
        r2 = (((px[nearest] - at) * away).sum(axis=1)[near] * metre) ** 2
        assert terms.count.sum() == near.sum()
        cost = (REACH**2 * r2 / (REACH**2 + r2)).sum()
        np.testing.assert_allclose(terms.cost.sum(), cost, rtol=1e-5, atol=1e-12)


def test_contours_of_another_size_are_refused():
    body, cameras = small_body("performer"), small_studio(1)
    nothing = np.zeros((0, 2), np.float32)
    contour = ObservedContour(np.zeros((10, 10), np.float32), nothing, nothing)
    with pytest.raises(ValueError, match="size"):
        ContourTargets(body, cameras, [contour], np.array([0.03]))
