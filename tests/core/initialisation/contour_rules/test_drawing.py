"""The pictures of the steps show what was found, where it was found."""

import numpy as np
import pytest
from silhouette_mocap.core.cameras.presets import Ring, ring
from silhouette_mocap.core.errors import MocapError
from silhouette_mocap.core.initialisation.contour_rules.drawing import drawn_steps
from silhouette_mocap.core.initialisation.contour_rules.from_frames import contour_skeleton
from silhouette_mocap.core.initialisation.pose_kinds import pose_of_kind
from silhouette_mocap.core.silhouettes.silhouette import Silhouette
from synthetic import filmed, small_body

CONCAVE, CUT, LABEL, JOINT = (30, 30, 220), (40, 140, 40), (180, 30, 180), (0, 140, 255)
"""BGR."""
FOUR = ring(Ring(4, heights=(1.0,), size=(160, 120), focal_px=120.0))


def seen():
    return filmed(small_body("performer"), FOUR, pose_of_kind(small_body("performer"), "A"))


def places(picture: np.ndarray, colour: tuple[int, ...]) -> np.ndarray:
    """(n, 2) columns and rows of a colour."""
    return np.argwhere((picture == colour).all(axis=2))[:, ::-1]


def test_frontal_views_show_cuts_and_labels_and_all_views_the_joints():
    joints = contour_skeleton(FOUR, (seen(),), "A").joints[0]
    pictures = drawn_steps(FOUR, seen(), "A", joints)
    for view, frontal in enumerate((True, False, True, False)):
        assert bool(len(places(pictures[view], CUT))) == frontal
        assert bool(len(places(pictures[view], LABEL))) == frontal
        assert len(places(pictures[view], JOINT))
    without = drawn_steps(FOUR, seen(), "A")
    assert not len(places(without[0], JOINT)) and len(places(without[0], LABEL))


def test_the_contour_is_red_at_the_crotch_and_not_at_the_head():
    front = drawn_steps(FOUR, seen(), "A")[0]
    first = front[:, : front.shape[1] // 3]
    red = places(first, CONCAVE)
    middle, tall = first.shape[1] / 2, first.shape[0]
    at_crotch = (np.abs(red[:, 0] - middle) < 20) & (red[:, 1] > 0.5 * tall)
    at_head = (np.abs(red[:, 0] - middle) < 20) & (red[:, 1] < 0.2 * tall)
    assert at_crotch.any() and not at_head.any()


def test_an_empty_view_is_a_picture_that_says_so():
    silhouettes = list(seen())
    silhouettes[1] = Silhouette(np.zeros_like(silhouettes[1].foreground), silhouettes[1].observed)
    pictures = drawn_steps(FOUR, tuple(silhouettes), "A")
    assert len(pictures) == 4 and len(np.unique(pictures[1])) > 1
    with pytest.raises(MocapError, match="unknown"):
        drawn_steps(FOUR, tuple(silhouettes), "Y")
