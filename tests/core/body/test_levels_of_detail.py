"""The coarse surface against the fine one, by their silhouettes."""

import cv2
import numpy as np
import pytest
from silhouette_mocap.core.body.kinematics import world_vertices

PIXELS_PER_METRE = 320


def silhouette(body, pose, level, heading):
    """(640, 640) bool, seen from the side by parallel rays; every triangle painted."""
    x, y, z = world_vertices(body, pose, level).T
    across = x * np.cos(heading) + y * np.sin(heading)
    px = 320 + PIXELS_PER_METRE * np.stack([across, 0.9 - z], axis=1)
    picture = np.zeros((640, 640), np.uint8)
    corners = np.round(px * 256).astype(np.int32)[body.surfaces[level].triangles]
    for triangle in corners:
        cv2.fillConvexPoly(picture, triangle, 1, shift=8)
    return picture.astype(bool)


@pytest.fixture
def pictures(body):
    """Pairs (coarse, fine) of the rest pose and a bent one, all around."""
    bent = body.rest_pose
    for name, degrees in {
        "left_elbow_flexion": 80,
        "right_shoulder_flexion": 60,
        "left_hip_flexion": 60,
        "left_knee_flexion": 90,
        "right_knee_flexion": 30,
    }.items():
        if name in body.dofs.names:
            bent[body.dofs.names.index(name)] = np.radians(degrees)
    return [
        [silhouette(body, pose, level, heading) for level in (0, -1)]
        for pose in (body.rest_pose, bent)
        for heading in np.radians([10, 55, 100, 145])
    ]


def test_coarse_and_fine_differ_by_two_per_cent_of_the_silhouette_and_nothing_of_its_area(pictures):
    differing = [(coarse ^ fine).sum() / fine.sum() for coarse, fine in pictures]
    grown = [coarse.sum() / fine.sum() - 1 for coarse, fine in pictures]
    assert max(differing) <= 0.02
    assert abs(np.mean(grown)) <= 0.003
