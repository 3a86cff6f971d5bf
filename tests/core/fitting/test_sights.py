import numpy as np
from silhouette_mocap.core.fitting.limbs import LIMB_NAMES, limb_segments
from silhouette_mocap.core.fitting.sights import (
    BACKGROUND,
    FOREGROUND,
    contour_pairs,
    sets_with_limbs,
    sights_of,
)
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import dof_values, evaluator, filmed, small_body, small_studio


def test_sights_count_what_every_limb_covers_as_whole_pictures_do():
    body, cameras = small_body("performer"), small_studio()
    pose = dof_values(body, left_shoulder_abduction=1.2, left_elbow_flexion=1.0)
    rng = np.random.default_rng(0)
    silhouettes = []
    for seen in filmed(body, cameras, body.rest_pose):
        observed = rng.random(seen.foreground.shape) > 0.2
        silhouettes.append(Silhouette(seen.foreground & observed, observed))
    drawn = evaluator(body, cameras)
    sights = sights_of(drawn, pose, drawn.silhouettes(pose), silhouettes)
    px = np.array([sight.counts() for sight in sights]) @ sets_with_limbs(len(LIMB_NAMES))
    for limb, segments in enumerate(limb_segments(body)):
        for view, picture in enumerate(drawn.silhouettes(pose, segments)):
            covered = picture & silhouettes[view].observed
            seen = np.count_nonzero(covered & silhouettes[view].foreground)
            assert px[view, FOREGROUND, limb] == seen
            assert px[view, BACKGROUND, limb] == np.count_nonzero(covered) - seen


def test_the_contour_of_a_sight_has_the_distances_of_the_whole_picture():
    body, cameras = small_body("performer"), small_studio()
    pose = dof_values(body, left_shoulder_abduction=1.2)
    silhouettes, drawn = filmed(body, cameras, body.rest_pose), evaluator(body, cameras)
    rendered = drawn.silhouettes(pose)
    arm = drawn.silhouettes(pose, limb_segments(body)[1])
    for view, sight in enumerate(sights_of(drawn, pose, rendered, silhouettes)):
        pairs = contour_pairs(rendered[view], silhouettes[view].observed)
        distances, limbs = sight.contour()
        wanted = np.abs(silhouettes[view].distances.ravel()[pairs].sum(axis=0)) / 2
        np.testing.assert_array_equal(distances, wanted)
        beside = sets_with_limbs(len(LIMB_NAMES))[limbs, LIMB_NAMES.index("left_arm")]
        np.testing.assert_array_equal(beside, arm[view].ravel()[pairs].any(axis=0))
