"""The benchmark of the skeleton: what it films, and what it tells."""

import json
from functools import cache

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.bench.skeleton import (
    SkeletonFigures,
    SkeletonSettings,
    skeleton_figures,
    true_joints,
)
from silhouette_mocap.core.bench.skeleton_report import (
    as_dict,
    skeleton_report,
    write_skeleton_files,
)
from silhouette_mocap.core.initialisation.contour_rules.skeleton import JOINT_NAMES
from silhouette_mocap.core.progress import SILENCE
from synthetic import small_body

SMALL = SkeletonSettings(counts=(2,), levels=(), frames=1, size=(320, 240), focal_px=250.0)


@cache
def figures() -> SkeletonFigures:
    return skeleton_figures(SMALL, SILENCE)


def test_the_stereo_pair_stands_30_degrees_apart_before_the_performer():
    (trial,) = figures().trials
    one, other = (camera.centre * [1, 1, 0] for camera in trial.recording.cameras)
    cosine = one @ other / np.linalg.norm(one) / np.linalg.norm(other)
    assert np.degrees(np.arccos(cosine)) == pytest.approx(30.0)
    # the performer looks along -y
    middle = (one + other) / np.linalg.norm(one + other)
    assert middle == pytest.approx([0.0, -1.0, 0.0], abs=1e-9)
    assert trial.recording.mm_per_px == pytest.approx(16.0, rel=0.02)


def test_errors_are_distances_from_the_bodys_own_joints():
    (trial,) = figures().trials
    body = small_body("performer")
    rest = dict(zip(JOINT_NAMES, true_joints(body, body.rest_pose), strict=True))
    assert rest["virtual_foot"][0] == pytest.approx(0.0, abs=1e-9)
    assert rest["left_elbow"][0] == pytest.approx(-rest["right_elbow"][0])
    assert trial.shown == 1 and trial.errors.shape == (1, 9)
    # depth from rays 30° apart is four times as unsure as the 16 mm of a pixel
    assert 1 < np.median(trial.errors) < trial.errors.max() < 100


def test_tables_json_and_pictures_tell_the_same(tmp_path):
    (trial,) = figures().trials
    report = skeleton_report(figures())
    worst = f"| none | 2 | {trial.errors.mean():.0f} | {trial.errors.max():.0f} | 1 of 1 | 16.1 |"
    assert worst in report
    told = json.loads(json.dumps(as_dict(figures())))
    assert told["trials"][0]["mean_mm"] == pytest.approx(trial.errors[0].tolist())
    assert told["true_measures_mm"]["forearm"] == pytest.approx(262.5, abs=1.0)
    paths = write_skeleton_files(figures(), tmp_path)
    assert [p.name for p in paths] == [
        "skeleton.md", "skeleton_2_cam_01.png", "skeleton_2_cam_02.png",
    ]  # fmt: skip
    assert all(cv2.imread(str(path)).any() for path in paths[1:])
